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

/// A vertex of a path: D rough, S a delta lobe of a caster, G one of another material, T straight through a
/// thin wall.
struct Vertex {
  bool delta;
  bool straight;
  bool caster;
};

Vertex vertexOf(char c) { return {c != 'D', c == 'T', c == 'S'}; }

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
         vertices[0] == 'D';  // as lightPathAt() decides where a path may be seen
}

/// The same by the definition: E D, then anything, beside the lamp a run of casters and thin walls that
/// begins behind a rough surface and holds a caster.
bool isCaustic(const std::string& vertices) {
  const size_t rough = vertices.rfind('D');
  if (vertices[0] != 'D') return false;
  const std::string run = vertices.substr(rough + 1);
  return run.find('S') != std::string::npos && run.find('G') == std::string::npos;
}

TEST(ShaderPathForm, EachPathIsCountedOnce) {
  const std::string kinds = "DSGT";
  size_t caustics = 0;
  for (size_t length = 1; length <= 8; ++length) {
    for (size_t code = 0; code < size_t(1) << (2 * length); ++code) {
      std::string vertices;
      for (size_t i = 0; i < length; ++i) vertices += kinds[code >> (2 * i) & 3];
      ASSERT_EQ(cameraLeavesOut(vertices), isCaustic(vertices)) << vertices;
      ASSERT_EQ(lampFinds(vertices), isCaustic(vertices)) << vertices;
      caustics += isCaustic(vertices) ? 1 : 0;
    }
  }
  EXPECT_EQ(caustics, 3763u);
}

}  // namespace
}  // namespace fragtrace
