// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "gl/gl.h"
#include "image/image.h"

namespace fragtrace {

/// What the film counted, over all pixels.
struct FilmTotals {
  uint64_t samples = 0;
  uint64_t rays = 0;
  uint64_t emptyPixels = 0;  ///< without any sample
  uint64_t nonfinitePixels = 0;
  uint64_t budgetHits = 0;  ///< pixels in which a loop was ended by the driver: the picture is wrong
};

/// Sum, compensation and counts of every pixel on the device (shaders/film.glsl).
class Film {
 public:
  explicit Film(glm::ivec2 size);
  void clear();
  void bind() const;
  glm::ivec2 size() const { return size_; }

  /// Mean radiance of the samples so far: R, G, B and, if asked for, A, "samples.Y" (count) and "variance.Y"
  /// (of the mean's luminance, estimated from the samples); the first row is the top.
  struct Layers {
    bool alpha = false;
    bool samples = false;
    bool variance = false;
  };
  Image readImage(const Layers& layers) const;
  FilmTotals readTotals() const;

 private:
  glm::ivec2 size_;
  GlTexture sum_;
  GlTexture compensation_;
  GlTexture counts_;
};

}  // namespace fragtrace
