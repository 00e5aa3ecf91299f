// SPDX-License-Identifier: MIT
// The tracing thread's pictures as they come in: of sides, of references, of environments.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

#include "gl/gl.h"
#include "view/window/view_window.h"

namespace fragtrace {

void Window::takePictures(std::vector<TracedPicture> pictures) {
  const double now = glfwGetTime();
  for (TracedPicture& picture : pictures) {
    const size_t side = picture.side;
    if (!picture.file.empty())
      takeReference(picture);
    else if (side == 1 && !state_.reference.empty())
      continue;  // it was on its way when the reference took its place
    display_.take(picture);
    ++report_.pictures;
    if (side == 0) arrivals_.push_back(now);
    facts_.statistics[side] = picture.statistics;
    facts_.pictureSize[side] = picture.size;
    facts_.lines[side] = std::move(picture.lines);
    report_.answered = std::max(report_.answered, picture.request);
    while (!unanswered_.empty() && unanswered_.front().first <= picture.request) {
      keepTime(report_.times.answerMs, 1000.0 * (now - unanswered_.front().second));
      unanswered_.pop_front();
    }
    frames_ = std::max(frames_, 1);
  }
  while (!arrivals_.empty() && arrivals_.front() < now - 1.0) arrivals_.pop_front();
  const bool moves = askedMoving_ && arrivals_.size() > 1;
  facts_.picturesPerSecond =
      moves ? double(arrivals_.size() - 1) / (arrivals_.back() - arrivals_.front()) : 0.0;
  compareSizes();
}

void Window::takeThumbnail(const EnvironmentThumbnail& thumbnail) {
  const Image& image = thumbnail.image;
  if (image.values.empty()) return;
  GlTexture texture = makeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, GL_RGBA8, image.width, image.height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(texture.name(), 0, 0, 0, image.width, image.height, GL_RGB, GL_FLOAT,
                      image.values.data());
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  checkGl("uploading a thumbnail");
  facts_.thumbnails[thumbnail.file] = texture.name();
  thumbnails_[thumbnail.file] = std::move(texture);
  frames_ = std::max(frames_, 1);
}

/// Once for each environment that the list offers.
void Window::askForThumbnails() {
  if (!std::exchange(facts_.wantsThumbnails, false) || !state_.scene) return;
  std::vector<std::filesystem::path> wanted = state_.scene->environments;
  wanted.emplace_back();
  if (!state_.scene->options.light.hdriFile.empty()) wanted.push_back(state_.scene->options.light.hdriFile);
  std::erase_if(wanted, [&](const auto& file) { return !askedThumbnails_.insert(file).second; });
  if (!wanted.empty()) exchange_.makeThumbnails(std::move(wanted));
}

/// It is side B from now on.
void Window::takeReference(const TracedPicture& picture) {
  state_.reference = picture.file;
  state_.split = true;
  state_.overview = false;
  state_.active = 0;
  if (state_.sides[1].scene.empty()) state_.sides[1] = state_.sides[0];
  newReference_ = true;
}

/// Once the picture of the scene has its size.
void Window::compareSizes() {
  const glm::ivec2 size = facts_.pictureSize[1];
  if (!newReference_ || state_.reference.empty() || facts_.pictureSize[0] != state_.size) return;
  newReference_ = false;
  if (size == state_.size) return;
  const auto text = [](glm::ivec2 s) { return std::to_string(s.x) + " x " + std::to_string(s.y); };
  say(state_.reference.filename().string() + " has " + text(size) + " pixels, the picture " +
      text(state_.size) + ": it is scaled to compare");
}

}  // namespace fragtrace
