// SPDX-License-Identifier: MIT
// Glass that has a thickness and bounds no solid.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "scene/solids.h"

namespace fragtrace {

/// Makes thin walls of open parts of solid glass that are panes, and takes them out of the parts: parts that
/// are flat within a thickness of at most a twentieth of their size, or whose open edges, for the most part,
/// are nearer than a thousandth of their size to no other surface. A part under which another surface lies
/// within its thickness, as the bed of a water does, stays a solid. A part is what hangs together by common
/// edges; shared meshes are left alone. Their triangles get copies of their materials, behind all others,
/// without thickness. Returns the number of such parts by the material's place.
std::map<std::string, size_t> thinOpenPanes(Scene& scene, std::vector<SolidPart>& parts);

}  // namespace fragtrace
