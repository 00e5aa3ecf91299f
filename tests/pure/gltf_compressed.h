// SPDX-License-Identifier: MIT
// A grid, and documents in which meshoptimizer's own encoders have compressed it.
#pragma once

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "gltf_builder.h"

namespace fragtrace::gltf_test {

inline constexpr size_t kSide = 12;  // vertices along a side of the grid

/// A wavy grid of kSide x kSide vertices.
struct Grid {
  std::vector<float> positions;
  std::vector<uint32_t> indices;

  Grid() {
    for (size_t y = 0; y < kSide; ++y)
      for (size_t x = 0; x < kSide; ++x)
        positions.insert(positions.end(), {float(x), float(y), std::sin(float(x + 2 * y))});
    for (uint32_t y = 0; y + 1 < kSide; ++y) {
      for (uint32_t x = 0; x + 1 < kSide; ++x) {
        const uint32_t a = y * uint32_t(kSide) + x, b = a + uint32_t(kSide);
        indices.insert(indices.end(), {a, a + 1, b, b, a + 1, b + 1});
      }
    }
  }
  size_t vertexCount() const { return positions.size() / 3; }
};

/// World positions of all corners, sorted, so that neither the order of triangles nor where they begin
/// counts.
inline std::vector<std::array<float, 3>> cornersOf(const Scene& scene) {
  std::vector<std::array<float, 3>> corners;
  for (size_t t = 0; t < scene.triangles.size(); ++t) {
    for (int c = 0; c < 3; ++c) {
      const glm::vec3 p(worldCornerOf(scene, t, c));
      corners.push_back({p.x, p.y, p.z});
    }
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

inline Scene plainScene(const Grid& grid) {
  GltfBuilder builder;
  json& primitive = builder.addMesh({{"POSITION", builder.addAccessor<float>("VEC3", grid.positions)}});
  primitive["indices"] = builder.addAccessor<uint32_t>("SCALAR", grid.indices);
  return load(builder);
}

/// Makes a view of these compressed bytes, which decode to `count` elements; returns its index.
inline int addMeshoptView(GltfBuilder& builder, const std::vector<unsigned char>& bytes, size_t count,
                          size_t stride, const std::string& mode, const std::string& filter = "NONE") {
  const int view = builder.addView(bytes);
  json& described = builder.root["bufferViews"][size_t(view)];
  const size_t offset = described["byteOffset"];
  described = {{"buffer", 1},
               {"byteLength", count * stride},
               {"extensions",
                {{"EXT_meshopt_compression",
                  {{"buffer", 0},
                   {"byteOffset", offset},
                   {"byteLength", bytes.size()},
                   {"byteStride", stride},
                   {"count", count},
                   {"mode", mode},
                   {"filter", filter}}}}}};
  return view;
}

inline int addAccessor(GltfBuilder& builder, int view, size_t count, int componentType,
                       const std::string& type) {
  builder.root["accessors"].push_back(
      {{"bufferView", view}, {"componentType", componentType}, {"count", count}, {"type", type}});
  return int(builder.root["accessors"].size()) - 1;
}

inline std::vector<unsigned char> encodedVertices(const void* data, size_t count, size_t stride) {
  std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(count, stride));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), data, count, stride));
  return bytes;
}

/// The grid with compressed positions and indices, mode TRIANGLES or INDICES.
inline GltfBuilder meshoptGrid(const Grid& grid, const std::string& mode = "TRIANGLES") {
  GltfBuilder builder;
  builder.root["extensionsUsed"] = builder.root["extensionsRequired"] = {"EXT_meshopt_compression"};
  const size_t count = grid.indices.size();
  std::vector<unsigned char> bytes(mode == "TRIANGLES"
                                       ? meshopt_encodeIndexBufferBound(count, grid.vertexCount())
                                       : meshopt_encodeIndexSequenceBound(count, grid.vertexCount()));
  bytes.resize(mode == "TRIANGLES"
                   ? meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), grid.indices.data(), count)
                   : meshopt_encodeIndexSequence(bytes.data(), bytes.size(), grid.indices.data(), count));
  const int vertices = addMeshoptView(builder, encodedVertices(grid.positions.data(), grid.vertexCount(), 12),
                                      grid.vertexCount(), 12, "ATTRIBUTES");
  const int indices = addMeshoptView(builder, bytes, count, 4, mode);
  json& primitive =
      builder.addMesh({{"POSITION", addAccessor(builder, vertices, grid.vertexCount(), 5126, "VEC3")}});
  primitive["indices"] = addAccessor(builder, indices, count, 5125, "SCALAR");
  builder.embedBuffer();
  builder.root["buffers"].push_back(
      {{"byteLength", 100'000}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
  return builder;
}

inline json& meshoptOf(GltfBuilder& builder, size_t view) {
  return builder.root["bufferViews"][view]["extensions"]["EXT_meshopt_compression"];
}

}  // namespace fragtrace::gltf_test
