// SPDX-License-Identifier: MIT
// Reads values of a picture on the device for display, without waiting for the device.
#pragma once

#include "gl/gl.h"
#include "view/picture/pixel_value.h"

namespace fragtrace {

class ValueReader {
 public:
  ValueReader() = default;
  ValueReader(const ValueReader&) = delete;
  ValueReader& operator=(const ValueReader&) = delete;
  ~ValueReader();

  /// Keeps `values` those of an area of the picture: reads it where they are of another one, or, at most five
  /// times a second, of another picture. An area without pixels is nothing to be read. `now`: seconds.
  /// Returns when to call it again, though nothing else changes; infinity: never.
  double keep(PictureValues& values, GLuint texture, uint64_t picture, glm::ivec2 whole,
              const PixelArea& area, double now);

 private:
  void begin(GLuint texture, double now);
  void end(PictureValues& values);

  GlBuffer buffer_;
  size_t room_ = 0;  ///< bytes
  bool reading_ = false;
  void* done_ = nullptr;  ///< a fence, after which
  PictureValues asked_;   ///< is read, except for its image
  double begun_ = -1.0;
};

}  // namespace fragtrace
