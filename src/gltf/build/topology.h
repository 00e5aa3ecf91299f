// SPDX-License-Identifier: MIT
// Lists, strips, fans and loops of triangles, lines and points, all made into lists.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

namespace fragtrace {

enum class Topology { List, Strip, Fan };

/// The topology of a glTF primitive mode that has triangles.
std::optional<Topology> topologyOf(int mode);

/// Pairs of line ends, or each point twice, of the other modes; what is left over of a list, or too short for
/// a line, is dropped.
std::vector<glm::uvec2> strokesOf(int mode, std::span<const uint32_t> indices);

/// Triangles in the order and with the winding that the specification gives them; what is left over of a
/// list, or too short for a triangle, is dropped.
std::vector<glm::uvec3> trianglesOf(Topology topology, std::span<const uint32_t> indices);

}  // namespace fragtrace
