// SPDX-License-Identifier: MIT
#include "pack/pack_lights.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <glm/gtc/constants.hpp>
#include <glm/gtx/component_wise.hpp>

#include "base/vectors.h"
#include "pack/pack_environment.h"
#include "scene/motion/moving_scene.h"
#include "shader/layout.h"

namespace fragtrace {

namespace {

/// Bounds are wider by this, because the shader computes in single precision.
constexpr double kMargin = 2e-3;
constexpr int kBuckets = 12;
constexpr int kDeepest = 40;  ///< deeper nodes are split by count

/// The cost of the lights below one node: their intensity, times a measure of their directions, times the
/// area of their box (Conty Estevez and Kulla 2018, equation 1; pbrt 12.6.3). The box of lights in a line has
/// no area, so its diagonal counts a little.
double costOf(const LightBounds& b) {
  const double spread = b.spread;
  const double wide = std::min(spread + b.falloff, glm::pi<double>());
  const double directions = 2.0 * glm::pi<double>() * (1.0 - std::cos(spread)) +
                            glm::pi<double>() / 2.0 *
                                (2.0 * wide * std::sin(spread) - std::cos(spread - 2.0 * wide) -
                                 2.0 * spread * std::sin(spread) + std::cos(spread));
  const glm::dvec3 d = b.high - b.low;
  return b.intensity * directions * (2.0 * (d.x * d.y + d.y * d.z + d.z * d.x) + 0.01 * glm::dot(d, d));
}

/// Sorts lights whose middles lie between two places into buckets along an axis.
struct Buckets {
  glm::dvec3 low{INFINITY};
  glm::dvec3 high{-INFINITY};

  int of(const glm::dvec3& middle, int axis) const {
    return std::min(kBuckets - 1, int(kBuckets * (middle[axis] - low[axis]) / (high[axis] - low[axis])));
  }
};

void include(std::optional<LightBounds>& all, const std::optional<LightBounds>& more) {
  if (more) all = all ? unite(*all, *more) : *more;
}

struct Border {
  double cost = INFINITY;
  int axis = -1;
  int bucket = 0;  ///< the first beyond it
};

/// The cheapest border between these buckets; boxes that are split along a short side cost more.
Border cheapestOf(const std::array<std::optional<LightBounds>, kBuckets>& buckets, int axis, double price) {
  std::array<double, kBuckets> below{};
  std::optional<LightBounds> part;
  for (size_t b = 0; b + 1 < kBuckets; ++b) {
    include(part, buckets[b]);
    below[b + 1] = part ? costOf(*part) : INFINITY;
  }
  Border best;
  part.reset();
  for (size_t b = kBuckets - 1; b > 0; --b) {
    include(part, buckets[b]);
    const double cost = part ? price * (below[b] + costOf(*part)) : INFINITY;
    if (cost < best.cost) best = {cost, axis, int(b)};
  }
  return best;
}

/// Three 10-bit numbers.
uint32_t axisWord(const glm::dvec3& axis) {
  const auto word = [](double x) { return uint32_t(std::lround(511.0 * (x + 1.0))); };
  return word(axis.x) | word(axis.y) << 10u | word(axis.z) << 20u;
}

struct Builder {
  std::span<const LightBounds> lights;
  std::vector<uint32_t> order;
  std::vector<LightNode> nodes;

  glm::dvec3 middle(uint32_t light) const { return 0.5 * (lights[light].low + lights[light].high); }
  Border cheapest(uint32_t first, uint32_t end, const Buckets& buckets) const;
  uint32_t split(uint32_t first, uint32_t end, int depth);
  void build(uint32_t node, uint32_t first, uint32_t end, int depth);
};

Border Builder::cheapest(uint32_t first, uint32_t end, const Buckets& buckets) const {
  const glm::dvec3 size = buckets.high - buckets.low;
  Border best;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(size[axis] > 0.0)) continue;
    std::array<std::optional<LightBounds>, kBuckets> parts;
    for (uint32_t i = first; i < end; ++i)
      include(parts[size_t(buckets.of(middle(order[i]), axis))], lights[order[i]]);
    const Border border = cheapestOf(parts, axis, glm::compMax(size) / size[axis]);
    if (border.cost < best.cost) best = border;
  }
  return best;
}

