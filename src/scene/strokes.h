// SPDX-License-Identifier: MIT
// Points and lines as thin solids, whose size follows from the camera.
#pragma once

#include "scene/scene.h"

namespace fragtrace {

/// Triangles of a solid for a point, and for a line segment.
inline constexpr size_t kTrianglesOfAPoint = 12;
inline constexpr size_t kTrianglesOfALine = 24;
/// Vertices of the larger of them.
inline constexpr size_t kMostStrokeVertices = 14;

/// Puts triangles after the others in local space, before those of shared meshes. Each of them is of one of
/// the origins, which begin at flatTriangleCount().
void insertFlatTriangles(Scene& scene, const std::vector<Triangle>& triangles,
                         const std::vector<PrimitiveOrigin>& origins);

/// The number of triangles of the solids of a list; a line that passes the camera takes twice as many.
size_t trianglesOf(const Strokes& strokes);

/// Appends a solid for each point and line segment of scene.strokes, as wide as `pixels` pixels of a picture
/// of that height in pixels through the camera. A point is a double pyramid over a hexagon, a segment a
/// hexagonal prism with pyramids at both ends; the hexagons have the area of the circle. The width of a
/// segment changes evenly from one end to the other. Strokes behind the camera are as wide as at the same
/// distance before it. Materials follow glTF 2.0 (section 3.7.2.1): without textures of normals, and unlit
/// where no normals were given. Sets scene.insets again. Does nothing to a scene without strokes.
void addStrokes(Scene& scene, const Camera& camera, glm::ivec2 pictureSize, double pixels);

}  // namespace fragtrace
