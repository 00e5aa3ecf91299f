// SPDX-License-Identifier: MIT
#include "bvh/moving_tree.h"

#include "bvh/refit.h"
#include "scene/motion/moving_scene.h"

namespace fragtrace {

namespace {

/// Boxes of primitives in a pose: triangles first, then spheres.
std::vector<Bounds> boundsInPose(const Scene& scene, uint32_t pose) {
  const ShutterMotion& motion = scene.motion;
  std::vector<Bounds> bounds;
  bounds.reserve(motion.triangles + motion.spheres);
  for (uint32_t i = 0; i < motion.triangles; ++i) {
    Triangle t = scene.triangles[i];
    t.vertex += pose * motion.vertices;
    Bounds box;
    for (const glm::vec3& corner : cornersOf(scene, t)) box.include(corner);
    bounds.push_back(box);
  }
  for (uint32_t i = 0; i < motion.spheres; ++i)
    bounds.push_back(sphereBounds(scene.spheres[pose * motion.spheres + i]));
  return bounds;
}

/// The primitive of a segment, from its index in the boxes of the segment.
uint32_t primitiveIn(const Scene& scene, uint32_t segment, uint32_t primitive) {
  const ShutterMotion& motion = scene.motion;
  if (primitive == kMissIndex) return primitive;
  if (primitive < motion.triangles) return segment * motion.triangles + primitive;
  return uint32_t(scene.triangles.size()) + segment * motion.spheres + primitive - motion.triangles;
}

}  // namespace

Bvh buildMovingBvh(const Scene& scene) {
  const ShutterMotion& motion = scene.motion;
  const uint32_t middle = motion.segments / 2;
  std::vector<Bounds> whole = boundsInPose(scene, middle);
  const std::vector<Bounds> next = boundsInPose(scene, middle + 1);
  for (size_t i = 0; i < whole.size(); ++i) whole[i].include(next[i]);
  Bvh begins = buildBvh(std::move(whole), motion.triangles);
  Bvh ends = begins;
  const auto nodes = uint32_t(begins.nodes.size());
  const auto leaves = uint32_t(begins.leaves.size());
  Bvh all;
  all.depth = begins.depth;
  all.stackNeed = begins.stackNeed;
  const auto wide = uint32_t(begins.wide.size());
  for (uint32_t segment = 0; segment < motion.segments; ++segment) {
    refitTo(begins, boundsInPose(scene, segment));
    refitTo(ends, boundsInPose(scene, segment + 1));
    all.bounds.include(begins.bounds);
    all.bounds.include(ends.bounds);
    for (BvhNode node : begins.nodes) {
      for (uint32_t& child : node.child) child += segment * ((child & kBvhLeafBit) != 0 ? leaves : nodes);
      all.nodes.push_back(node);
    }
    for (WideNode node : begins.wide) {
      for (uint32_t& place : node.place) place += segment * 2 * nodes;
      node.firstInner += segment * wide;
      all.wide.push_back(node);
    }
    for (const BvhNode& node : ends.nodes) all.endBounds.push_back(node.bounds);
    for (BvhLeaf leaf : begins.leaves) {
      for (uint32_t& primitive : leaf.primitive) primitive = primitiveIn(scene, segment, primitive);
      all.leaves.push_back(leaf);
    }
  }
  return all;
}

}  // namespace fragtrace
