// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "gl/gl.h"
#include "render/film/checkpoint.h"
#include "render/film/film_pixels.h"

namespace fragtrace {

/// The size of the film for which programs are compiled. llvmpipe compiles again for sizes that are a power
/// of two, which pictures seldom have.
inline constexpr glm::ivec2 kCompiledFor{7};

/// Sum, compensation and counts of every pixel on the device (shaders/film.glsl), and the light of light
/// paths.
class Film {
 public:
  explicit Film(glm::ivec2 size);
  /// The largest number of pixels per side that a film can have with this driver.
  static int mostSide();
  void clear();
  /// Empties the film and changes its size. It keeps its textures if these have room for that.
  void restart(glm::ivec2 size);
  /// Clears the counts alone, where all else is written before it is read again.
  void clearCounts();
  void bind() const;
  glm::ivec2 size() const { return size_; }

  FilmPixels read() const;

  /// save() returns all of the film, and load() restores it in a film of that size. Samples drawn after that
  /// have the bits that they would have had. Paths that were suspended between draws begin again.
  FilmState save() const;
  void load(const FilmState& state);

  /// The sums of a program that draws guides: kGuideChannels, and the counts of the pixels.
  struct Guides {
    Image layers;
    FilmPixels counts;
  };
  Guides readGuides() const;

  /// The texture to which light paths add their light and its square; makes room for it.
  const GlTexture& splats();
  /// The light paths that have been added.
  const LightPaths& lightPaths() const { return lightPaths_; }
  void countLightPaths(uint64_t paths, double weight);
  /// Pixels of the picture for one light path of a sample, after the first samples, or kNoLightPaths for all
  /// of them; 0: not yet chosen.
  int pixelsPerPath() const { return pixelsPerPath_; }
  void setPixelsPerPath(int pixels) { pixelsPerPath_ = pixels; }
  /// Binds sum and compensation as two textures, the first on this unit.
  void bindTextures(GLuint first) const;

  /// Sum, compensation, counts, and the light of light paths, which is null if there is none.
  std::array<const GlTexture*, 4> textures() const {
    return {&sum_, &compensation_, &counts_, lightPaths_.count > 0 ? &splats_ : nullptr};
  }

  /// Adds to FilmPixels::cut, which is kept on the host.
  void addCut(double cut) { cut_ += cut; }

  /// Limits the samples of each pixel from now on, in the order of `pixels`, which must be what read()
  /// returned and nothing has changed since; 0 means no limit.
  void setTargets(const FilmPixels& pixels, std::span<const uint32_t> targets);

 private:
  FilmPixels readCounts() const;
  void addSplats(FilmPixels& film) const;

  glm::ivec2 size_;
  glm::ivec2 room_;  ///< size of the textures
  GlTexture sum_;
  GlTexture compensation_;
  GlTexture counts_;
  double cut_ = 0.0;
  GlTexture splats_;  ///< none where no light path has been added
  LightPaths lightPaths_;
  int pixelsPerPath_ = 0;
};

}  // namespace fragtrace
