// SPDX-License-Identifier: MIT
// Decodes accessors: strided, normalised, sparse, or without any buffer view, and never past the end.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "gltf/read/document.h"

namespace fragtrace {

/// Refuses every accessor, used or not, that reaches out of its buffer view, and every sparse index past its
/// elements. Accessors whose buffer an extension would bring are left out.
void checkAccessors(const Document& document);

/// Number of elements of an accessor.
size_t accessorCount(const Document& document, int accessor);

/// Reads all elements as floats, with integers scaled if normalised. `components` is the number that each
/// element must have. `place` is where the accessor is used, for messages. Throws InputError if type,
/// component type or byte range are wrong.
template <glm::length_t components>
std::vector<glm::vec<components, float>> readVectors(const Document& document, int accessor,
                                                     const std::string& place);

/// Vertex colours of three or four components; alpha is 1 where there is none.
std::vector<glm::vec4> readColors(const Document& document, int accessor, const std::string& place);

/// Unsigned indices of any of the three types. Throws InputError when one is not below vertexCount.
std::vector<uint32_t> readIndices(const Document& document, int accessor, size_t vertexCount,
                                  const std::string& place);

/// Joints of four vertex influences (JOINTS_n): unsigned bytes or shorts.
std::vector<glm::uvec4> readJoints(const Document& document, int accessor, const std::string& place);

/// Matrices of type MAT4 and floats, which are finite.
std::vector<glm::dmat4> readMatrices(const Document& document, int accessor, const std::string& place);

/// Reads all components of all elements one after the other, of any type with `components` of them: floats,
/// or normalised integers, or any integers if `wholeNumbers` are asked for.
std::vector<float> readComponents(const Document& document, int accessor, int components,
                                  const std::string& place, bool wholeNumbers = false);

}  // namespace fragtrace
