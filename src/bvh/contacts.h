// SPDX-License-Identifier: MIT
// Faces that lie on glass, solids that touch, and lamps that lie in surfaces.
#pragma once

#include <cstddef>

#include "scene/scene.h"
#include "scene/solids.h"

namespace fragtrace {

/// A ray that leaves glass starts a little beyond its face (docs/design/ray-origins.md), and so beyond an
/// opaque face in the same place. So opaque triangles that lie on a triangle of glass, or nearer to it than
/// four offsets, are moved that far off it, with all opaque triangles that share their corners: outwards from
/// solid glass, and back from their own front where the glass is thin. Instances of shared meshes and spheres
/// stay where they are. Returns the number of triangles that lay on glass.
size_t partFromGlass(Scene& scene);

/// A ray that leaves a solid starts a little beyond its face, and so beyond the face of another solid in the
/// same place, such as that of water that fills a glass. Where faces of two parts of solids coincide or lie
/// nearer than four offsets, those of the smaller part are moved inwards by so much. Instances of shared
/// meshes and spheres stay where they are.
void partSolids(Scene& scene, const std::vector<SolidPart>& parts);

/// Marks emissive triangles with which another surface coincides (scene/coincidence.h).
void markLampsInSurfaces(Scene& scene);

}  // namespace fragtrace
