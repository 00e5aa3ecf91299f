// SPDX-License-Identifier: MIT
// The sun of an environment map that is read from a file.
#pragma once

#include <optional>

#include "image/image.h"

namespace fragtrace {

/// The brightest places of a map.
struct MapSun {
  float level = 0.0f;  ///< luminance from which on a place, filtered, is one of them
  double power = 0.0;  ///< luminance that they send to a disk of unit radius: pi times its integral over them
};

/// The places of an equirectangular map with R, G, B that light paths begin at: the brightest texels, which
/// take up at most 0.03 sr and are at least twice as bright as the mean. None if they give less than a fifth
/// of the map's light: camera paths find what is so even.
std::optional<MapSun> sunOfMap(const Image& map);

}  // namespace fragtrace
