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

Image Film::readImage(const Layers& layers) const {
  const auto sum = readLayer<float>(sum_, GL_RGBA, GL_FLOAT, size_);
  const auto compensation = readLayer<float>(compensation_, GL_RGBA, GL_FLOAT, size_);
  const auto counts = readLayer<uint32_t>(counts_, GL_RGBA_INTEGER, GL_UNSIGNED_INT, size_);
  Image image;
  image.width = size_.x;
  image.height = size_.y;
  image.channels = {"R", "G", "B"};
  if (layers.alpha) image.channels.emplace_back("A");
  if (layers.samples) image.channels.emplace_back("samples.Y");
  if (layers.variance) image.channels.emplace_back("variance.Y");
  image.values.resize(size_t(size_.x) * size_t(size_.y) * image.channelCount());
  for (int y = 0; y < size_.y; ++y) {
    for (int x = 0; x < size_.x; ++x) {
      const size_t i = (size_t(size_.y - 1 - y) * size_t(size_.x) + size_t(x)) * 4;
      const double samples = std::max(1u, counts[i]);
      float* pixel = image.pixel(x, y);
      for (size_t c = 0; c < 3; ++c) pixel[c] = float((double(sum[i + c]) - compensation[i + c]) / samples);
      size_t next = 3;
      if (layers.alpha) pixel[next++] = float(sum[i + 3] / samples);
      if (layers.samples) pixel[next++] = float(counts[i]);
      if (layers.variance)
        pixel[next] = float(compensation[i + 3] / (samples * std::max(1.0, samples - 1.0)));
    }
  }
  return image;
}

FilmTotals Film::readTotals() const {
  const auto counts = readLayer<uint32_t>(counts_, GL_RGBA_INTEGER, GL_UNSIGNED_INT, size_);
  FilmTotals totals;
  for (size_t i = 0; i < counts.size(); i += 4) {
    totals.samples += counts[i];
    totals.rays += counts[i + 1];
    totals.emptyPixels += counts[i] == 0;
    totals.nonfinitePixels += counts[i + 2] != 0;
    totals.budgetHits += (counts[i + 3] & layout::kPixelBudgetHit) != 0;
  }
  return totals;
}

}  // namespace fragtrace
