// SPDX-License-Identifier: MIT
#include "gltf/build/skin.h"

#include <algorithm>
#include <cmath>

#include "gltf/read/accessor.h"

namespace fragtrace {
namespace {

/// Inverse bind matrices of a skin; none: the identity for all.
std::vector<glm::dmat4> bindMatrices(Document& document, int skin) {
  const Skin& source = document.skins.at(size_t(skin));
  const std::string place = pointerTo("skins", skin, "inverseBindMatrices");
  if (source.inverseBindMatrices < 0) return std::vector<glm::dmat4>(source.joints.size(), glm::dmat4(1.0));
  takeMemory(document, place, accessorCount(document, source.inverseBindMatrices) * sizeof(glm::dmat4));
  std::vector<glm::dmat4> matrices = readMatrices(document, source.inverseBindMatrices, place);
  if (matrices.size() < source.joints.size()) {
    document.diagnostics.lose(place, "has " + std::to_string(matrices.size()) + " matrices for " +
                                         std::to_string(source.joints.size()) + " joints");
  }
  size_t broken = 0;
  for (glm::dmat4& matrix : matrices) {
    for (int column = 0; column < 4; ++column) {
      const double expected = column == 3 ? 1.0 : 0.0;
      broken += matrix[column][3] != expected;
      matrix[column][3] = expected;
    }
  }
  if (broken > 0)
    document.diagnostics.warn(place, "a last row that is not 0, 0, 0, 1 is taken as that", broken);
  return matrices;
}

/// Faults in the weights of a primitive, counted over its vertices.
struct WeightFaults {
  size_t unusable = 0;  ///< negative or not finite, taken as 0
  size_t missing = 0;   ///< all are 0
  size_t sums = 0;      ///< they do not add up to 1
};

/// Makes the weights of one vertex add up to 1.
void normalize(std::span<Influence> influences, WeightFaults& faults) {
  // Four to eight weights in bytes, each off by half of 1 / 255.
  constexpr double kRoundedToBytes = 0.0157;
  double sum = 0.0;
  for (Influence& influence : influences) {
    if (!(influence.weight >= 0.0f) || !std::isfinite(influence.weight)) {
      influence.weight = 0.0f;
      ++faults.unusable;
    }
    sum += double(influence.weight);
  }
  if (sum == 0.0) {
    influences[0].weight = 1.0f;
    ++faults.missing;
    return;
  }
  faults.sums += std::abs(sum - 1.0) > kRoundedToBytes;
  for (Influence& influence : influences) influence.weight = float(double(influence.weight) / sum);
}

void normalizeAll(std::vector<Influence>& influences, size_t perVertex, const std::string& place,
                  Diagnostics& diagnostics) {
  WeightFaults faults;
  for (size_t i = 0; i < influences.size(); i += perVertex)
    normalize(std::span(influences).subspan(i, perVertex), faults);
  const auto warn = [&](size_t count, const char* reason) {
    if (count > 0) diagnostics.warn(place, reason, count);
  };
  warn(faults.unusable, "a weight of a joint that is negative or not finite is taken as 0");
  warn(faults.missing, "a vertex whose joints all weigh 0 follows the first");
  warn(faults.sums, "weights of joints that do not add up to 1 are scaled");
}

/// The sets of JOINTS_n that have their WEIGHTS_n, counted from 0.
size_t influenceSets(const tinygltf::Primitive& primitive) {
  size_t sets = 0;
  while (primitive.attributes.contains("JOINTS_" + std::to_string(sets)) &&
         primitive.attributes.contains("WEIGHTS_" + std::to_string(sets)))
    ++sets;
  return sets;
}

}  // namespace

std::vector<glm::dmat4> jointMatrices(Document& document, int node,
                                      const std::vector<const PlacedNode*>& nodes) {
  const int skin = document.model.nodes.at(size_t(node)).skin;
  std::vector<glm::dmat4> matrices = bindMatrices(document, skin);
  const std::vector<int>& joints = document.skins.at(size_t(skin)).joints;
  matrices.resize(joints.size());
  for (size_t i = 0; i < joints.size(); ++i) {
    const PlacedNode* joint = nodes.at(size_t(joints[i]));
    if (joint == nullptr) {
      document.diagnostics.lose(pointerTo("nodes", node, "skin"),
                                "its joint, node " + std::to_string(joints[i]) + ", is not in the scene");
    }
    matrices[i] = joint->world * matrices[i];
    if (!isMultiplicable(matrices[i]))
      document.diagnostics.lose(pointerTo("skins", skin, "joints", i), "its matrix overflows");
  }
  return matrices;
}

std::vector<Influence> readInfluences(Document& document, const tinygltf::Primitive& primitive,
                                      size_t jointCount, const std::string& place) {
  constexpr size_t kInASet = 4;
  const size_t sets = influenceSets(primitive);
  const size_t perVertex = sets * kInASet;
  const size_t count = accessorCount(document, primitive.attributes.at("POSITION"));
  takeMemory(document, place,
             count * (perVertex * sizeof(Influence) + sizeof(glm::uvec4) + sizeof(glm::vec4)));
  std::vector<Influence> influences(count * perVertex);
  for (size_t set = 0; set < sets; ++set) {
    const std::string joints = "JOINTS_" + std::to_string(set);
    const std::string weights = "WEIGHTS_" + std::to_string(set);
    for (const std::string& name : {joints, weights}) {
      const size_t elements = accessorCount(document, primitive.attributes.at(name));
      if (elements == count) continue;
      document.diagnostics.lose(
          place + pointerTo("attributes", name),
          "has " + std::to_string(elements) + " elements for " + std::to_string(count) + " positions");
    }
    const std::string jointPlace = place + pointerTo("attributes", joints);
    const auto jointsOf = readJoints(document, primitive.attributes.at(joints), jointPlace);
    const auto weightsOf = readVectors<4>(document, primitive.attributes.at(weights),
                                          place + pointerTo("attributes", weights), Integers::Fractions);
    for (size_t i = 0; i < count; ++i) {
      for (int k = 0; k < int(kInASet); ++k) {
        Influence influence{jointsOf[i][k], weightsOf[i][k]};
        if (influence.joint >= jointCount) {
          if (influence.weight != 0.0f) {
            document.diagnostics.lose(jointPlace, "joint " + std::to_string(influence.joint) +
                                                      " is past the " + std::to_string(jointCount) +
                                                      " of the skin");
          }
          document.diagnostics.warn(jointPlace, "a joint that is none of the skin's weighs 0");
          influence.joint = 0;
        }
        influences[i * perVertex + set * kInASet + size_t(k)] = influence;
      }
    }
  }
  if (sets > 0) normalizeAll(influences, perVertex, place + "/attributes/WEIGHTS_0", document.diagnostics);
  return influences;
}

}  // namespace fragtrace
