// SPDX-License-Identifier: MIT
#include "pack/pack_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/errors.h"
#include "base/words.h"
#include "scene/coincidence.h"
#include "scene/hit_error.h"
#include "scene/motion/moving_scene.h"
#include "shader/layout.h"

namespace fragtrace {

namespace {

constexpr double kMostCells = 255.0;
constexpr int kLeastExponent = -100;  // of a cell: times the inverse of any direction it is a normal float

/// A child's box along an axis.
struct Span {
  double low = 0.0;
  double high = 0.0;
  bool isFlat = false;  ///< holds only points of this very coordinate
};

/// The boxes of a node's children along an axis.
using Spans = std::span<const Span>;

double lowOf(Spans spans) {
  double low = spans[0].low;
  for (const Span& span : spans) low = std::min(low, span.low);
  return low;
}

double highOf(Spans spans) {
  double high = spans[0].high;
  for (const Span& span : spans) high = std::max(high, span.high);
  return high;
}

float floatBelow(double x) {
  const auto f = float(x);
  return double(f) > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

/// The origin of the node's grid. Its lines are multiples of the cell, so that sides at round coordinates are
/// not moved. Where a flat box is the lowest, the origin is its coordinate: rays which leave a floor do not
/// begin in its boxes.
float originOf(Spans spans, double low, double cell) {
  const auto isFlatThere = [&](const Span& span) { return span.isFlat && span.low == low; };
  return floatBelow(std::ranges::any_of(spans, isFlatThere) ? low : std::floor(low / cell) * cell);
}

double highCell(double high, float origin, double cell) { return std::ceil((high - double(origin)) / cell); }

/// The least power of two that is large enough for a cell.
int exponentFor(Spans spans) {
  const double low = lowOf(spans);
  const double high = highOf(spans);
  int exponent = kLeastExponent;
  if (high > low) exponent = std::max(exponent, std::ilogb((high - low) / kMostCells));
  const auto fits = [&](double cell) {
    return highCell(high, originOf(spans, low, cell), cell) <= kMostCells;
  };
  while (!fits(std::ldexp(1.0, exponent))) ++exponent;
  return exponent;
}

/// What moves is padded by what rounding moves a point on its way (onItsWay of shaders/tree.glsl).
void pad(Span& from, Span& to) {
  if (from.isFlat && to.isFlat && from.low == to.low) return;
  constexpr double kOnItsWay = 4.0 * 0x1p-24;
  const auto roundingOf = [](double a, double b) {
    return kOnItsWay * (std::max(std::abs(a), std::abs(b)) + std::abs(b - a));
  };
  const double rounding = std::max(roundingOf(from.low, to.low), roundingOf(from.high, to.high));
  for (Span* span : {&from, &to}) *span = {span->low - rounding, span->high + rounding, false};
}

/// A node's children by axis, at the beginning of its segment and at its end; without motion these are the
/// same.
struct NodeSpans {
  std::array<std::array<std::array<Span, WideNode::kMost>, 3>, 2> span{};
  size_t count = 0;
  uint32_t there = 0;  ///< a bit for each child that holds something; others have the box of one that does

  Spans along(size_t end, size_t axis) const { return Spans(span[end][axis]).first(count); }
};

NodeSpans spansOf(const Bvh& bvh, const WideNode& node, bool moving) {
  NodeSpans spans;
  spans.count = node.count;
  uint32_t first = 0;
  while (first < node.count && boxAt(bvh, node.place[first]).empty()) ++first;
  if (first == node.count) return spans;
  for (uint32_t i = 0; i < node.count; ++i) {
    const bool isThere = !boxAt(bvh, node.place[i]).empty();
    if (isThere) spans.there |= layout::kFirstChild << i;
    const uint32_t place = node.place[isThere ? i : first];
    const Bounds& begins = boxAt(bvh, place);
    const Bounds& ends = bvh.endBounds.empty() ? begins : bvh.endBounds[place / 2][place % 2];
    const auto spanOf = [](const Bounds& box, int axis) {
      return Span{box.minimum[axis], box.maximum[axis], box.minimum[axis] == box.maximum[axis]};
    };
    for (int axis = 0; axis < 3; ++axis) {
      Span& from = spans.span[0][size_t(axis)][i] = spanOf(begins, axis);
      Span& to = spans.span[1][size_t(axis)][i] = spanOf(ends, axis);
      if (moving) pad(from, to);
    }
  }
  return spans;
}

uint32_t bitsOf(uint32_t first, uint32_t end) { return ((1u << end) - (1u << first)) * layout::kFirstChild; }

/// The groups of a node's inner children and of its leaves (layout.glsl).
std::array<uint32_t, 2> groupsOf(const Bvh& bvh, const WideNode& node, uint32_t firstInstance) {
  uint32_t leaf = 0;
  if (node.count > node.innerCount) {
    const uint32_t child = childAt(bvh, node.place[node.innerCount]);
    leaf = child & ~(kBvhLeafBit | kBvhInstanceBit);
    if ((child & kBvhInstanceBit) != 0) leaf += firstInstance + uint32_t(layout::kInstanceLeaf);
  }
  return {bitsOf(0, node.innerCount) | (node.innerCount > 0 ? node.firstInner : 0u),
          bitsOf(node.innerCount, node.count) | ((leaf - node.innerCount) & layout::kBaseMask)};
}

/// Appends the low and the high sides of boxes along an axis.
void appendSides(Words& words, Spans spans, float origin, double cell) {
  uint32_t lows = 0;
  uint32_t highs = 0;
  for (size_t i = 0; i < spans.size(); ++i) {
    lows |= uint32_t(std::floor((spans[i].low - double(origin)) / cell)) << 8 * i;
    highs |= uint32_t(highCell(spans[i].high, origin, cell)) << 8 * i;
  }
  words.push_back(lows);
  words.push_back(highs);
}

void appendNode(const Bvh& bvh, const WideNode& node, uint32_t firstInstance, bool moving, Words& words) {
  const NodeSpans spans = spansOf(bvh, node, moving);
  std::array<double, 3> cells{};
  uint32_t exponents = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    int exponent = exponentFor(spans.along(0, axis));
    if (moving) exponent = std::max(exponent, exponentFor(spans.along(1, axis)));
    cells[axis] = std::ldexp(1.0, exponent);
    exponents |= uint32_t(exponent + 127) << 8 * axis;
  }
  for (size_t end = 0; end < (moving ? 2u : 1u); ++end) {
    std::array<float, 3> origin{};
    for (size_t axis = 0; axis < 3; ++axis) {
      const Spans along = spans.along(end, axis);
      origin[axis] = originOf(along, lowOf(along), cells[axis]);
      words.push_back(floatWord(origin[axis]));
    }
    words.push_back(exponents);
    for (size_t axis = 0; axis < 3; ++axis)
      appendSides(words, spans.along(end, axis), origin[axis], cells[axis]);
    for (const uint32_t group : groupsOf(bvh, node, firstInstance))
      words.push_back(group & (spans.there | layout::kBaseMask));
  }
}

/// Returns true unless all light ends at the material (letsPass, lightThrough, clearThrough of the shaders).
bool mayPass(const Material& m) { return m.testsAlpha() || m.transmissive(); }

uint32_t primitiveFlags(const Material& m) {
  uint32_t flags = 0;
  if (m.culled()) flags |= layout::kPrimitiveCull;
  if (m.emissive()) flags |= layout::kPrimitiveEmits;
  if (mayPass(m)) flags |= layout::kPrimitivePasses;
  return flags;
}

struct LeafSide {
  std::array<glm::vec3, 3> points{};
  uint32_t word = layout::kPrimitiveNone;
};

/// ends: where its segment ends.
LeafSide leafSide(const Scene& scene, uint32_t primitive, bool ends = false) {
  LeafSide side;
  if (primitive == kMissIndex) return side;
  const uint32_t triangles = uint32_t(scene.triangles.size());
  if (primitive < triangles) {
    const Triangle& t = scene.triangles[primitive];
    side.points = cornersOf(scene, ends ? atEnd(scene, t) : t);
    side.word = t.reach | primitiveFlags(scene.materials[t.material]);
    if (isSliver(cornersOf(scene, t)) || isSliver(cornersOf(scene, atEnd(scene, t))))
      side.word |= layout::kPrimitiveSliver;
  } else {
    const uint32_t sphere = primitive - triangles;
    const Sphere& s = ends ? atEnd(scene, sphere) : scene.spheres[sphere];
    side.points = {s.center, glm::vec3(s.radius), glm::vec3(0.0f)};
    side.word = primitiveFlags(scene.materials[s.material]) | layout::kPrimitiveSphere;
  }
  return side;
}

void appendLeaf(Words& words, const LeafSide& a, const LeafSide& b) {
  for (int point = 0; point < 3; ++point) {
    for (int axis = 0; axis < 3; ++axis) {
      words.push_back(floatWord(a.points[point][axis]));
      words.push_back(floatWord(b.points[point][axis]));
    }
  }
  words.push_back(a.word);
  words.push_back(b.word);
}

}  // namespace

glm::vec3 sceneExtent(const Bounds& bounds) {
  if (bounds.empty()) return glm::vec3(1.0f);
  const glm::dvec3 sides = (glm::dvec3(bounds.maximum) - glm::dvec3(bounds.minimum)) / 65531.0;
  const double widest = std::max({sides.x, sides.y, sides.z});
  glm::vec3 extent;
  for (int axis = 0; axis < 3; ++axis) {
    const auto side = float(std::max({sides[axis], 0.125 * widest, 1e-30}));
    extent[axis] = 65536.0f * std::nextafter(side, std::numeric_limits<float>::infinity());
  }
  return extent;
}

float treeRounding(const glm::vec3& extent) { return 0x1p-14f * std::max({extent.x, extent.y, extent.z}); }

void checkIndices(const char* what, size_t count) {
  if (count > size_t(layout::kInstanceLeaf))
    throw InputError("the tree of the scene has " + std::to_string(count) + " " + what + ", at most " +
                     std::to_string(layout::kInstanceLeaf) + " can be drawn");
}

Words packNodes(const Bvh& bvh, bool moving) {
  const uint32_t firstInstance = firstInstanceBlock(bvh);
  checkIndices("nodes", bvh.wide.size());
  checkIndices("leaves", bvh.leaves.size());
  Words words;
  words.reserve(bvh.wide.size() * layout::kNodeRows * (moving ? 8u : 4u));
  for (const WideNode& node : bvh.wide) appendNode(bvh, node, firstInstance, moving, words);
  return words;
}

Words packLeaves(const Scene& scene, const Bvh& bvh, bool moving) {
  Words words;
  const size_t padded =
      (bvh.leaves.size() + layout::kLeafBlock - 1) / layout::kLeafBlock * layout::kLeafBlock;
  words.reserve(padded * layout::kLeafRows * (moving ? 8u : 4u));
  for (const BvhLeaf& leaf : bvh.leaves) {
    const auto [a, b] = leaf.primitive;
    appendLeaf(words, leafSide(scene, a), leafSide(scene, b));
    if (moving) appendLeaf(words, leafSide(scene, a, true), leafSide(scene, b, true));
  }
  for (size_t i = bvh.leaves.size(); i < padded; ++i) {
    appendLeaf(words, {}, {});
    if (moving) appendLeaf(words, {}, {});
  }
  return words;
}

glm::ivec4 segmentsOf(const Scene& scene, const Bvh& bvh) {
  const uint32_t segments = std::max(1u, scene.motion.segments);
  return {segments, bvh.wide.size() / segments, bvh.leaves.size() / segments, scene.motion.vertices};
}

std::vector<uint32_t> leafSlots(const Scene& scene, const Bvh& bvh) {
  std::vector<uint32_t> slots(scene.triangles.size(), kMissIndex);
  for (uint32_t leaf = 0; leaf < bvh.leaves.size(); ++leaf) {
    for (uint32_t side = 0; side < 2; ++side) {
      const uint32_t primitive = bvh.leaves[leaf].primitive[side];
      if (primitive < slots.size()) slots[primitive] = leaf * 2 + side;
    }
  }
  return slots;
}

Bvh listLeaves(const Scene& scene) {
  Bvh bvh;
  const uint32_t count = uint32_t(scene.triangles.size() + scene.spheres.size());
  for (uint32_t i = 0; i < count; i += 2) bvh.leaves.push_back({{i, i + 1 < count ? i + 1 : kMissIndex}});
  for (const Bounds& box : primitiveBounds(scene)) bvh.bounds.include(box);
  return bvh;
}

namespace {

/// The upper bits of a positive float that is at least this error.
uint32_t errorBits(double error) {
  constexpr uint32_t kDropped = (1u << layout::kFloatErrorShift) - 1u;
  const uint32_t up = floatWord(std::nextafter(float(error), std::numeric_limits<float>::infinity()));
  return (up + kDropped) >> layout::kFloatErrorShift << layout::kFaceErrorShift;
}

void appendTriangle(Words& words, const Scene& scene, const Triangle& t) {
  const auto [v0, v1, v2] = cornersOf(scene, t);
  const glm::vec4 plane = planeOf(v0, v1, v2);
  const uint32_t flat = t.flat ? layout::kFaceFlat : 0u;
  const double error =
      std::max(hitPointError({v0, v1, v2}), hitPointError(cornersOf(scene, atEnd(scene, t))));
  const uint32_t word = t.material | flat | errorBits(error);
  words.insert(words.end(), {floatWord(plane.x), floatWord(plane.y), floatWord(plane.z), word,
                             floatWord(plane.w), t.vertex.x, t.vertex.y, t.vertex.z});
}

void appendSphere(Words& words, const Scene& scene, uint32_t sphere) {
  const Sphere& s = scene.spheres[sphere];
  const Sphere& end = atEnd(scene, sphere);
  // q and -q are the same rotation; the shader derives w >= 0 from the rest.
  const glm::quat q = s.rotation.w < 0.0f ? -s.rotation : s.rotation;
  const glm::vec3 reach =
      glm::max(glm::abs(s.center) + glm::vec3(s.radius), glm::abs(end.center) + glm::vec3(end.radius));
  const uint32_t word = s.material | layout::kFaceSphere | errorBits(hitPointError({reach, reach, reach}));
  words.insert(words.end(), {floatWord(q.x), floatWord(q.y), floatWord(q.z), word});
  appendRow(words, s.center, s.radius);
}

void appendInset(Words& words, const Scene& scene, uint32_t primitive) {
  if (primitive >= scene.triangles.size()) {  // a sphere, or nothing
    words.insert(words.end(), 4, 0u);
    return;
  }
  const glm::uvec3& v = scene.triangles[primitive].vertex;
  const std::vector<glm::vec3>& p = scene.vertices.position;
  const glm::dvec3 middle = (glm::dvec3(p[v.x]) + glm::dvec3(p[v.y]) + glm::dvec3(p[v.z])) / 3.0;
  appendRow(words, glm::vec3(middle), 0.0f);
  words.back() = scene.insets.empty() ? 0u : scene.insets[primitive];
}

/// Triangles of a shared mesh have the number 0: their instances have numbers.
uint32_t objectNumberOf(const Scene& scene, uint32_t primitive) {
  if (primitive == kMissIndex) return 0;
  if (primitive >= scene.triangles.size())
    return scene.spheres[primitive - scene.triangles.size()].nodeIndex + 1;
  if (primitive >= flatTriangleCount(scene)) return 0;
  const auto after = std::ranges::upper_bound(scene.origins, primitive, {}, &PrimitiveOrigin::firstTriangle);
  return std::prev(after)->nodeIndex + 1;
}

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

glm::vec4 planeOf(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
  const glm::dvec3 cross = glm::cross(glm::dvec3(v1) - glm::dvec3(v0), glm::dvec3(v2) - glm::dvec3(v0));
  const double length = glm::length(cross);
  if (length <= 0.0) return glm::vec4(0.0f);
  const glm::vec3 normal(cross / length);
  const glm::dvec3 middle = (glm::dvec3(v0) + glm::dvec3(v1) + glm::dvec3(v2)) / 3.0;
  return {normal, float(glm::dot(glm::dvec3(normal), middle))};
}

Words packFaces(const Scene& scene, const Bvh& bvh, bool creases) {
  if (scene.materials.size() > layout::kFaceMaterialMask)
    throw InputError("the scene has " + std::to_string(scene.materials.size()) + " materials, at most " +
                     std::to_string(layout::kFaceMaterialMask) + " can be drawn");
  Words words;
  const size_t slots = bvh.leaves.size() * 2;
  words.reserve(slots * (layout::kFaceRows + (creases ? 1u : 0u)) * 4);
  for (const BvhLeaf& leaf : bvh.leaves) {
    for (const uint32_t primitive : leaf.primitive) {
      if (primitive == kMissIndex) {
        words.insert(words.end(), layout::kFaceRows * 4, 0u);
      } else if (primitive < scene.triangles.size()) {
        appendTriangle(words, scene, scene.triangles[primitive]);
      } else {
        appendSphere(words, scene, primitive - uint32_t(scene.triangles.size()));
      }
    }
  }
  for (size_t slot = 0; creases && slot < slots; ++slot)
    appendInset(words, scene, bvh.leaves[slot / 2].primitive[slot % 2]);
  return words;
}

void appendObjectNumbers(const Scene& scene, const Bvh& bvh, Words& words) {
  for (const BvhLeaf& leaf : bvh.leaves) {
    for (const uint32_t primitive : leaf.primitive) words.push_back(objectNumberOf(scene, primitive));
  }
  if (!scene.instances.empty()) words.resize(words.size() + firstInstanceBlock(bvh));
  for (const Instance& instance : scene.instances) words.push_back(instance.nodeIndex + 1);
  words.resize((words.size() + 3) / 4 * 4);
}

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
