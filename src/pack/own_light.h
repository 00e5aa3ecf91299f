// SPDX-License-Identifier: MIT
// Decides how a file's own light is taken: whether it lights what is seen, and the units of its lamps.
#pragma once

#include <cstdint>

#include "pack/seen_light.h"
#include "scene/scene.h"
#include "shader/render_options.h"

namespace fragtrace {

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
  double asWritten = 0.0;  ///< mean luminance of what its lamps light, with these as written
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
