// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "film/checkpoint.h"
#include "film/film_pixels.h"
#include "gl/gl.h"

namespace fragtrace {

/// Pixels of a film for which programs are compiled. llvmpipe compiles anew for sizes that are a power of
/// two, which pictures seldom have.
inline constexpr glm::ivec2 kCompiledFor{7};

/// Sum, compensation and counts of every pixel on the device (shaders/film.glsl), and what light paths add.
class Film {
 public:
  explicit Film(glm::ivec2 size);
  /// The largest number of pixels per side that a film can have with this driver.
  static int mostSide();
  void clear();
  /// Empty, and of another size, of which it keeps its textures where these have room for it.
  void restart(glm::ivec2 size);
  /// The counts alone, where all else is written anew before it is read.
  void clearCounts();
  void bind() const;
  glm::ivec2 size() const { return size_; }

  FilmPixels read() const;

  /// All of it, and back again into a film of that size: what is drawn from then on has the bits that it
  /// would have had. Paths that were suspended between draws begin anew.
  FilmState save() const;
  void load(const FilmState& state);

  /// The sums of a program that draws guides: kGuideChannels, and the counts of the pixels.
  struct Guides {
    Image layers;
    FilmPixels counts;
  };
  Guides readGuides() const;

  /// Makes room for light paths, and is where these add their light and its square.
  const GlTexture& splats();
  /// Light paths that have been added.
  uint64_t lightPaths() const { return lightPaths_; }
  void countLightPaths(uint64_t paths) { lightPaths_ += paths; }
  /// Sum and compensation as two textures, the first on this unit.
  void bindTextures(GLuint first) const;

  /// Sum, compensation, counts, and light of light paths, which is null where there are none.
  std::array<const GlTexture*, 4> textures() const {
    return {&sum_, &compensation_, &counts_, lightPaths_ > 0 ? &splats_ : nullptr};
  }

  /// Adds to FilmPixels::cut, which is kept on the host.
  void addCut(double cut) { cut_ += cut; }

  /// Limits the samples of each pixel from now on, in the order of `pixels`, which is what read() gave and
  /// nothing has changed since; 0: no limit.
  void setTargets(const FilmPixels& pixels, std::span<const uint32_t> targets);

 private:
  FilmPixels readCounts() const;
  void addSplats(FilmPixels& film) const;

  glm::ivec2 size_;
  glm::ivec2 room_;  ///< of the textures
  GlTexture sum_;
  GlTexture compensation_;
  GlTexture counts_;
  double cut_ = 0.0;
  GlTexture splats_;  ///< none where no light path has been added
  uint64_t lightPaths_ = 0;
};

}  // namespace fragtrace
