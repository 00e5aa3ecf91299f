// SPDX-License-Identifier: MIT

#include <algorithm>
#include <cmath>

#include "base/vectors.h"
#include "base/words.h"
#include "pack/pack_tree.h"

namespace fragtrace {
namespace {

float wordFloat(uint32_t word) { return std::bit_cast<float>(word); }

float roundedUp(double x) { return std::nextafter(float(x), std::numeric_limits<float>::infinity()); }

glm::vec3 rowOf(const glm::mat3& m, int row) { return {m[0][row], m[1][row], m[2][row]}; }

void appendInstance(const Instance& instance, const BvhMesh& tree, Words& words) {
  const glm::mat3 toLocal{glm::dmat3(instance.toLocal)};
  const glm::mat3 toMesh{glm::inverse(glm::dmat3(toLocal))};
  const glm::vec3 place{glm::dvec3(instance.toLocal[3])};
  const InstanceOffset offset = instanceOffset(glm::dmat3(toLocal), glm::dmat3(toMesh), glm::dvec3(place));
  for (int row = 0; row < 3; ++row) appendRow(words, rowOf(toMesh, row), place[row]);
  appendRow(words, glm::vec3(wordFloat(tree.wideRoot), roundedUp(offset.scale), 0.0f), 0.0f);
  const float handedness = glm::determinant(glm::dmat3(toLocal)) < 0.0 ? -1.0f : 1.0f;
  const std::array<float, 3> beside{roundedUp(offset.base), handedness,
                                    roundedUp(stretchBound(glm::dmat3(toMesh)))};
  for (int row = 0; row < 3; ++row) appendRow(words, rowOf(toLocal, row), beside[size_t(row)]);
}

}  // namespace

InstanceOffset instanceOffset(const glm::dmat3& toLocal, const glm::dmat3& toMesh, const glm::dvec3& place) {
  constexpr double kUnit = 0x1p-24;
  constexpr double kOfMeshOffset = 32.0;  // units in hitPointError()
  const double stretch = stretchBound(toLocal);
  const double there = rowNorm(toLocal);
  const double back = rowNorm(toMesh);
  const glm::dvec3 far = glm::abs(place);
  return {(stretch * (22.0 + 9.0 * back * there + 24.0 * back * stretch) + 9.0 * there) / kOfMeshOffset,
          4.0 * kUnit * std::max({far.x, far.y, far.z})};
}

uint32_t firstInstanceBlock(const Bvh& bvh) {
  return uint32_t((bvh.wide.size() * layout::kNodeRows + layout::kInstanceRows - 1) / layout::kInstanceRows);
}

void appendInstances(const Scene& scene, const Bvh& bvh, Words& nodes) {
  constexpr size_t kBlockWords = size_t(layout::kInstanceRows) * 4;
  checkIndices("instances", firstInstanceBlock(bvh) + scene.instances.size());
  nodes.reserve((firstInstanceBlock(bvh) + scene.instances.size()) * kBlockWords);
  nodes.resize(firstInstanceBlock(bvh) * kBlockWords);
  for (const Instance& instance : scene.instances) appendInstance(instance, bvh.meshes[instance.mesh], nodes);
}

}  // namespace fragtrace
