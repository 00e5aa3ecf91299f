// SPDX-License-Identifier: MIT
// Textures of one texel per pixel: writing them, and reading them back from the device.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <stdexcept>
#include <vector>

#include "gl/gl.h"

namespace fragtrace {

inline GlTexture makePictureTexture(GLenum format, glm::ivec2 size) {
  GlTexture texture = makeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, format, size.x, size.y);
  // A texture of integers that would be interpolated is incomplete: all its texels are 0.
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

/// Returns true if a picture of that size has no room, which then grows. The content must then be made again.
inline bool grows(glm::ivec2& room, glm::ivec2 size) {
  if (glm::all(glm::lessThanEqual(size, room))) return false;
  room = glm::max(size, room);
  return true;
}

/// Reads all texels of a format with `channels` channels of type `type`, row by row in the order of the
/// device. `where` names the step in errors, as for checkGl().
template <typename Value>
std::vector<Value> readPictureTexture(const GlTexture& texture, GLenum format, int channels, GLenum type,
                                      glm::ivec2 size, const char* where) {
  const size_t row = size_t(size.x) * size_t(channels);
  std::vector<Value> values(row * size_t(size.y));
  movedBytes() += values.size() * sizeof(Value);
  // The copy's size is an int in OpenGL, so large pictures are read in bands.
  const int rowsAtOnce = std::max(1, int((size_t(1) << 28) / (row * sizeof(Value))));
  for (int y = 0; y < size.y; y += rowsAtOnce) {
    const int rows = std::min(rowsAtOnce, size.y - y);
    glGetTextureSubImage(texture.name(), 0, 0, y, 0, size.x, rows, 1, format, type,
                         GLsizei(size_t(rows) * row * sizeof(Value)), values.data() + size_t(y) * row);
  }
  checkGl(where);
  return values;
}

/// Writes as many values as readPictureTexture() returns.
template <typename Value>
void writePictureTexture(const GlTexture& texture, GLenum format, int channels, GLenum type, glm::ivec2 size,
                         const std::vector<Value>& values, const char* where) {
  const size_t row = size_t(size.x) * size_t(channels);
  if (values.size() != row * size_t(size.y)) throw std::invalid_argument("values do not fill the texture");
  movedBytes() += values.size() * sizeof(Value);
  glTextureSubImage2D(texture.name(), 0, 0, 0, size.x, size.y, format, type, values.data());
  checkGl(where);
}

}  // namespace fragtrace
