// SPDX-License-Identifier: MIT
#include "render/film.h"

#include "errors.h"
#include "shader/layout.h"

namespace fragtrace {

namespace {

GlTexture makeLayer(GLenum format, glm::ivec2 size) {
  GlTexture texture = makeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, format, size.x, size.y);
  return texture;
}

template <typename Value>
std::vector<Value> readLayer(const GlTexture& texture, GLenum format, GLenum type, glm::ivec2 size) {
  std::vector<Value> values(size_t(size.x) * size_t(size.y) * 4);
  // The copy's size is an int in OpenGL, so large pictures are read in bands.
  const int rowsAtOnce = std::max(1, int((size_t(1) << 28) / (size_t(size.x) * 4 * sizeof(Value))));
  for (int y = 0; y < size.y; y += rowsAtOnce) {
    const int rows = std::min(rowsAtOnce, size.y - y);
    const size_t first = size_t(y) * size_t(size.x) * 4;
    glGetTextureSubImage(texture.name(), 0, 0, y, 0, size.x, rows, 1, format, type,
                         GLsizei(size_t(rows) * size_t(size.x) * 4 * sizeof(Value)), values.data() + first);
  }
  checkGl("reading the film");
  return values;
}

}  // namespace

Film::Film(glm::ivec2 size) : size_(size) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (size.x > most || size.y > most) {
    throw RenderError("the picture is " + std::to_string(size.x) + " x " + std::to_string(size.y) +
                      " pixels, this driver draws at most " + std::to_string(most) + " a side");
  }
  sum_ = makeLayer(GL_RGBA32F, size);
  compensation_ = makeLayer(GL_RGBA32F, size);
  counts_ = makeLayer(GL_RGBA32UI, size);
  clear();
}

void Film::clear() {
  const float zero[4] = {};
  const GLuint none[4] = {};
  cut_ = 0.0;
  glClearTexImage(sum_.name(), 0, GL_RGBA, GL_FLOAT, zero);
  glClearTexImage(compensation_.name(), 0, GL_RGBA, GL_FLOAT, zero);
  glClearTexImage(counts_.name(), 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT, none);
  checkGl("clearing the film");
}

void Film::bind() const {
  glBindImageTexture(layout::kFilmSumBinding, sum_.name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32F);
  glBindImageTexture(layout::kFilmCompensationBinding, compensation_.name(), 0, GL_FALSE, 0, GL_READ_WRITE,
                     GL_RGBA32F);
  glBindImageTexture(layout::kFilmCountsBinding, counts_.name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA32UI);
}

FilmPixels Film::read() const {
  const auto sum = readLayer<float>(sum_, GL_RGBA, GL_FLOAT, size_);
  const auto compensation = readLayer<float>(compensation_, GL_RGBA, GL_FLOAT, size_);
  const auto counts = readLayer<uint32_t>(counts_, GL_RGBA_INTEGER, GL_UNSIGNED_INT, size_);
  FilmPixels film;
  film.size = size_;
  film.cut = cut_;
  film.pixels.resize(size_t(size_.x) * size_t(size_.y));
  for (size_t p = 0; p < film.pixels.size(); ++p) {
    const size_t i = p * 4;
    FilmPixel& pixel = film.pixels[p];
    for (int c = 0; c < 3; ++c) pixel.sum[c] = double(sum[i + size_t(c)]) - compensation[i + size_t(c)];
    pixel.alpha = sum[i + 3];
    pixel.m2 = compensation[i + 3];
    pixel.samples = counts[i];
    pixel.rays = counts[i + 1];
    pixel.nonfinite = counts[i + 2];
    pixel.flags = counts[i + 3];
  }
  return film;
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
  glTextureSubImage2D(counts_.name(), 0, 0, 0, size_.x, size_.y, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                      counts.data());
  checkGl("setting how many samples each pixel is to have");
}

}  // namespace fragtrace
