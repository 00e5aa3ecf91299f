// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "bvh/bvh.h"
#include "scene/scene.h"
#include "shader/render_options.h"

namespace fragtrace {

// Estimates on the processor what a view shows of a scene by the scene's own light.

/// The luminance of middle grey.
inline constexpr double kMiddleGrey = 0.18;

/// The factors of middle grey beyond which a picture is far too bright, or as good as black.
inline constexpr double kTooBright = 16.0;
inline constexpr double kTooDark = 1.0 / 64.0;

/// Lumens per watt at 555 nm: what an exporter multiplies by that takes watts for lumens.
inline constexpr double kLumensPerWatt = 683.0;

/// The mean luminance of the surfaces in one cell of the view.
struct SeenCell {
  double byLamps = 0.0;     ///< reflected light of punctual lamps, as the file gives them
  double byEmission = 0.0;  ///< reflected light of surfaces that emit
  double shown = 0.0;       ///< light that the surfaces themselves emit, or show without any (unlit)
};

/// What a view shows of a scene.
struct SeenLight {
  std::vector<SeenCell> cells;  ///< those in which there is a surface
  double smoothMetal = 0.0;     ///< the share of them that smooth metal fills
  double open = 0.0;            ///< the share of the paths that leave the scene after a surface
  int paths = 0;                ///< the paths that were traced

  /// The logarithmic mean of the luminance of the cells that are not as good as black, or, where these are
  /// few, of all that get light; 0: none does. What is dark compared with a lit place needs no exposure.
  double meanLuminance(double lampScale) const;
  /// The logarithmic mean of the luminance of the cells that lamps, as written, light more than emission
  /// does.
  double meanOfLampLit(double lampScale) const;
  /// The logarithmic mean of the luminance of all cells under surroundings that light each as middle grey.
  double meanBesideSurroundings(double lampScale) const;
  /// The share of the cells below that luminance; cells that emit as much by themselves do not count, unless
  /// they are nearly all.
  double darkShare(double lampScale, double luminance) const;
};

/// The tracer's part of the scene: the tree holds all of its surfaces, and nothing moves.
struct SeenScene {
  const Scene& scene;
  const Bvh& bvh;
  bool readsTextures = true;  ///< emissive textures are decoded; without them their surfaces do not shine
};

/// Traces at most 4,096 paths of at most four surfaces from the camera, of a fixed seed: surfaces are matt,
/// glass and what is more transparent than not let them pass straight on, without the surroundings' light.
/// It takes fewer where these make clear that most of what is seen is lit, and neither too bright nor too
/// dark. Throws InputError for an emissive picture that cannot be decoded.
SeenLight seenLight(const SeenScene& seen, const Camera& camera, double aspectRatio);

// Decides how a file's own light is taken: whether it lights what is seen, and the units of its lamps.

enum class OwnLight : uint8_t {
  None,    ///< neither punctual lights nor emission
  Dim,     ///< emission that leaves most of what the first view shows dark
  Enough,  ///< punctual lights, emission that lights what is seen, or nothing is seen to judge by
};

/// What is decided about a file's light, once, by its first view in the pose in which it stands: later
/// cameras, times, hidden nodes and numbers that are set do not change it.
struct FileLight {
  OwnLight own = OwnLight::Enough;
  bool byLamps = false;    ///< there are punctual lights
  double lampScale = 1.0;  ///< 1 / kLumensPerWatt where its lamps are read as radiometric
  double asWritten = 0.0;  ///< mean luminance by which lampScale is decided, with the lamps as written
  double mean = 0.0;       ///< mean luminance of all that is seen, with lampScale; 0: none is known
  double dark = 0.0;  ///< the share of what is seen that is as good as black, with the exposure of `mean`
  double smoothMetal = 0.0;  ///< the share that is smooth metal
};

/// Returns true if the scene has a light or a surface that emits, however little: only then there is
/// something to decide. A lamp of intensity 0 is none.
bool mayShine(const Scene& scene);

/// The options that decide about lamps.
struct LampReading {
  LampUnits units = LampUnits::Auto;
  bool besideSurroundings = false;  ///< surroundings that the user chose light the scene, too
};

/// Decides by the first view. Emissive textures count where no lamps do.
FileLight decideLight(const SeenScene& first, const Camera& camera, double aspectRatio,
                      const LampReading& reading);

/// The exposure that brings such a mean to middle grey, to a tenth of a stop; 0: it is near enough.
double exposureFor(double mean);

}  // namespace fragtrace
