// SPDX-License-Identifier: MIT
// Scenes at which ray tracers in 32-bit floats break; what is aimed at them is in ray_attacks.cpp.
#pragma once

#include <array>

#include "scene/scene.h"

namespace fragtrace::attack {

/// A closed mesh of 20,000 triangles.
Scene ball();
/// The same, a hundred times as large, in coordinates of 300 km.
Scene farBall();
/// Steps of quads that lie in planes of the axes.
Scene grid();
/// 1,500 triangles without order.
Scene scattered();
/// A metre long and a micrometre wide, some along axes.
Scene slivers();
/// Triangles without area, twenty identical ones, and some that overlap in one plane.
Scene flatAndDouble();
/// A triangle of ten kilometres next to one of a micrometre.
Scene hugeAndTiny();
/// Meshes around one point. Each is smaller than the one before, down to a millionth of the first.
Scene nested();
/// A hundred spheres with sizes from a millimetre to a metre.
Scene spheres();
/// A closed room with two boxes, off the origin, turned so that nothing is along an axis.
Scene room();
/// A closed room along the axes, its walls cut into tiles: neighbours' boxes meet in planes.
Scene tiledRoom();
/// The room of 500 nanometres.
Scene tinyRoom();
/// The room of 500,000 km.
Scene hugeRoom();

constexpr int kTiles = 24;  ///< along each side of a wall of the tiled room

/// Returns the coordinate at which the tiled room is cut along an axis; lines 0 and kTiles are its walls.
double tileLine(int axis, int line);

std::array<glm::dvec3, 3> corners(const Scene& scene, size_t triangle);

}  // namespace fragtrace::attack
