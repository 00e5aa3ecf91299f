// SPDX-License-Identifier: MIT
// A film as a picture on the device: its means, joined with what a camera that moves has already seen, and as
// a window shows it.
#pragma once

#include "render/film.h"
#include "render/noisy_textures.h"
#include "render/picture_passes.h"
#include "scene/camera.h"

namespace fragtrace {

/// A picture, and who saw it.
struct SeenPicture {
  NoisyTextures noisy;
  glm::ivec2 size{0};  ///< of it; 0: nothing
  Camera camera;       ///< world space
};

/// A picture has behind its surfaces: a background, which makes it opaque; nothing; or nothing, and a shadow
/// is in alpha alone, so that it was filtered as laid over white.
enum class Behind { Background, Nothing, White };

/// Its programs, which one context holds. Rows of films and of what is made of them go up; those of what is
/// shown go down.
class SeenPasses {
 public:
  /// Throws RenderError, as all others do.
  explicit SeenPasses(const ShaderSource& source);

  /// The film's linear R, G, B and alpha into `raw`; all else that a filter needs: radiance and counts into
  /// `fresh`, albedo and normal, of a film of guides, into `surfaces`.
  void read(const Film& film, const Film& guides, const GlTexture& raw, const NoisyTextures& fresh,
            const NoisyTextures& surfaces, PicturePasses& passes);

  /// Radiance and counts of `now` from the fresh ones with the samples of `past` added: of each pixel's
  /// first hit, where the past picture has that point, at the same depth, with a normal and an albedo alike.
  /// Past light is divided by the past albedo and multiplied by the present one, so that textures stay sharp.
  /// A pixel's past counts as the samples that it had, but at most `most`: its reflections were seen from
  /// elsewhere. Means, counts and variances are joined as if all samples had been seen (Chan, Golub and
  /// LeVeque, 1979). Background takes nothing over.
  void join(const NoisyTextures& fresh, const SeenPicture& now, const SeenPicture& past, double most,
            PicturePasses& passes);

  /// Mixes `share` of the filtered picture with the rest of the raw one, into `shown`.
  void show(const GlTexture& raw, const GlTexture& filtered, double share, Behind behind, glm::ivec2 size,
            const GlTexture& shown, PicturePasses& passes);
  /// The film as it is.
  void show(const Film& film, bool background, const GlTexture& shown, PicturePasses& passes);

  /// Into one texel: samples, rays, and pixels in which the driver ended a loop.
  void count(const Film& film, const GlTexture& texel, PicturePasses& passes);

 private:
  GlProgram film_;
  GlProgram reproject_;
  GlProgram join_;
  GlProgram show_;
  GlProgram showFilm_;
  GlProgram totals_;
  PictureSums sums_;
  glm::ivec2 room_{0};
  GlTexture past_;  ///< for the moment of a call
  GlTexture apart_;
};

}  // namespace fragtrace
