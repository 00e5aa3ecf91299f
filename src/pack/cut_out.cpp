// SPDX-License-Identifier: MIT
#include "pack/cut_out.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "shader/layout.h"

namespace fragtrace {

namespace {

constexpr int kOne = 255;  // an alpha of 1 in AlphaPyramid

/// The greatest alpha of a texel that lets all rays pass, where the factors of the material and the vertices
/// are at most `factor`; below 0: no texel does.
int mostPassing(const Material& m, float factor) {
  if (m.alphaMode == AlphaMode::Blend) return factor > 0.0f ? 0 : kOne;
  constexpr double kRounding = 1e-5;  // of the shader's products
  if (m.alphaCutoff <= 0.0f) return -1;
  const double most = double(m.alphaCutoff) * (1.0 - kRounding) * kOne;
  if (double(factor) * kOne < most) return kOne;
  return int(std::ceil(most / double(factor))) - 1;
}

/// Parts of an axis of a picture, from the first texel to the last.
struct AxisParts {
  std::array<glm::ivec2, 2> part{};
  size_t count = 0;
};

/// The texels that coordinates of an axis read, before wrapping from `low` to `high`.
AxisParts wrapped(double low, double high, int size, Wrap wrap) {
  constexpr double kFarthest = 1e15;  // from where on doubles do not tell texels apart
  const auto clamped = [&](double x) { return int(std::clamp(x, 0.0, double(size - 1))); };
  if (wrap == Wrap::ClampToEdge) return {{glm::ivec2(clamped(low), clamped(high))}, 1};
  if (high - low + 1.0 >= size || std::max(-low, high) > kFarthest) return {{glm::ivec2(0, size - 1)}, 1};
  AxisParts parts;
  const auto last = int64_t(std::floor(high / size));
  for (auto tile = int64_t(std::floor(low / size)); tile <= last && parts.count < 2; ++tile) {
    const double origin = double(tile) * size;
    glm::ivec2 part(int(std::max(low - origin, 0.0)), int(std::min(high - origin, double(size - 1))));
    if (wrap == Wrap::MirroredRepeat && tile % 2 != 0)
      part = glm::ivec2(size - 1 - part.y, size - 1 - part.x);
    parts.part[parts.count++] = part;
  }
  return parts;
}

/// The texels that an axis of a triangle reads, by the texture coordinate of its corners along it. `reach` is
/// the size of the numbers by which these are computed.
AxisParts texelsAlong(const glm::dvec3& coordinates, double reach, int size, Wrap wrap) {
  // The shader reads the texels on both sides of a point, and rounds the point.
  constexpr double kRoundings = 16.0 * 0x1p-24;
  const double margin = 1.0 + kRoundings * reach * size;
  const double low = std::min({coordinates.x, coordinates.y, coordinates.z});
  const double high = std::max({coordinates.x, coordinates.y, coordinates.z});
  return wrapped(std::floor(low * size - margin), std::floor(high * size + margin), size, wrap);
}

/// Returns true if a texel of the triangle's footprint may be above `most`.
bool exceeds(const Scene& scene, const Triangle& t, const TextureRef& ref, const AlphaPyramid& alpha,
             glm::ivec2 size, int most) {
  const std::vector<glm::vec2>& texcoords =
      ref.texcoord == 1 ? scene.vertices.texcoord1 : scene.vertices.texcoord0;
  std::array<glm::dvec3, 2> corners{};
  glm::dvec2 reach(1.0);
  for (int i = 0; i < 3 && !texcoords.empty(); ++i) {
    const glm::dvec3 place(texcoords[t.vertex[i]], 1.0);
    for (int axis = 0; axis < 2; ++axis) {
      const glm::dvec3 row(axis == 0 ? ref.transform.u : ref.transform.v);
      corners[size_t(axis)][i] = glm::dot(row, place);
      const double sum = glm::dot(glm::abs(row), glm::abs(place));
      if (!std::isfinite(sum)) return true;
      reach[axis] = std::max(reach[axis], sum);
    }
  }
  const Texture& texture = scene.textures[ref.texture];
  const AxisParts across = texelsAlong(corners[0], reach.x, size.x, texture.wrapU);
  const AxisParts down = texelsAlong(corners[1], reach.y, size.y, texture.wrapV);
  for (size_t u = 0; u < across.count; ++u) {
    for (size_t v = 0; v < down.count; ++v) {
      const glm::ivec2 low(across.part[u].x, down.part[v].x);
      const glm::ivec2 high(across.part[u].y, down.part[v].y);
      if (alpha.exceeds(low, high, most)) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<bool> cutOutTriangles(const Scene& scene, const TraitSet& traits, const TexturePacker& textures) {
  std::vector<bool> cutOut;
  const bool colored = has(traits, Trait::VertexColors) && !scene.vertices.color.empty();
  for (size_t i = 0; i < scene.triangles.size(); ++i) {
    const Triangle& t = scene.triangles[i];
    const Material& m = scene.materials[t.material];
    if (!m.testsAlpha()) continue;
    float ofVertices = colored ? 0.0f : 1.0f;
    for (int corner = 0; corner < 3 && colored; ++corner)
      ofVertices = std::max(ofVertices, scene.vertices.color[t.vertex[corner]].a);
    const int most = mostPassing(m, m.baseColorFactor.a * ofVertices);
    if (most < 0) continue;
    if (most < kOne) {
      const bool reads = readsTexture(layout::kSlotBaseColor, m, traits);
      const AlphaPyramid* alpha = reads ? textures.alphaOf(m.baseColorTexture) : nullptr;
      if (alpha == nullptr ||
          exceeds(scene, t, m.baseColorTexture, *alpha, textures.sizeOf(m.baseColorTexture), most))
        continue;
    }
    cutOut.resize(scene.triangles.size());
    cutOut[i] = true;
  }
  return cutOut;
}

}  // namespace fragtrace
