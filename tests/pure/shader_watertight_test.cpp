// SPDX-License-Identifier: MIT
// No ray passes between two triangles of a closed mesh: shaders/intersect.glsl in float.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "glsl.h"
#include "shader_meshes.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::vec3;

bool hits(const ClosedMesh& mesh, int triangle, const vec3& origin, const glsl_float::RayShear& shear) {
  const auto& [a, b, c] = mesh.triangles[size_t(triangle)];
  const auto h = glsl_float::intersectTriangle(origin, shear, mesh.points[size_t(a)], mesh.points[size_t(b)],
                                               mesh.points[size_t(c)]);
  return h.hit && h.t > 0.0f;
}

/// Returns the number of rays that leave the mesh, of `count` rays from near the centre, aimed at edges and
/// vertices.
int leaks(const ClosedMesh& mesh, const dvec3& center, double size, int count, Draw& draw) {
  int leaked = 0;
  for (int k = 0; k < count; ++k) {
    const vec3 origin(center + draw.inCube(0.05 * size));
    const auto& [a, b] = mesh.edges[size_t(draw.integer(0, int(mesh.edges.size()) - 1))];
    const float along = k % 4 == 0 ? 0.0f : draw.unit();
    const vec3 target = mesh.points[size_t(a)] + along * (mesh.points[size_t(b)] - mesh.points[size_t(a)]);
    const vec3 direction = glm::normalize(target - origin);
    const glsl_float::RayShear shear = glsl_float::makeShear(direction);
    bool hit = false;
    for (int end : {a, b}) {
      for (int triangle : mesh.around[size_t(end)]) hit = hit || hits(mesh, triangle, origin, shear);
    }
    for (size_t triangle = 0; !hit && triangle < mesh.triangles.size(); ++triangle) {
      hit = hits(mesh, int(triangle), origin, shear);
    }
    leaked += hit ? 0 : 1;
  }
  return leaked;
}

TEST(ShaderWatertight, AMillionRaysAtSharedEdgesAndVerticesAllHit) {
  Draw draw(1);
  const ClosedMesh mesh = bumpyBall(4, dvec3(0), 1.0, draw);
  ASSERT_EQ(mesh.edges.size(), mesh.triangles.size() * 3 / 2);  // closed
  EXPECT_EQ(leaks(mesh, dvec3(0), 1.0, 1000000, draw), 0);
}

TEST(ShaderWatertight, HoldsAwayFromTheOrigin) {
  Draw draw(2);
  const dvec3 center(1484.0, 1234.0, -2234.0);
  const ClosedMesh mesh = bumpyBall(3, center, 1.0, draw);
  EXPECT_EQ(leaks(mesh, center, 1.0, 200000, draw), 0);
}

TEST(ShaderWatertight, HoldsAtTinyAndHugeScales) {
  for (double size : {1e-6, 1e6}) {
    Draw draw(3);
    const ClosedMesh mesh = bumpyBall(3, dvec3(0), size, draw);
    EXPECT_EQ(leaks(mesh, dvec3(0), size, 100000, draw), 0) << "size " << size;
  }
}

TEST(ShaderWatertight, RaysAlongAxesThroughVerticesHit) {
  Draw draw(4);
  const ClosedMesh mesh = bumpyBall(3, dvec3(0), 1.0, draw);
  for (const vec3& point : mesh.points) {
    for (int axis = 0; axis < 3; ++axis) {
      for (float sign : {-1.0f, 1.0f}) {
        // The ray comes from outside through the vertex and the whole ball: in and out, or past it on both
        // sides of a silhouette.
        vec3 origin = point;
        origin[axis] = -4.0f * sign;
        vec3 direction(0.0f);
        direction[axis] = sign;
        const glsl_float::RayShear shear = glsl_float::makeShear(direction);
        bool hit = false;
        for (size_t t = 0; t < mesh.triangles.size(); ++t) hit = hit || hits(mesh, int(t), origin, shear);
        EXPECT_TRUE(hit);
      }
    }
  }
}

}  // namespace
}  // namespace fragtrace
