// SPDX-License-Identifier: MIT
#include <cmath>

#include "gltf/build/placed.h"

namespace fragtrace {
namespace {

/// The camera's axes without scale and shear; a node that flattens everything keeps the default view.
void orient(Camera& camera, const glm::dmat4& world) {
  const glm::dvec3 backward(world[2]);
  const glm::dvec3 upward(world[1]);
  if (glm::length(backward) > 0.0) camera.forward = -glm::normalize(backward);
  const glm::dvec3 across = upward - glm::dot(upward, camera.forward) * camera.forward;
  if (glm::length(across) > 0.0) {
    camera.up = glm::normalize(across);
  } else {
    const glm::dvec3 axis =
        std::abs(camera.forward.y) < std::abs(camera.forward.z) ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    camera.up = glm::normalize(axis - glm::dot(axis, camera.forward) * camera.forward);
  }
}

}  // namespace

std::optional<Camera> cameraAt(const Document& document, const PlacedNode& node) {
  const tinygltf::Node& source = document.model.nodes.at(size_t(node.index));
  if (source.camera < 0) return std::nullopt;
  const tinygltf::Camera& described = document.model.cameras.at(size_t(source.camera));
  const std::string place = pointerTo("cameras", source.camera);
  Camera camera;
  camera.name = !described.name.empty() ? described.name : nameOrPlace(source.name, "nodes", node.index);
  camera.position = glm::dvec3(node.world[3]);
  orient(camera, node.world);
  if (described.type == "perspective") {
    camera.fovY = described.perspective.yfov;
    camera.aspectRatio = described.perspective.aspectRatio;
    if (!(camera.fovY > 0.0 && camera.fovY < 3.141592653589793)) {
      document.diagnostics.lose(place + "/perspective/yfov", "is not between 0 and pi");
    }
    if (camera.aspectRatio < 0.0)
      document.diagnostics.lose(place + "/perspective/aspectRatio", "is negative");
    return camera;
  }
  // Negative magnifications are discouraged mirrors in the specification; only their size is taken.
  camera.type = CameraType::Orthographic;
  camera.halfHeight = std::abs(described.orthographic.ymag);
  camera.aspectRatio = std::abs(described.orthographic.xmag) / camera.halfHeight;
  if (!(camera.halfHeight > 0.0 && camera.aspectRatio > 0.0) || !std::isfinite(camera.aspectRatio)) {
    document.diagnostics.lose(place + "/orthographic", "xmag and ymag must not be 0");
  }
  return camera;
}

}  // namespace fragtrace
