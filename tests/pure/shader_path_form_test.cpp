// SPDX-License-Identifier: MIT
// shaders/caustics/form.glsl: each path is brought either by camera paths or by light paths.
#include <gtest/gtest.h>

#include <string>

#include "glsl_lights.h"

namespace fragtrace {
namespace {

using glsl_float::cameraPrefix;
using glsl_float::lightPrefix;
using glsl_float::lightScatters;

/// A vertex of a path: D rough, R a glossy caster, S a delta lobe of a caster, G one of another material, T
/// straight through a thin wall.
struct Vertex {
  bool delta;
  bool straight;
  bool caster;
};

bool isRough(char c) { return c == 'D' || c == 'R'; }

Vertex vertexOf(char c) { return {!isRough(c), c == 'T', c == 'S' || c == 'R'}; }

/// Returns true if the camera path E vertices L leaves its light out.
bool cameraLeavesOut(const std::string& vertices) {
  int prefix = glsl_float::kPrefixNone;
  for (size_t i = 0; i < vertices.size(); ++i) {
    const Vertex v = vertexOf(vertices[i]);
    prefix = cameraPrefix(prefix, i == 0, v.delta, v.straight, v.caster);
  }
  return prefix == glsl_float::kPrefixCaustic;
}

/// Returns true if the light path L vertices E ends at the camera.
bool lampFinds(const std::string& vertices) {
  int prefix = glsl_float::kPrefixNone;
  for (size_t i = vertices.size(); i-- > 1;) {
    const Vertex v = vertexOf(vertices[i]);
    if (!lightScatters(prefix, v.delta, v.straight, v.caster)) return false;
    prefix = lightPrefix(prefix, v.delta, v.straight);
  }
  return prefix != glsl_float::kPrefixNone &&
         isRough(vertices[0]);  // lightPathAt() decides in the same way where a path may be seen
}

/// The same by the definition: E D, then anything, next to the lamp a run of casters and thin walls that
/// begins behind a rough surface and holds a caster. A glossy one can only be the caster next to the lamp.
bool isCaustic(const std::string& vertices) {
  const size_t last = vertices.find_last_not_of('T');
  if (last == std::string::npos || last == 0 || !vertexOf(vertices[last]).caster) return false;
  const size_t rough = vertices.find_last_not_of("ST", last - 1);
  return rough != std::string::npos && isRough(vertices[rough]) && isRough(vertices[0]);
}

TEST(ShaderPathForm, EachPathIsCountedOnce) {
  const std::string kinds = "DRSGT";
  size_t caustics = 0;
  size_t codes = 1;
  for (size_t length = 1; length <= 8; ++length) {
    codes *= kinds.size();
    for (size_t code = 0; code < codes; ++code) {
      std::string vertices;
      for (size_t i = 0, rest = code; i < length; ++i, rest /= kinds.size())
        vertices += kinds[rest % kinds.size()];
      ASSERT_EQ(cameraLeavesOut(vertices), isCaustic(vertices)) << vertices;
      ASSERT_EQ(lampFinds(vertices), isCaustic(vertices)) << vertices;
      caustics += isCaustic(vertices) ? 1 : 0;
    }
  }
  EXPECT_EQ(caustics, 65428u);
}

}  // namespace
}  // namespace fragtrace
