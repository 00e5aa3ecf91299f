// SPDX-License-Identifier: MIT
// Cameras and surfaces that move while the shutter is open: their poses, trees and shader functions.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtx/rotate_vector.hpp>

#include "bvh/scene_tree.h"
#include "glsl.h"
#include "pack/pack_tree.h"
#include "scene/motion/moving_scene.h"

namespace fragtrace {
namespace {

using glm::dvec3;

Camera someCamera() {
  Camera camera;
  camera.position = {3.0, 1.0, 2.0};
  camera.forward = glm::normalize(dvec3(-3.0, -0.5, -2.0));
  camera.up = glm::normalize(dvec3(0.0, 1.0, 0.0) - camera.forward * camera.forward.y);
  return camera;
}

/// Turned about the vertical axis through a point.
Camera turnedAbout(const dvec3& point, double angle) {
  Camera camera = someCamera();
  camera.position = point + glm::rotateY(camera.position - point, angle);
  camera.forward = glm::rotateY(camera.forward, angle);
  camera.up = glm::rotateY(camera.up, angle);
  return camera;
}

void expectSame(const Camera& a, const Camera& b) {
  EXPECT_LE(glm::distance(a.position, b.position), 1e-12);
  EXPECT_LE(glm::distance(a.forward, b.forward), 1e-12);
  EXPECT_LE(glm::distance(a.up, b.up), 1e-12);
}

TEST(CameraMotion, ATurntableRunsOnItsCircle) {
  const dvec3 focalPoint(0.5, 0.2, -0.3);
  for (const double angle : {1e-7, 0.02, 0.5, 3.0}) {
    const auto turned = [&](double part) { return turnedAbout(focalPoint, part * angle); };
    const CameraMotion motion = motionBetween(turned(-0.5), turned(0.5));
    EXPECT_NEAR(std::abs(motion.angle), angle, 1e-9 + 1e-9 * angle);
    for (const double part : {-0.5, -0.3, 0.0, 0.1, 0.5})
      expectSame(movedBy(motion, part, turned(0.0)), turned(part));
  }
}

TEST(CameraMotion, ACameraThatOnlyMovesRunsStraight) {
  Camera first = someCamera();
  Camera last = first;
  last.position += dvec3(1.0, -2.0, 0.5);
  const CameraMotion motion = motionBetween(first, last);
  EXPECT_EQ(motion.angle, 0.0);
  Camera middle = first;
  middle.position = 0.5 * (first.position + last.position);
  expectSame(movedBy(motion, -0.5, middle), first);
  expectSame(movedBy(motion, 0.5, middle), last);
  EXPECT_EQ(motionBetween(first, first).slide, dvec3(0.0));
}

TEST(CameraMotion, SegmentsLeadThroughAllPoses) {
  const dvec3 focalPoint(0.5, 0.2, -0.3);
  std::vector<Camera> poses;
  for (int i = 0; i <= 5; ++i) {
    poses.push_back(turnedAbout(focalPoint, 1.2 * i));
    poses.back().position.y += 0.3 * i;
  }
  const std::vector<CameraSegment> segments = segmentsThrough(poses);
  ASSERT_EQ(segments.size(), 5u);
  for (size_t i = 0; i <= 5; ++i) expectSame(cameraAt(segments, double(i) / 5.0), poses[i]);
  Camera between = turnedAbout(focalPoint, 1.2 * 2.25);
  between.position.y += 0.3 * 2.25;
  expectSame(cameraAt(segments, 2.25 / 5.0), between);
  EXPECT_TRUE(segmentsThrough(std::vector<Camera>(3, someCamera())).empty());
}

TEST(CameraMotion, TheShaderMovesAlike) {
  for (const double angle : {0.0, 1e-4, 0.09, 0.11, 1.5, 3.1}) {
    CameraMotion motion;
    motion.axis = glm::normalize(dvec3(0.2, 1.0, -0.4));
    motion.angle = angle;
    motion.slide = {0.7, -0.2, 0.4};
    for (const double part : {-0.5, -0.2, 0.0, 0.3, 0.5}) {
      const Camera expected = movedBy(motion, part, someCamera());
      const auto moved = glsl_double::motionOver(glm::dvec4(motion.axis, angle), motion.slide, part);
      EXPECT_LE(glm::distance(someCamera().position + moved.shift, expected.position), 2e-7)
          << angle << " " << part;
      EXPECT_LE(glm::distance(turnedBy(moved, someCamera().forward), expected.forward), 2e-7)
          << angle << " " << part;
      const auto rounded = glsl_float::motionOver(glm::vec4(glm::vec3(motion.axis), float(angle)),
                                                  glm::vec3(motion.slide), float(part));
      EXPECT_LE(glm::distance(dvec3(rounded.shift), moved.shift), 5e-7) << angle << " " << part;
    }
  }
}

/// Triangles in a row and a sphere, at a time of their motion along a parabola.
Pose poseAt(double time) {
  Pose pose;
  for (int i = 0; i < 9; ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      const glm::vec3 at(float(2 * i + (corner == 1)), float(corner == 2), 0.3f * float(i));
      pose.vertices.position.push_back(at + glm::vec3(0.0f, float(time * time), float(time * i)));
    }
  }
  Sphere sphere;
  sphere.center = {0.0f, float(5.0 + time * time), 0.0f};
  sphere.radius = float(0.5 + time);
  pose.spheres.push_back(sphere);
  pose.insets.assign(9, time > 0.6 ? 3u << 5 | 7u : 0u << 5 | 9u);
  return pose;
}

Scene sceneAt(double time) {
  Scene scene;
  const Pose pose = poseAt(time);
  scene.vertices = pose.vertices;
  scene.vertices.color.assign(27, glm::vec4(0.5f));
  scene.spheres = pose.spheres;
  for (uint32_t i = 0; i < 9; ++i) scene.triangles.push_back({{3 * i, 3 * i + 1, 3 * i + 2}});
  scene.materials.resize(1);
  scene.origins.push_back({"node", "mesh", 0, 9, 4});
  return scene;
}

Scene movingRow() {
  const std::vector<Pose> poses{poseAt(0.0), poseAt(0.5), poseAt(1.0)};
  return movingScene(sceneAt(0.5), poses);
}

TEST(MovingScene, HoldsOneSegmentAfterTheOther) {
  const Scene scene = movingRow();
  EXPECT_EQ(scene.motion.segments, 2u);
  ASSERT_EQ(scene.triangles.size(), 18u);
  ASSERT_EQ(scene.vertices.position.size(), 81u);
  EXPECT_EQ(scene.vertices.color.size(), 81u);
  ASSERT_EQ(scene.spheres.size(), 3u);
  EXPECT_EQ(scene.triangles[9 + 4].vertex, glm::uvec3(27 + 12, 27 + 13, 27 + 14));
  EXPECT_EQ(atEnd(scene, scene.triangles[4]).vertex, scene.triangles[9 + 4].vertex);
  EXPECT_EQ(atEnd(scene, 1u).center, scene.spheres[2].center);
  EXPECT_EQ(scene.origins.back().firstTriangle, 9u);
  // The larger inset of both ends: the smaller code that is not 0.
  EXPECT_EQ(scene.insets[0], 9u);
  EXPECT_EQ(scene.insets[9], 3u << 5 | 7u);
  EXPECT_TRUE(matches(poseAt(0.1), sceneAt(0.9)));
  EXPECT_FALSE(isSame(poseAt(0.1), poseAt(0.2)));
}

TEST(MovingScene, APoseOfAnotherSpaceIsTakenOver) {
  Scene scene = sceneAt(1.0);
  scene.space = {{10.0, 20.0, 30.0}, 2.0};
  const glm::dvec3 corner = scene.space.worldOf(glm::dvec3(scene.vertices.position[7]));
  const double radius = scene.spheres[0].radius * scene.space.unit;
  const LocalSpace space{{9.0, 20.0, 28.0}, 0.5};
  const Pose pose = poseOf(std::move(scene), space);
  EXPECT_LE(glm::distance(space.worldOf(glm::dvec3(pose.vertices.position[7])), corner), 1e-5);
  EXPECT_NEAR(pose.spheres[0].radius * space.unit, radius, 1e-6);
}

/// The slots below a node, and a check that its boxes hold them throughout their segment.
void checkBelow(const Scene& scene, const Bvh& bvh, uint32_t node, std::vector<uint32_t>& slots) {
  for (size_t side : {0, 1}) {
    const uint32_t child = bvh.nodes.at(node).child[side];
    const size_t first = slots.size();
    if ((child & kBvhLeafBit) == 0) {
      checkBelow(scene, bvh, child, slots);
    } else {
      for (uint32_t i : {0, 1}) slots.push_back(2 * (child & ~kBvhLeafBit) + i);
    }
    const Bounds& begins = bvh.nodes[node].bounds[side];
    const Bounds& ends = bvh.endBounds[node][side];
    for (size_t i = first; i < slots.size(); ++i) {
      const uint32_t primitive = primitiveInSlot(bvh, int32_t(slots[i]));
      if (primitive >= scene.triangles.size()) continue;
      const Triangle& t = scene.triangles[primitive];
      for (const float part : {0.0f, 0.37f, 1.0f}) {
        for (int corner = 0; corner < 3; ++corner) {
          const glm::vec3 place =
              glm::mix(cornersOf(scene, t)[corner], cornersOf(scene, atEnd(scene, t))[corner], part);
          EXPECT_TRUE(
              glm::all(glm::lessThanEqual(glm::mix(begins.minimum, ends.minimum, part), place + 1e-6f)));
          EXPECT_TRUE(
              glm::all(glm::lessThanEqual(place - 1e-6f, glm::mix(begins.maximum, ends.maximum, part))));
        }
      }
    }
  }
}

TEST(MovingTree, EachSegmentHasItsOwnPrimitives) {
  const Scene scene = movingRow();
  const Bvh bvh = buildMovingBvh(scene);
  const glm::ivec4 segments = segmentsOf(scene, bvh);
  EXPECT_EQ(segments.x, 2);
  EXPECT_EQ(segments.w, 27);
  for (uint32_t segment : {0, 1}) {
    std::vector<uint32_t> slots;
    checkBelow(scene, bvh, segment * uint32_t(bvh.nodes.size() / 2), slots);
    std::vector<bool> seen(scene.triangles.size() + 2, false);
    for (const uint32_t slot : slots) {
      EXPECT_EQ(slot / 2 / uint32_t(segments.z), segment);
      const uint32_t primitive = primitiveInSlot(bvh, int32_t(slot));
      if (primitive != kMissIndex) seen.at(primitive) = true;
    }
    for (uint32_t i = 0; i < 18; ++i) EXPECT_EQ(seen[i], i / 9 == segment);
    EXPECT_TRUE(seen[18 + segment]);
  }
}

TEST(MovingTree, DecodedBoxesHoldTheirsAtAnyTime) {
  const Scene scene = movingRow();
  const Bvh bvh = buildMovingBvh(scene);
  const Words nodes = packNodes(bvh, true);
  const glsl_variant::With<std::span<const uint32_t>> withNodes(glsl_variant::nodes, nodes);
  ASSERT_GT(bvh.wide.size(), 2u);
  for (size_t i = 0; i < bvh.wide.size(); ++i) {
    const WideNode& wide = bvh.wide[i];
    for (const float part : {0.0f, 0.21f, 0.5f, 0.83f, 1.0f}) {
      const auto n = glsl_float::loadMovingNode(int(i), glm::vec3(1.0f), part);
      const std::array low{n.nearX, n.nearY, n.nearZ};
      const std::array high{n.farX, n.farY, n.farZ};
      for (int k = 0; k < wide.count; ++k) {
        const uint32_t place = wide.place[size_t(k)];
        const Bounds& begins = boxAt(bvh, place);
        const Bounds& ends = bvh.endBounds[place / 2][place % 2];
        for (int axis = 0; axis < 3; ++axis) {
          const double origin = n.origin[axis];
          const double cell = n.cell[axis];
          const double least = std::lerp(double(begins.minimum[axis]), double(ends.minimum[axis]), part);
          const double most = std::lerp(double(begins.maximum[axis]), double(ends.maximum[axis]), part);
          EXPECT_LE(origin + cell * double(low[size_t(axis)][k]), least);
          EXPECT_GE(origin + cell * double(high[size_t(axis)][k]), most);
          EXPECT_GE(origin + cell * double(low[size_t(axis)][k]), least - 1.02 * cell - 1e-5);
          EXPECT_LE(origin + cell * double(high[size_t(axis)][k]), most + 1.02 * cell + 1e-5);
        }
      }
    }
  }
}

TEST(MovingTree, TheShaderFindsATriangleOnItsWay) {
  const Scene scene = movingRow();
  const Bvh bvh = buildMovingBvh(scene);
  const glm::ivec4 segments = segmentsOf(scene, bvh);
  const Words nodes = packNodes(bvh, true);
  const Words leaves = packLeaves(scene, bvh, true);
  const glsl_variant::With<bool> moving(glsl_variant::kMoving, true);
  const glsl_variant::With<std::span<const uint32_t>> withNodes(glsl_variant::nodes, nodes);
  const glsl_variant::With<std::span<const uint32_t>> withLeaves(glsl_variant::leaves, leaves);
  const glsl_float::TreeFrame frame{0.0f, int(bvh.leaves.size())};
  for (const float time : {0.0f, 0.2f, 0.5f, 0.75f, 0.999f}) {
    const auto moment = glsl_float::momentAt(time, segments.x);
    EXPECT_EQ(moment.segment, time < 0.5f ? 0 : 1);
    for (int i = 0; i < 9; ++i) {
      std::array<glm::dvec3, 3> corners;
      for (int corner = 0; corner < 3; ++corner) {
        const auto at = [&](double poseTime) {
          return dvec3(poseAt(poseTime).vertices.position[3 * i + corner]);
        };
        const double first = 0.5 * moment.segment;
        corners[corner] = glm::mix(at(first), at(first + 0.5), 2.0 * (time - first));
      }
      const dvec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
      const glm::vec3 origin(middle + dvec3(0.0, 0.0, 3.0));
      auto s = glsl_float::beginAt(glsl_float::startTraversal(1e30f, frame.leafCount), moment, segments.y);
      s = glsl_float::traverse(origin, glm::vec3(0.0f, 0.0f, -1.0f), 1e30f, s, frame, 1000, false);
      ASSERT_GE(s.slot, 0) << time << " " << i;
      EXPECT_EQ(primitiveInSlot(bvh, s.slot), uint32_t(9 * moment.segment + i));
      EXPECT_NEAR(s.t, 3.0f, 1e-4f);
      EXPECT_NEAR(s.weights.x, 1.0f / 3.0f, 1e-4f);
      EXPECT_NEAR(s.weights.y, 1.0f / 3.0f, 1e-4f);
    }
  }
}

TEST(MovingTree, APlaneHoldsItsTriangleHoweverSmall) {
  for (const double size : {1.0, 1e-12, 1e12}) {
    const dvec3 v0 = size * dvec3(1.0, 2.0, 3.0);
    const dvec3 v1 = size * dvec3(4.0, -1.0, 2.0);
    const dvec3 v2 = size * dvec3(0.0, 0.5, -3.0);
    const glm::vec4 plane = glsl_float::planeThrough(glm::vec3(v0), glm::vec3(v1), glm::vec3(v2));
    const dvec3 normal = glm::normalize(glm::cross(v1 - v0, v2 - v0));
    EXPECT_LE(glm::distance(dvec3(glm::vec3(plane)), normal), 1e-6);
    EXPECT_NEAR(plane.w, glm::dot(normal, v0), 1e-6 * size * 4.0);
  }
}

}  // namespace
}  // namespace fragtrace