/// Divides lights into two parts, and returns where the second one begins.
uint32_t Builder::split(uint32_t first, uint32_t end, int depth) {
  const auto begin = order.begin() + first;
  const auto last = order.begin() + end;
  const auto partBy = [&](const auto& isFirst) {
    return uint32_t(std::stable_partition(begin, last, isFirst) - order.begin());
  };
  // Lights that shine everywhere stay apart from the others.
  const uint32_t near = partBy([&](uint32_t light) { return !lights[light].everywhere; });
  if (near != first && near != end) return near;
  const uint32_t half = first + (end - first) / 2;
  if (near == first || end - first == 2 || depth >= kDeepest) return half;
  Buckets buckets;
  for (uint32_t i = first; i < end; ++i) {
    buckets.low = glm::min(buckets.low, middle(order[i]));
    buckets.high = glm::max(buckets.high, middle(order[i]));
  }
  const Border border = cheapest(first, end, buckets);
  if (border.axis < 0) return half;
  return partBy([&](uint32_t light) { return buckets.of(middle(light), border.axis) < border.bucket; });
}

void Builder::build(uint32_t node, uint32_t first, uint32_t end, int depth) {
  if (end - first == 1) {
    nodes[node].bounds = lights[order[first]];
    nodes[node].light = order[first];
    return;
  }
  const uint32_t border = split(first, end, depth);
  const uint32_t child = uint32_t(nodes.size());
  nodes.resize(nodes.size() + 2);
  nodes[node].child = child;
  for (uint32_t i = 0; i < 2; ++i) {
    nodes[child + i].parent = node;
    build(child + i, i == 0 ? first : border, i == 0 ? border : end, depth + 1);
  }
  nodes[node].bounds = unite(nodes[child].bounds, nodes[child + 1].bounds);
}

/// layout.glsl: light nodes. `emitters` holds a word for each light of a leaf: its emitters.
void appendLightNodes(std::vector<uint32_t>& words, std::span<const LightNode> nodes,
                      std::span<const uint32_t> emitters) {
  for (const LightNode& node : nodes) {
    const LightBounds& b = node.bounds;
    const double radius = radiusOf(b);
    appendRow(words, glm::vec3(0.5 * (b.low + b.high)), float(b.intensity));
    // A cosine of 1 stays 1, because the direction of one flat lamp is known.
    const double cosine = std::cos(b.spread) - (b.spread > 0.0 ? kMargin : 0.0);
    const double thick = radius > 0.0 ? thicknessOf(b) / radius + kMargin : 0.0;
    const uint32_t kind = (node.light == kMissIndex ? 0u : layout::kLightLeaf) |
                          (b.bothSides ? layout::kLightBothSides : 0u) |
                          (b.falloff > 0.0 ? 0u : layout::kLightSharp);
    words.push_back(axisWord(b.axis));
    words.push_back(uint32_t(std::floor(32767.0 * (std::max(cosine, -1.0) + 1.0))) |
                    uint32_t(std::ceil(65535.0 * std::min(thick, 1.0))) << 16u);
    words.push_back(floatWord(b.everywhere ? -1.0f : float(radius)));
    words.push_back(kind | (node.light == kMissIndex ? node.child : emitters[node.light]));
  }
  const size_t first = words.size();
  words.resize(first + (nodes.size() + 3) / 4 * 4, 0u);
  for (size_t i = 1; i < nodes.size(); ++i) words[first + i] = nodes[i].parent;
}

constexpr double kPi = glm::pi<double>();

/// Appends rows 1 to 3 of an emissive triangle, without its kind.
void appendEdges(Words& words, const Scene& scene, const Triangle& t) {
  const auto [v0, v1, v2] = cornersOf(scene, t);
  const uint32_t doubleSided = scene.materials[t.material].doubleSided ? layout::kEmitterDoubleSided : 0u;
  appendRow(words, v0, 0.0f);
  words.back() = t.material | doubleSided;
  appendRow(words, v1 - v0, float(1.0 / areaOf(cornersOf<glm::dvec3>(scene, t))));
  appendRow(words, v2 - v0, 0.0f);
}

