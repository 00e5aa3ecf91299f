// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "gltf/read/document.h"

namespace fragtrace {

// The types of an accessor's components, by glTF's numbers (those of OpenGL).

inline constexpr unsigned kUnsignedInt = 5125;

inline bool isComponentType(unsigned type) { return type >= 5120 && type <= 5126 && type != 5124; }

/// Bytes; 4 of a type that is none.
inline uint64_t componentSize(unsigned type) { return type < 5120 || type > 5123 ? 4 : type < 5122 ? 1 : 2; }

// Decodes accessors: strided, normalised, sparse, or without any buffer view, and never past the end.

/// The meaning of integers that are not normalized.
enum class Integers {
  Numbers,   ///< themselves, as KHR_mesh_quantization allows
  Whole,     ///< themselves, as is meant
  Fractions  ///< 0..1 or -1..1: `normalized` was left out, with a warning
};

/// Number of elements of an accessor, which lie in memory. Throws a Loss if they do not.
size_t accessorCount(const Document& document, int accessor);

/// Reads all elements as floats, with integers scaled if normalised. `components` is the number that each
/// element must have. `place` is where the accessor is used, for messages. This and all below throw a Loss if
/// type, component type or byte range are wrong.
template <glm::length_t components>
std::vector<glm::vec<components, float>> readVectors(Document& document, int accessor,
                                                     const std::string& place,
                                                     Integers integers = Integers::Numbers);

/// Vertex colours of three or four components; alpha is 1 where there is none.
std::vector<glm::vec4> readColors(Document& document, int accessor, const std::string& place);

/// Unsigned indices of any of the three types, below vertexCount.
std::vector<uint32_t> readIndices(const Document& document, int accessor, size_t vertexCount,
                                  const std::string& place);

/// Joints of four vertex influences (JOINTS_n): unsigned bytes or shorts.
std::vector<glm::uvec4> readJoints(const Document& document, int accessor, const std::string& place);

/// Matrices of type MAT4 and floats, which are finite.
std::vector<glm::dmat4> readMatrices(Document& document, int accessor, const std::string& place);

/// Reads all components of all elements one after the other, of any type with `components` of them.
std::vector<float> readComponents(Document& document, int accessor, int components, const std::string& place,
                                  Integers integers = Integers::Numbers);

}  // namespace fragtrace
