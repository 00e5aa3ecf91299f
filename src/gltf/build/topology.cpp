// SPDX-License-Identifier: MIT
#include "gltf/build/topology.h"

#include <tiny_gltf.h>

namespace fragtrace {

std::optional<Topology> topologyOf(int mode) {
  switch (mode) {
    case TINYGLTF_MODE_TRIANGLES:
      return Topology::List;
    case TINYGLTF_MODE_TRIANGLE_STRIP:
      return Topology::Strip;
    case TINYGLTF_MODE_TRIANGLE_FAN:
      return Topology::Fan;
    default:
      return std::nullopt;
  }
}

std::vector<glm::uvec2> strokesOf(int mode, std::span<const uint32_t> indices) {
  std::vector<glm::uvec2> strokes;
  if (mode == TINYGLTF_MODE_POINTS) {
    for (const uint32_t index : indices) strokes.emplace_back(index, index);
    return strokes;
  }
  const size_t step = mode == TINYGLTF_MODE_LINE ? 2 : 1;
  for (size_t i = 0; i + 1 < indices.size(); i += step) strokes.emplace_back(indices[i], indices[i + 1]);
  if (mode == TINYGLTF_MODE_LINE_LOOP && indices.size() > 2) strokes.emplace_back(indices.back(), indices[0]);
  return strokes;
}

std::vector<glm::uvec3> trianglesOf(Topology topology, std::span<const uint32_t> indices) {
  std::vector<glm::uvec3> triangles;
  if (indices.size() < 3) return triangles;
  const size_t count = topology == Topology::List ? indices.size() / 3 : indices.size() - 2;
  triangles.reserve(count);
  // glTF 2.0, section 3.7.2.1.
  for (size_t i = 0; i < count; ++i) {
    switch (topology) {
      case Topology::List:
        triangles.emplace_back(indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]);
        break;
      case Topology::Strip:
        triangles.emplace_back(indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]);
        break;
      case Topology::Fan:
        triangles.emplace_back(indices[i + 1], indices[i + 2], indices[0]);
        break;
    }
  }
  return triangles;
}

}  // namespace fragtrace
