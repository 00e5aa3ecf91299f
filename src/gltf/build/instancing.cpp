// SPDX-License-Identifier: MIT
// EXT_mesh_gpu_instancing: a node shows its mesh at translation * rotation * scale, all of them attributes.
#include "gltf/build/nodes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numeric>
#include <optional>

#include "gltf/read/accessor.h"
#include "gltf/read/value.h"

namespace fragtrace {
namespace {

/// Orders transforms, by position first, since most differ in that.
bool standsBefore(const glm::dmat4& a, const glm::dmat4& b) {
  for (const int c : {3, 0, 1, 2}) {
    for (int r = 0; r < 3; ++r) {
      if (a[c][r] != b[c][r]) return a[c][r] < b[c][r];
    }
  }
  return false;
}

/// Leaves each place once, in the order in which they came, and returns how many there were besides. Rays
/// would have to pass all that coincide, one by one.
size_t dropRepeated(std::vector<glm::dmat4>& places) {
  const size_t count = places.size();
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<size_t> order(places.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    if (standsBefore(places[a], places[b])) return true;
    return !standsBefore(places[b], places[a]) && a < b;
  });
  std::vector<bool> isRepeated(places.size(), false);
  for (size_t i = 1; i < order.size(); ++i) isRepeated[order[i]] = places[order[i]] == places[order[i - 1]];
  size_t kept = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    if (!isRepeated[i]) places[kept++] = places[i];
  }
  places.resize(kept);
  return count - kept;
}

class InstanceReader {
 public:
  InstanceReader(Document& document, const PlacedNode& node, const tinygltf::Value& attributes)
      : document_(document),
        node_(node),
        attributes_(attributes),
        place_(pointerTo("nodes", node.index, "extensions", "EXT_mesh_gpu_instancing", "attributes")) {}

  std::vector<glm::dmat4> read() {
    const auto translation = attribute<3>("TRANSLATION");
    const auto rotation = attribute<4>("ROTATION");
    const auto scale = attribute<3>("SCALE");
    warnOthers();
    if (!count_) return {node_.world};
    if (*count_ == 0) document_.diagnostics.warn(place_, "has no elements; the mesh is not drawn");
    takeMemory(document_, place_, *count_ * sizeof(glm::dmat4));
    std::vector<glm::dmat4> places;
    places.reserve(*count_);
    for (size_t i = 0; i < *count_; ++i) {
      glm::dmat4 place(1.0);
      if (!translation.empty()) place = glm::translate(place, glm::dvec3(translation[i]));
      if (!rotation.empty()) place = place * glm::mat4_cast(rotationOf(rotation[i]));
      if (!scale.empty()) place = glm::scale(place, glm::dvec3(scale[i]));
      place = node_.world * place;
      if (isMultiplicable(place)) places.push_back(place);
    }
    const size_t lost = *count_ - places.size();
    const std::string reason = "the world transform of an instance is not finite, or overflows";
    if (places.empty() && lost > 0) document_.diagnostics.lose(place_, reason);
    if (lost > 0) document_.diagnostics.warn(place_, reason + "; the instance is left out", lost);
    if (const size_t count = dropRepeated(places); count > 0)
      document_.diagnostics.warn(place_, "an instance that stands exactly where another one does is left out",
                                 count);
    return places;
  }

 private:
  std::string placeOf(const std::string& name) const { return place_ + "/" + escapedForPointer(name); }

  /// Empty when it is not given.
  template <glm::length_t components>
  std::vector<glm::vec<components, float>> attribute(const char* name) {
    const tinygltf::Value& member = memberOf(attributes_, name);
    if (!member.IsNumber()) return {};
    const int accessor = member.GetNumberAsInt();
    checkType(name, components, document_.model.accessors.at(size_t(accessor)));
    const size_t count = accessorCount(document_, accessor);
    if (count_ && *count_ != count) {
      document_.diagnostics.lose(placeOf(name), "has " + std::to_string(count) + " elements where " + first_ +
                                                    " has " + std::to_string(*count_));
    }
    if (!count_) first_ = name;
    count_ = count;
    takeMemory(document_, placeOf(name), count * sizeof(glm::vec<components, float>));
    return readVectors<components>(document_, accessor, placeOf(name), Integers::Fractions);
  }

  /// Refuses types that the extension does not allow. All attributes may be floats, and rotations also
  /// signed integers.
  void checkType(const char* name, int components, const tinygltf::Accessor& accessor) const {
    const int type = accessor.componentType;
    const bool isSigned = type == TINYGLTF_COMPONENT_TYPE_BYTE || type == TINYGLTF_COMPONENT_TYPE_SHORT;
    const bool isAllowed = type == TINYGLTF_COMPONENT_TYPE_FLOAT || (components == 4 && isSigned);
    if (!isAllowed)
      document_.diagnostics.lose(placeOf(name), components == 4
                                                    ? "is neither of floats nor of signed bytes or shorts"
                                                    : "is not of floats");
  }

  glm::dquat rotationOf(const glm::vec4& r) {
    const glm::dquat rotation(double(r.w), double(r.x), double(r.y), double(r.z));
    const double length = glm::length(rotation);
    if (length != 0.0) return rotation / length;
    document_.diagnostics.warn(placeOf("ROTATION"), "a quaternion of zeros is read as no rotation");
    return {1.0, 0.0, 0.0, 0.0};
  }

  void warnOthers() {
    for (const std::string& name : attributes_.Keys()) {
      const bool isKnown = name == "TRANSLATION" || name == "ROTATION" || name == "SCALE";
      if (!isKnown && !name.starts_with('_'))
        document_.diagnostics.warn(placeOf(name), "is no attribute of instances, and ignored");
    }
  }

  Document& document_;
  const PlacedNode& node_;
  const tinygltf::Value& attributes_;
  std::string place_;
  std::optional<size_t> count_;
  std::string first_;  ///< the attribute that the count is of
};

}  // namespace

std::vector<glm::dmat4> placesOfMesh(Document& document, const PlacedNode& node) {
  const tinygltf::Node& source = document.model.nodes.at(size_t(node.index));
  const auto extension = source.extensions.find("EXT_mesh_gpu_instancing");
  if (extension == source.extensions.end()) return {node.world};
  const tinygltf::Value& attributes = memberOf(extension->second, "attributes");
  if (!attributes.IsObject()) return {node.world};
  if (source.skin >= 0) {
    document.diagnostics.warn(pointerTo("nodes", node.index, "extensions", "EXT_mesh_gpu_instancing"),
                              "is ignored: joints place the mesh");
    return {node.world};
  }
  return InstanceReader(document, node, attributes).read();
}

}  // namespace fragtrace
