// SPDX-License-Identifier: MIT
// EXT_mesh_gpu_instancing: a node shows its mesh at translation * rotation * scale, all of them attributes.
#include "gltf/instancing.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "gltf/accessor.h"
#include "gltf/value.h"

namespace fragtrace {
namespace {

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
    takeMemory(document_, place_, *count_ * sizeof(glm::dmat4));
    std::vector<glm::dmat4> places;
    places.reserve(*count_);
    for (size_t i = 0; i < *count_; ++i) {
      glm::dmat4 place(1.0);
      if (!translation.empty()) place = glm::translate(place, glm::dvec3(translation[i]));
      if (!rotation.empty()) place = place * glm::mat4_cast(rotationOf(rotation[i], i));
      if (!scale.empty()) place = glm::scale(place, glm::dvec3(scale[i]));
      places.push_back(node_.world * place);
      if (!isMultiplicable(places.back()))
        document_.diagnostics.refuse(
            place_, "the world transform of instance " + std::to_string(i) + " is not finite, or overflows");
    }
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
      document_.diagnostics.refuse(placeOf(name), "has " + std::to_string(count) + " elements where " +
                                                      first_ + " has " + std::to_string(*count_));
    }
    if (!count_) first_ = name;
    count_ = count;
    takeMemory(document_, placeOf(name), count * sizeof(glm::vec<components, float>));
    return readVectors<components>(document_, accessor, placeOf(name));
  }

  /// The table of the extension: floats, or for rotations normalized signed integers, too.
  void checkType(const char* name, int components, const tinygltf::Accessor& accessor) const {
    const int type = accessor.componentType;
    const bool isSigned = type == TINYGLTF_COMPONENT_TYPE_BYTE || type == TINYGLTF_COMPONENT_TYPE_SHORT;
    const bool isAllowed =
        type == TINYGLTF_COMPONENT_TYPE_FLOAT || (components == 4 && isSigned && accessor.normalized);
    if (!isAllowed)
      document_.diagnostics.refuse(
          placeOf(name), components == 4 ? "is neither of floats nor of normalized signed bytes or shorts"
                                         : "is not of floats");
  }

  glm::dquat rotationOf(const glm::vec4& r, size_t instance) const {
    const glm::dquat rotation(double(r.w), double(r.x), double(r.y), double(r.z));
    const double length = glm::length(rotation);
    if (!(length > 0.0) || !std::isfinite(length))
      document_.diagnostics.refuse(placeOf("ROTATION"),
                                   "element " + std::to_string(instance) + " is not a unit quaternion");
    return rotation / length;
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
