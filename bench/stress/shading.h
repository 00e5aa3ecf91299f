// SPDX-License-Identifier: MIT
// Rows of shading in a white furnace: whatever normals and boundaries are, no pixel is black, too bright or
// not a number.
#pragma once

#include "bench/stress/stress.h"

namespace fragtrace {

/// A white mesh whose normals are missing, backwards or tilted; cases are pixels that see it, failures those
/// that are black, brighter than the world, or not finite.
StressOutcome shadeBadNormals(const StressSetting& setting);
/// A mirror with a normal map that turns everything away and tangents that do not fit; the same.
StressOutcome shadeBadTangents(const StressSetting& setting);
/// Clear glass that is nested, touches glass, has index 1 or is seen from inside; cases are pixels, failures
/// those that are not as bright as the world (from inside: times the square of the index).
StressOutcome lookThroughGlass(const StressSetting& setting);
/// The foot of a wall in the light from behind it; cases are pixels of the shadow, failures those that are
/// lit.
StressOutcome lookAtContactShadow(const StressSetting& setting);

}  // namespace fragtrace
