// SPDX-License-Identifier: MIT
#include "bvh/moving_tree.h"

#include "bvh/refit.h"
#include "scene/motion/moving_scene.h"

namespace fragtrace {

namespace {

/// Boxes of a segment's primitives: triangles first, then spheres.
std::vector<Bounds> boundsIn(const Scene& scene, uint32_t segment) {
  const ShutterMotion& motion = scene.motion;
  std::vector<Bounds> bounds;
  bounds.reserve(motion.triangles + motion.spheres);
  for (uint32_t i = 0; i < motion.triangles; ++i) {
    const Triangle& t = scene.triangles[segment * motion.triangles + i];
    Bounds box;
    for (const glm::vec3& corner : cornersOf(scene, t)) box.include(corner);
    for (const glm::vec3& corner : cornersOf(scene, atEnd(scene, t))) box.include(corner);
    bounds.push_back(box);
  }
  for (uint32_t i = 0; i < motion.spheres; ++i) {
    const uint32_t sphere = segment * motion.spheres + i;
    Bounds box = sphereBounds(scene.spheres[sphere]);
    box.include(sphereBounds(atEnd(scene, sphere)));
    bounds.push_back(box);
  }
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
  const Bvh base = buildBvh(boundsIn(scene, motion.segments / 2), motion.triangles);
  const auto nodes = uint32_t(base.nodes.size());
  const auto leaves = uint32_t(base.leaves.size());
  Bvh all;
  all.depth = base.depth;
  for (uint32_t segment = 0; segment < motion.segments; ++segment) {
    Bvh tree = base;
    refitTo(tree, boundsIn(scene, segment));
    all.bounds.include(tree.bounds);
    for (BvhNode node : tree.nodes) {
      for (uint32_t& child : node.child) child += segment * ((child & kBvhLeafBit) != 0 ? leaves : nodes);
      all.nodes.push_back(node);
    }
    for (BvhLeaf leaf : tree.leaves) {
      for (uint32_t& primitive : leaf.primitive) primitive = primitiveIn(scene, segment, primitive);
      all.leaves.push_back(leaf);
    }
  }
  return all;
}

}  // namespace fragtrace
