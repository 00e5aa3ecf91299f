// SPDX-License-Identifier: MIT
// Sentences about scenes of which little or nothing is seen.
#pragma once

#include <string>

#include "scene/scene.h"
#include "scene/selection.h"

namespace fragtrace {

/// Says that what is selected of the scene has nothing to draw; empty: it has.
std::string whyEmpty(const Scene& scene, const SceneSelection& selection);

/// Says which node reaches so far beyond nearly all triangles that they are a dot where the whole scene is
/// framed; empty: none does. Looks at a sample of the triangles, and at all of them only where there is such
/// a node.
std::string strayNode(const Scene& scene);

}  // namespace fragtrace