struct Emitter {
  double power = 0.0;  // luminous
  glm::dvec3 position{0.0};
  uint32_t kind = 0;
  uint32_t triangle = kMissIndex;
  uint32_t order = 0;
};

void appendEmissive(std::vector<Emitter>& emitters, const Scene& scene,
                    std::span<const glm::vec3> materialRadiance, std::span<const uint32_t> slots) {
  // A smaller triangle is far below what a ray can be aimed at; the shader divides by the area.
  constexpr double kLeastArea = 1e-30;
  // A light sample itself finds the place of a surface that moves, at its time.
  const size_t count = scene.motion.segments > 0 ? scene.motion.triangles : scene.triangles.size();
  for (size_t i = 0; i < count; ++i) {
    const Triangle& t = scene.triangles[i];
    const double radiance = luminance(glm::dvec3(materialRadiance[t.material]));
    const double area = radiance > 0.0 ? areaOf(cornersOf<glm::dvec3>(scene, t)) : 0.0;
    if (area <= kLeastArea || slots[i] == kMissIndex) continue;
    const auto [a, b, c] = cornersOf<glm::dvec3>(scene, t);
    emitters.push_back({radiance * kPi * area, (a + b + c) / 3.0, slots[i], uint32_t(i)});
  }
}

void appendPunctual(std::vector<Emitter>& emitters, std::span<const Light> lights, double radius) {
  for (size_t i = 0; i < lights.size(); ++i) {
    emitters.push_back({powerOf(boundsOfLight(lights[i]), radius), glm::dvec3(lights[i].position),
                        layout::kEmitterPunctual | uint32_t(i)});
  }
}

/// Every third bit is one of the lowest ten.
uint32_t spreadBits(uint32_t x) {
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}

/// Orders emitters along a Morton curve through their box, so that numbers that are close draw emitters that
/// are close.
void orderInSpace(std::vector<Emitter>& emitters) {
  if (emitters.empty()) return;
  glm::dvec3 low(INFINITY);
  glm::dvec3 high(-INFINITY);
  for (const Emitter& e : emitters) {
    low = glm::min(low, e.position);
    high = glm::max(high, e.position);
  }
  const double size = std::max(glm::compMax(high - low), DBL_MIN);
  for (Emitter& e : emitters) {
    const glm::uvec3 cell((e.position - low) / size * 1023.0);
    e.order = spreadBits(cell.x) | spreadBits(cell.y) << 1 | spreadBits(cell.z) << 2;
  }
  std::stable_sort(emitters.begin(), emitters.end(),
                   [](const Emitter& a, const Emitter& b) { return a.order < b.order; });
}

/// The bounds of a triangle that moves, over all of its way: in each pose, and halfway between them, where a
/// turning one may face elsewhere than in either.
LightBounds boundsOnItsWay(const Scene& scene, Triangle t, double radiance, bool bothSides) {
  auto before = cornersOf<glm::dvec3>(scene, t);
  LightBounds bounds = boundsOfTriangle(before, radiance, bothSides);
  const double intensity = bounds.intensity;
  for (uint32_t segment = 0; segment < scene.motion.segments; ++segment) {
    t = atEnd(scene, t);
    const auto next = cornersOf<glm::dvec3>(scene, t);
    std::array<glm::dvec3, 3> halfway;
    for (size_t i = 0; i < 3; ++i) halfway[i] = 0.5 * (before[i] + next[i]);
    bounds = unite(bounds, boundsOfTriangle(halfway, radiance, bothSides));
    bounds = unite(bounds, boundsOfTriangle(next, radiance, bothSides));
    before = next;
  }
  bounds.intensity = intensity;
  return bounds;
}

LightBounds boundsOf(const Emitter& e, const Scene& scene, std::span<const glm::vec3> materialRadiance,
                     bool alike) {
  if (alike) return {.intensity = 1.0, .everywhere = true};
  if (e.triangle == kMissIndex) return boundsOfLight(scene.lights[e.kind & ~layout::kEmitterPunctual]);
  const Triangle& t = scene.triangles[e.triangle];
  return boundsOnItsWay(scene, t, luminance(glm::dvec3(materialRadiance[t.material])),
                        scene.materials[t.material].doubleSided);
}

