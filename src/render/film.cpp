// SPDX-License-Identifier: MIT
#include "render/film.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <stdexcept>

#include "base/errors.h"
#include "image/channels.h"
#include "render/picture_passes.h"
#include "shader/layout.h"

namespace fragtrace {

namespace {

constexpr const char* kReading = "reading the film";
constexpr const char* kLoading = "loading the film";

/// No sample is added that could make a sum that is not finite, so only a faulty driver gives one. The pixel
/// is black, and counts as one of a sample that was not finite.
void dropNonfinite(FilmPixel& pixel) {
  if (std::isfinite(pixel.sum.x + pixel.sum.y + pixel.sum.z + pixel.alpha)) return;
  pixel.sum = glm::dvec3(0.0);
  pixel.alpha = pixel.m2 = 0.0;
  pixel.nonfinite = std::max(pixel.nonfinite, 1u);
}

/// A framebuffer by which these textures are cleared, in their order. Drivers clear framebuffers as they
/// draw; llvmpipe clears a texture through the host.
GlFramebuffer targetOf(std::initializer_list<const GlTexture*> textures) {
  GlFramebuffer target = makeFramebuffer();
  std::array<GLenum, 3> buffers{};
  size_t count = 0;
  for (const GlTexture* texture : textures) {
    buffers.at(count) = GLenum(GL_COLOR_ATTACHMENT0 + count);
    glNamedFramebufferTexture(target.name(), buffers[count++], texture->name(), 0);
  }
  glNamedFramebufferDrawBuffers(target.name(), GLsizei(count), buffers.data());
  return target;
}

}  // namespace

int Film::mostSide() { return driverCount(GL_MAX_TEXTURE_SIZE); }

Film::Film(glm::ivec2 size) : size_(size), room_(size) {
  const int most = mostSide();
  if (size.x > most || size.y > most) {
    throw RenderError("the picture is " + std::to_string(size.x) + " x " + std::to_string(size.y) +
                      " pixels, this driver draws at most " + std::to_string(most) + " a side");
  }
  sum_ = makePictureTexture(GL_RGBA32F, size);
  compensation_ = makePictureTexture(GL_RGBA32F, size);
  counts_ = makePictureTexture(GL_RGBA32UI, size);
  clear();
}

void Film::clear() {
  const float zero[4] = {};
  cut_ = 0.0;
  lightPaths_ = {};
  pixelsPerPath_ = 0;
  if (splats_.name() != 0) glClearTexImage(splats_.name(), 0, GL_RGBA, GL_FLOAT, zero);
  const GlFramebuffer target = targetOf({&sum_, &compensation_});
  for (const GLint buffer : {0, 1}) glClearNamedFramebufferfv(target.name(), GL_COLOR, buffer, zero);
  clearCounts();
  checkGl("clearing the film");
}

void Film::restart(glm::ivec2 size) {
  if (glm::any(glm::greaterThan(size, room_))) {
    *this = Film(glm::max(size, room_));
  } else {
    clear();
  }
  size_ = size;
}

void Film::clearCounts() {
  const GLuint none[4] = {};
  glClearNamedFramebufferuiv(targetOf({&counts_}).name(), GL_COLOR, 0, none);
}

void Film::bind() const {
  glBindImageTexture(layout::kFilmSumBinding, sum_.name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32F);
  glBindImageTexture(layout::kFilmCompensationBinding, compensation_.name(), 0, GL_FALSE, 0, GL_READ_WRITE,
                     GL_RGBA32F);
  glBindImageTexture(layout::kFilmCountsBinding, counts_.name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32UI);
}

void Film::bindTextures(GLuint first) const {
  glBindTextureUnit(first, sum_.name());
  glBindTextureUnit(first + 1, compensation_.name());
}

const GlTexture& Film::splats() {
  if (splats_.name() == 0) {
    const float zero[4] = {};
    splats_ = makePictureTexture(GL_RGBA32F, room_);
    glClearTexImage(splats_.name(), 0, GL_RGBA, GL_FLOAT, zero);
    checkGl("making room for light paths");
  }
  return splats_;
}

void Film::countLightPaths(uint64_t paths, double weight) {
  lightPaths_.count += paths;
  lightPaths_.weight += double(paths) * weight;
  lightPaths_.squared += double(paths) * weight * weight;
}

/// Every pixel gets the mean of all light paths, as if each of its samples had brought it.
void Film::addSplats(FilmPixels& film) const {
  if (lightPaths_.count == 0) return;
  const auto splats = readPictureTexture<float>(splats_, GL_RGBA, 4, GL_FLOAT, size_, kReading);
  const double weight = lightPaths_.weight;
  const double paths = weight * weight / lightPaths_.squared;  // so many of one weight vary as much
  for (size_t p = 0; p < film.pixels.size(); ++p) {
    FilmPixel& pixel = film.pixels[p];
    const double samples = pixel.samples;
    const glm::dvec3 mean = glm::dvec3(splats[p * 4], splats[p * 4 + 1], splats[p * 4 + 2]) / weight;
    const double value = luminance(mean);
    // The variance of the mean of independent paths, most of which bring no light.
    const double variance =
        std::max(0.0, splats[p * 4 + 3] / lightPaths_.squared - value * value) / std::max(paths - 1.0, 1.0);
    pixel.sum += samples * mean;
    const double m2 = variance * samples * std::max(samples - 1.0, 0.0);
    pixel.m2 += m2;
    film.lightPathM2 += m2;
  }
}

FilmPixels Film::read() const {
  FilmPixels film = readCounts();
  const auto sum = readPictureTexture<float>(sum_, GL_RGBA, 4, GL_FLOAT, size_, kReading);
  const auto compensation = readPictureTexture<float>(compensation_, GL_RGBA, 4, GL_FLOAT, size_, kReading);
  for (size_t p = 0; p < film.pixels.size(); ++p) {
    const size_t i = p * 4;
    FilmPixel& pixel = film.pixels[p];
    for (int c = 0; c < 3; ++c) pixel.sum[c] = double(sum[i + size_t(c)]) - compensation[i + size_t(c)];
    pixel.alpha = sum[i + 3];
    pixel.m2 = compensation[i + 3];
  }
  addSplats(film);
  for (FilmPixel& pixel : film.pixels) dropNonfinite(pixel);
  return film;
}

FilmState Film::save() const {
  return {size_,
          readPictureTexture<float>(sum_, GL_RGBA, 4, GL_FLOAT, size_, kReading),
          readPictureTexture<float>(compensation_, GL_RGBA, 4, GL_FLOAT, size_, kReading),
          readPictureTexture<uint32_t>(counts_, GL_RGBA_INTEGER, 4, GL_UNSIGNED_INT, size_, kReading),
          cut_,
          lightPaths_.count > 0 ? readPictureTexture<float>(splats_, GL_RGBA, 4, GL_FLOAT, size_, kReading)
                                : std::vector<float>(),
          lightPaths_,
          pixelsPerPath_};
}

void Film::load(const FilmState& state) {
  if (state.size != size_) throw std::invalid_argument("a film is loaded with the state of another size");
  std::vector<uint32_t> counts = state.counts;
  for (size_t i = 3; i < counts.size(); i += 4) counts[i] &= ~layout::kPixelSuspended;
  writePictureTexture(sum_, GL_RGBA, 4, GL_FLOAT, size_, state.sum, kLoading);
  writePictureTexture(compensation_, GL_RGBA, 4, GL_FLOAT, size_, state.compensation, kLoading);
  writePictureTexture(counts_, GL_RGBA_INTEGER, 4, GL_UNSIGNED_INT, size_, counts, kLoading);
  cut_ = state.cut;
  if (!state.splats.empty())
    writePictureTexture(splats(), GL_RGBA, 4, GL_FLOAT, size_, state.splats, kLoading);
  lightPaths_ = state.lightPaths;
  pixelsPerPath_ = state.pixelsPerPath;
}

FilmPixels Film::readCounts() const {
  const auto counts =
      readPictureTexture<uint32_t>(counts_, GL_RGBA_INTEGER, 4, GL_UNSIGNED_INT, size_, kReading);
  FilmPixels film;
  film.size = size_;
  film.cut = cut_;
  film.lightPaths = lightPaths_.count;
  film.pixelsPerPath = pixelsPerPath_;
  film.pixels.resize(size_t(size_.x) * size_t(size_.y));
  for (size_t p = 0; p < film.pixels.size(); ++p) {
    FilmPixel& pixel = film.pixels[p];
    pixel.samples = counts[p * 4];
    pixel.rays = counts[p * 4 + 1];
    pixel.nonfinite = counts[p * 4 + 2];
    pixel.flags = counts[p * 4 + 3];
  }
  return film;
}

Film::Guides Film::readGuides() const {
  Guides guides{{size_.x, size_.y, {kGuideChannels.begin(), kGuideChannels.end()}, {}, {}}, readCounts()};
  const auto albedo = readPictureTexture<float>(sum_, GL_RGBA, 4, GL_FLOAT, size_, kReading);
  const auto normal = readPictureTexture<float>(compensation_, GL_RGBA, 4, GL_FLOAT, size_, kReading);
  std::vector<float>& values = guides.layers.values;
  values.reserve(albedo.size() * 2);
  for (int y = size_.y - 1; y >= 0; --y) {
    for (int x = 0; x < size_.x; ++x) {
      const size_t p = size_t(y) * size_t(size_.x) + size_t(x);
      const float part = 1.0f / float(std::max(guides.counts.pixels[p].samples, 1u));
      for (size_t c = 0; c < 4; ++c) values.push_back(part * albedo[p * 4 + c]);
      for (size_t c = 0; c < 4; ++c) values.push_back(part * normal[p * 4 + c]);
    }
  }
  return guides;
}

void Film::setTargets(const FilmPixels& pixels, std::span<const uint32_t> targets) {
  constexpr uint32_t kFlagMask = (1u << layout::kPixelTargetShift) - 1u;
  std::vector<uint32_t> counts;
  counts.reserve(pixels.pixels.size() * 4);
  for (size_t i = 0; i < pixels.pixels.size(); ++i) {
    const FilmPixel& p = pixels.pixels[i];
    counts.insert(counts.end(), {p.samples, p.rays, p.nonfinite,
                                 (p.flags & kFlagMask) | targets[i] << layout::kPixelTargetShift});
  }
  writePictureTexture(counts_, GL_RGBA_INTEGER, 4, GL_UNSIGNED_INT, size_, counts,
                      "setting how many samples each pixel is to have");
}

}  // namespace fragtrace
