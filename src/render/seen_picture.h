// SPDX-License-Identifier: MIT
// A film as a picture on the device: its means, joined with the picture that a moving camera saw before, and
// in the form that a window shows.
#pragma once

#include "render/film.h"
#include "render/noisy_textures.h"
#include "render/picture_passes.h"

namespace fragtrace {

/// A picture and its camera.
struct SeenPicture {
  NoisyTextures noisy;
  glm::ivec2 size{0};  ///< size of the picture; 0: there is none
  Camera camera;       ///< world space
};

/// Behind its surfaces a picture has a background, which makes it opaque; nothing; or nothing and a shadow in
/// alpha alone, so that it was filtered as laid over white.
enum class Behind { Background, Nothing, White };

/// The programs, which belong to one context. Rows of films and of pictures made of them go up; those of
/// shown pictures go down.
class SeenPasses {
 public:
  /// Throws RenderError, as all other members do.
  explicit SeenPasses(const ShaderSource& source);

  /// Writes the film's linear R, G, B and alpha into `raw`, and all else that a filter needs: radiance and
  /// counts into `fresh`, albedo and normal of a film of guides into `surfaces`.
  void read(const Film& film, const Film& guides, const GlTexture& raw, const NoisyTextures& fresh,
            const NoisyTextures& surfaces, PicturePasses& passes);

  /// Writes into `now` radiance and counts of the fresh picture with the samples of `past` added. A pixel's
  /// first hit takes them if the past picture shows that point, at the same depth, with a similar normal and
  /// albedo. Past light is divided by the past albedo and multiplied by the present one, so that textures
  /// stay sharp. A pixel's past counts as the samples that it had, but at most `most`, since its reflections
  /// were seen from elsewhere. Means, counts and variances are joined as if all samples had been seen (Chan,
  /// Golub and LeVeque, 1979). The background takes nothing from the past.
  void join(const NoisyTextures& fresh, const SeenPicture& now, const SeenPicture& past, double most,
            PicturePasses& passes);

  /// Mixes `share` of the filtered picture with the rest of the raw one, into `shown`.
  void show(const GlTexture& raw, const GlTexture& filtered, double share, Behind behind, glm::ivec2 size,
            const GlTexture& shown, PicturePasses& passes);
  /// Shows the film as it is.
  void show(const Film& film, bool background, const GlTexture& shown, PicturePasses& passes);

  /// Counts into one texel: samples, rays, and pixels in which the driver ended a loop.
  void count(const Film& film, const GlTexture& texel, PicturePasses& passes);

 private:
  GlProgram film_;
  GlProgram reproject_;
  GlProgram join_;
  GlProgram show_;
  GlProgram showFilm_;
  GlProgram totals_;
  glm::ivec2 room_{0};
  GlTexture past_;  ///< scratch of one call
  GlTexture apart_;
};

}  // namespace fragtrace