/// Emitters that make one leaf, `count` of them from `first` on.
struct EmitterGroup {
  uint32_t first = 0;
  uint32_t count = 1;
};

/// Returns true if the triangles are as large as one another, but for rounding, and send their light alike.
bool areAlike(const Scene& scene, const Emitter& a, const Emitter& b) {
  if (a.triangle == kMissIndex || b.triangle == kMissIndex || scene.motion.segments > 0) return false;
  const Triangle& s = scene.triangles[a.triangle];
  const Triangle& t = scene.triangles[b.triangle];
  return s.material == t.material && std::abs(a.power - b.power) <= 1e-6 * a.power;
}

/// Returns true if flat lights lie in one plane, within four radii of one of them.
bool areTogether(const LightBounds& a, const LightBounds& both, double along) {
  return glm::dot(a.axis, both.axis) >= 1.0 - 1e-9 && std::abs(along) <= 1e-4 * radiusOf(a) &&
         radiusOf(both) <= 4.0 * radiusOf(a);
}

/// Joins emitters that follow one another, such as the two triangles of a window, and their bounds. The tree
/// loses levels that would hardly choose better between two halves of a square.
std::vector<EmitterGroup> joinNeighbours(std::span<const Emitter> emitters, const Scene& scene,
                                         std::vector<LightBounds>& bounds) {
  std::vector<EmitterGroup> groups;
  std::vector<LightBounds> joined;
  for (uint32_t i = 0; i < emitters.size(); ++i) {
    if (!groups.empty() && groups.back().count < layout::kMostLightsOfLeaf) {
      EmitterGroup& group = groups.back();
      const LightBounds both = unite(joined.back(), bounds[i]);
      const double along = glm::dot(bounds[i].axis, emitters[i].position - emitters[group.first].position);
      if (areAlike(scene, emitters[group.first], emitters[i]) &&
          areTogether(bounds[group.first], both, along)) {
        joined.back() = both;
        ++group.count;
        continue;
      }
    }
    groups.push_back({i, 1});
    joined.push_back(bounds[i]);
  }
  bounds = std::move(joined);
  return groups;
}

/// Appends the nodes, and the leaf of each slot.
void appendTree(Words& words, std::span<const Emitter> emitters, std::span<const EmitterGroup> groups,
                std::span<const LightBounds> bounds, size_t slotCount) {
  const std::vector<LightNode> nodes = buildLightTree(bounds);
  std::vector<uint32_t> leaves((slotCount + 3) / 4 * 4, layout::kNoLightNode);
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].light == kMissIndex) continue;
    const auto [first, count] = groups[nodes[i].light];
    for (const Emitter& e : emitters.subspan(first, count)) {
      if (e.triangle != kMissIndex) leaves[e.kind] = i;
    }
  }
  std::vector<uint32_t> groupWords;
  groupWords.reserve(groups.size());
  for (const auto& [first, count] : groups)
    groupWords.push_back(first | (count - 1) << layout::kLightMoreShift);
  words.insert(words.end(), {uint32_t(nodes.size()), 0u, 0u, 0u});
  appendLightNodes(words, nodes, groupWords);
  words.insert(words.end(), leaves.begin(), leaves.end());
}

}  // namespace

std::vector<LightNode> buildLightTree(std::span<const LightBounds> lights) {
  if (lights.empty()) return {};
  Builder builder{lights, {}, {}};
  builder.order.resize(lights.size());
  std::iota(builder.order.begin(), builder.order.end(), 0u);
  builder.nodes.reserve(2 * lights.size() - 1);
  builder.nodes.resize(1);
  builder.build(0, 0, uint32_t(lights.size()), 0);
  return std::move(builder.nodes);
}

