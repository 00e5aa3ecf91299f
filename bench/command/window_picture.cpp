// SPDX-License-Identifier: MIT
#include "bench/command/window_picture.h"

#include "gl/program.h"
#include "image/channels.h"
#include "render/picture_passes.h"
#include "render/renderer.h"

namespace fragtrace {

namespace {

// Locations of the uniforms of shaders/entry/window.frag.
constexpr GLint kPictureSize = 0;
constexpr GLint kBar = 1;
constexpr GLint kPart = 3;
constexpr int kChannels = 3;

}  // namespace

WindowPicture::WindowPicture() { makePasses(shaderSource({}), {{&program_, "entry/window.frag"}}); }

Image WindowPicture::of(const Image& display, glm::ivec2 size) const {
  const Image colors = onlyChannels(display, {"R", "G", "B"});
  const glm::ivec2 drawn(colors.width, colors.height);
  const GlTexture picture = makePictureTexture(GL_RGBA8, drawn);
  writePictureTexture(picture, GL_RGB, kChannels, GL_FLOAT, drawn, colors.values, "writing a picture");
  const GlTexture shown = makePictureTexture(GL_RGBA8, size);
  const DrawTarget target;
  glNamedFramebufferTexture(target.framebuffer.name(), GL_COLOR_ATTACHMENT0, shown.name(), 0);
  target.bind();
  glViewport(0, 0, size.x, size.y);
  glUseProgram(program_.name());
  glUniform2f(kPictureSize, float(size.x), float(size.y));
  glUniform1f(kBar, float(size.x));
  glUniform3f(kPart, 0.5f, 0.5f, 1.0f);
  glBindTextureUnit(0, picture.name());
  glBindTextureUnit(1, picture.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  // A window's first row is at the bottom.
  const std::vector<float> upwards =
      readPictureTexture<float>(shown, GL_RGB, kChannels, GL_FLOAT, size, "reading what a window shows");
  Image image{size.x, size.y, colors.channels, {}, {}};
  const auto row = ptrdiff_t(size.x) * kChannels;
  for (int y = size.y - 1; y >= 0; --y)
    image.values.insert(image.values.end(), upwards.begin() + y * row, upwards.begin() + (y + 1) * row);
  return image;
}

}  // namespace fragtrace
