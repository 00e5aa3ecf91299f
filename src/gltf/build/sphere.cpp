// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "gltf/build/placed.h"
#include "gltf/read/value.h"

namespace fragtrace {
namespace {

/// Columns may be this far from perpendicular and from the same length: TRS in single precision stays well
/// below.
constexpr double kUniformScaleTolerance = 1e-4;

bool isUniform(const glm::dmat3& axes, double scale) {
  for (int c = 0; c < 3; ++c) {
    if (std::abs(glm::length(axes[c]) - scale) > kUniformScaleTolerance * scale) return false;
    if (std::abs(glm::dot(axes[c], axes[(c + 1) % 3])) > kUniformScaleTolerance * scale * scale) return false;
  }
  return true;
}

}  // namespace

std::optional<PlacedSphere> sphereAt(Document& document, const PlacedNode& node) {
  const tinygltf::Node& source = document.model.nodes.at(size_t(node.index));
  const auto extension = document.model.extensions.find("KHR_implicit_shapes");
  const tinygltf::Value& chosen = memberOf(source.extras, "shape");
  if (extension == document.model.extensions.end() || !chosen.IsInt()) return std::nullopt;

  const std::string place = pointerTo("nodes", node.index);
  const tinygltf::Value& shapes = memberOf(extension->second, "shapes");
  const int index = chosen.GetNumberAsInt();
  if (index < 0 || size_t(index) >= shapes.ArrayLen()) {
    document.diagnostics.refuse(place + "/extras/shape", "index " + std::to_string(index) + " is past the " +
                                                             std::to_string(shapes.ArrayLen()) + " shapes");
  }
  document.diagnostics.need(pointerTo("extensions", "KHR_implicit_shapes", "shapes", index));
  const tinygltf::Value& shape = shapes.Get(index);
  const std::string& type = memberOf(shape, "type").Get<std::string>();
  if (type != "sphere") {
    document.diagnostics.warn(place + "/extras/shape", "a shape of type " + inQuotes(type) + " is left out");
    return std::nullopt;
  }

  PlacedSphere sphere;
  sphere.node = nameOrPlace(source.name, "nodes", node.index);
  sphere.nodeIndex = uint32_t(node.index);
  const size_t materialCount = document.model.materials.size();
  const tinygltf::Value& material = memberOf(source.extras, "material");
  if (material.IsInt() &&
      (material.GetNumberAsInt() < 0 || size_t(material.GetNumberAsInt()) >= materialCount)) {
    document.diagnostics.refuse(place + "/extras/material",
                                "index " + std::to_string(material.GetNumberAsInt()) + " is past the " +
                                    std::to_string(materialCount) + " materials");
  }
  sphere.material = uint32_t(material.IsInt() ? size_t(material.GetNumberAsInt()) : materialCount);

  glm::dmat3 axes(node.world);
  const double scale = glm::length(axes[0]);
  if (!isUniform(axes, scale)) document.diagnostics.lose(place, "scales a sphere unevenly");
  const double radius = numberOf(memberOf(shape, "sphere"), "radius", 0.5);  // the extension's default
  sphere.radius = radius * scale;
  if (!(sphere.radius >= kSmallest)) document.diagnostics.lose(place, "its sphere has no radius above 0");
  sphere.center = glm::dvec3(node.world[3]);
  if (!(glm::length(sphere.center) + sphere.radius <= kFarthest))
    document.diagnostics.lose(place, "its sphere reaches farther than 1e30 m from the origin");
  if (glm::determinant(axes) < 0.0) {
    document.diagnostics.warn(place, "a mirrored sphere shows its textures unmirrored");
    axes = -axes;
  }
  sphere.rotation = glm::normalize(glm::quat_cast(axes * (1.0 / scale)));
  return sphere;
}

}  // namespace fragtrace
