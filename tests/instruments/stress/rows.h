// SPDX-License-Identifier: MIT
// The rows of `bench stress` as functions, which stress.cpp lists. Each says what cases and failures are.
#pragma once

#include "tests/instruments/rays/ray_attacks.h"
#include "tests/instruments/stress/forms.h"
#include "tests/instruments/stress/stress.h"

namespace fragtrace {

// Rays alone: traversal on the device against double precision.

/// The attack's rays by every way of finding triangles that takes the scene.
StressOutcome attackByRays(const StressSetting& setting, const RayAttack& attack);

// Closed shells in a bright world: whoever is inside sees none of it.

/// A black shell of 80,000 triangles; cases are camera rays, failures those that meet nothing.
StressOutcome lookOutOfBlackShell(const StressSetting& setting);
/// Does the same at (148376, 1234, -223423), in coordinates that are rounded there.
StressOutcome lookOutOfFarShell(const StressSetting& setting);
/// A white one with one point of its surface at the origin, path traced; cases are paths, failures pixels
/// that are not black.
StressOutcome scatterInWhiteShell(const StressSetting& setting);
/// Traces paths inside white shells of spikes. The shells are instances of one mesh, turned, evenly scaled
/// and up to a kilometre away. Cases and failures are those of scatterInWhiteShell().
StressOutcome scatterInSharedShells(const StressSetting& setting);

// Closed prisms in a bright world: wedges that are cut into slivers, boxes, and boxes with see-through skins.

/// Closed white wedges of 1 to 60 degrees, turned at random, each face cut into strips of random widths,
/// across or along the crease, once wound alike and once at random; path traced, by a tree and (wedges of
/// fewer strips) as literals. Cases are paths, failures pixels that are not black.
StressOutcome scatterInStrips(const StressSetting& setting);

/// Does the same in boxes of 12 triangles, up to a thousand times as long as wide, with angles of 89 to 91
/// degrees.
StressOutcome scatterInBoxes(const StressSetting& setting);

/// In cubes on whose walls, or less than an offset away from them, lie see-through skins: BLEND, or MASK that
/// is cut out everywhere.
StressOutcome scatterInSkinnedBoxes(const StressSetting& setting);

// Closed meshes that leak (docs/design/ray-origins.md): cases are paths inside, failures pixels that are not
// black.

/// Shells that are instances of one mesh as in scatterInSharedShells(), scaled up to three times as much
/// along one axis as along another.
StressOutcome scatterInUnevenShells(const StressSetting& setting);
/// Prisms of three and four sides, about as long as wide, cut at random into triangles of all sizes.
StressOutcome scatterInCutMeshes(const StressSetting& setting);
/// Does the same in prisms 10,000 times as long as wide.
StressOutcome scatterInLongPrisms(const StressSetting& setting);
/// Boxes through whose walls pass sheets that share no edge with them.
StressOutcome scatterInCrossedBoxes(const StressSetting& setting);

// Shading in a white furnace: whatever normals and boundaries are, no pixel is black, too bright or not a
// number.

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

// Whole scenes: equivalent forms of random ones, trees of the worst shapes, very many samples.

/// Random scenes and their form: scenes that do not show the same.
StressOutcome drawForms(const StressSetting& setting, Form form);

/// The same: pixels in which one sample hits something else.
StressOutcome hitForms(const StressSetting& setting, Form form);

/// A million identical triangles (quick: 20,000), 64 samples per pixel: pixels that differ from one
/// triangle's in a bit, or in which a loop was cut.
StressOutcome drawIdentical(const StressSetting& setting);

/// 50,000 triangles of shrinking sizes (quick: 20,000), a fifth of them within one cell of the boxes' grid;
/// one ray of the framing camera a pixel: hits that double precision does not find. More would take a ray
/// more steps than RayCaster allows.
StressOutcome castAtShrinking(const StressSetting& setting);

/// 16 million samples of 1/3 (quick: a million) in each of 4 pixels: channels that are more than 1e-6 off.
StressOutcome addThirds(const StressSetting& setting);

/// Scenes whose file holds a number that is NaN, infinite or as large as floats can be. A scene fails if it
/// is not refused and its picture has samples that are not finite.
StressOutcome drawNoNumbers(const StressSetting& setting);

}  // namespace fragtrace