PackedEmitters packEmitters(const Scene& scene, std::span<const glm::vec3> materialRadiance,
                            std::span<const uint32_t> slots, size_t slotCount, double radius,
                            const ShaderVariant& variant) {
  const TraitSet& traits = variant.traits;
  PackedEmitters packed;
  packed.materialPdf.assign(scene.materials.size(), 0.0);
  std::vector<Emitter> emitters;
  if (has(traits, Trait::EmissiveTriangles)) appendEmissive(emitters, scene, materialRadiance, slots);
  if (has(traits, Trait::PunctualLights)) appendPunctual(emitters, scene.lights, radius);
  orderInSpace(emitters);
  std::vector<double> powers;
  powers.reserve(emitters.size());
  for (const Emitter& e : emitters) powers.push_back(e.power);
  packed.power = std::accumulate(powers.begin(), powers.end(), 0.0);
  const std::vector<InversionEntry> table = makeInversionEntries(powers);
  for (size_t i = 0; i < emitters.size(); ++i) {
    const double probability = packed.power > 0.0 ? powers[i] / packed.power : 1.0 / double(emitters.size());
    packed.entries.insert(packed.entries.end(),
                          {table[i].first, table[i].last, table[i].end, floatWord(float(probability))});
    if (emitters[i].triangle != kMissIndex) {
      appendEdges(packed.entries, scene, scene.triangles[emitters[i].triangle]);
    } else {
      packed.entries.insert(packed.entries.end(), (layout::kEmitterRows - 1) * 4, 0u);
    }
    packed.entries.back() = emitters[i].kind;
  }
  packed.count = uint32_t(emitters.size());
  if (has(traits, Trait::LightTree)) {
    std::vector<LightBounds> bounds;
    bounds.reserve(emitters.size());
    for (const Emitter& e : emitters)
      bounds.push_back(boundsOf(e, scene, materialRadiance, variant.uniformLights));
    const std::vector<EmitterGroup> groups = joinNeighbours(emitters, scene, bounds);
    appendTree(packed.entries, emitters, groups, bounds, slotCount);
  }
  for (size_t m = 0; m < scene.materials.size() && packed.power > 0.0; ++m) {
    packed.materialPdf[m] = luminance(glm::dvec3(materialRadiance[m])) * kPi / packed.power;
  }
  return packed;
}

Words packLights(const Scene& scene) {
  Words words;
  for (const Light& light : scene.lights) {
    const float type = light.type == LightType::Point  ? layout::kLightPoint
                       : light.type == LightType::Spot ? layout::kLightSpot
                                                       : layout::kLightDirectional;
    // This is the reference code of KHR_lights_punctual for the spot's angular attenuation.
    const float cosOuter = std::cos(light.outerConeAngle);
    const float scale = 1.0f / std::max(0.001f, std::cos(light.innerConeAngle) - cosOuter);
    appendRow(words, light.intensity, type);
    appendRow(words, light.position, std::isfinite(light.range) ? light.range : 0.0f);
    appendRow(words, light.direction, scale);
    appendRow(words, glm::vec4(-cosOuter * scale, 0.0f, 0.0f, 0.0f));
  }
  return words;
}

// The lights of a scene next to one another.

namespace {

/// The part of a side, in a choice between two. Neither is left out altogether: a dim one can still be the
/// only light of a corner.
float chanceOf(double side, double other) {
  const double all = side + other;
  return float(std::clamp(all > 0.0 ? side / all : 0.5, 0.1, 0.9));
}

SunLight lightOf(const Environment& environment) {
  if (environment.mapSun) return SunLight::InMap;
  if (!environment.sun) return SunLight::None;
  return luminance(environment.sun->irradiance) > 0.0 ? SunLight::Shines : SunLight::Set;
}

}  // namespace

TraitSet traitsOf(const Scene& scene, const Environment& environment) {
  return traitsOf(scene, environment.kind, !environment.backdrop.values.empty(), lightOf(environment));
}

float environmentChance(const LightShare& share, double intensity) {
  if (!share.samplesEnvironment) return 0.0f;
  if (!share.anyEmitters) return 1.0f;
  return chanceOf(share.environment * intensity, share.emitters);
}

float sunChance(const LightShare& share, double intensity) {
  const double power = share.sun * intensity;
  if (!share.samplesEnvironment || power <= 0.0) return 0.0f;
  return share.anyEmitters ? chanceOf(power, share.emitters) : 1.0f;
}

}  // namespace fragtrace
