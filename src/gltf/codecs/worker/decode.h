// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace fragtrace {

// The worker's module for compressed geometry. Its input is a request and the encoded bytes, its output the
// decoded bytes.

enum class Codec : uint32_t {
  MeshoptVertices,   ///< EXT_ and KHR_meshopt_compression, mode ATTRIBUTES
  MeshoptTriangles,  ///< TRIANGLES
  MeshoptIndices,    ///< INDICES
  Draco,             ///< KHR_draco_mesh_compression
  DracoCounts        ///< the counts of its stream
};
enum class MeshoptFilter : uint32_t { None, Octahedral, Quaternion, Exponential, Color };

/// An attribute of a Draco mesh, and the type in which its values are wanted.
struct CodecAttribute {
  uint32_t id = 0;  ///< the attribute's id in the Draco stream
  uint32_t componentType = 0;
  uint32_t components = 0;
};
inline constexpr size_t kMostCodecAttributes = 32;

/// The output of DracoCounts.
struct StreamCounts {
  uint64_t vertices = 0;
  uint64_t indices = 0;
};

/// Draco's output: indices of 32 bits, three per triangle, then one attribute after the other, each from the
/// next multiple of four bytes on.
struct CodecRequest {
  Codec codec = Codec::Draco;
  MeshoptFilter filter = MeshoptFilter::None;
  uint64_t outputBytes = 0;
  uint64_t count = 0;       ///< elements, or vertices
  uint64_t stride = 0;      ///< bytes of an element (meshopt)
  uint64_t indexCount = 0;  ///< Draco
  uint32_t attributeCount = 0;
  std::array<CodecAttribute, kMostCodecAttributes> attributes{};
};

}  // namespace fragtrace
