// SPDX-License-Identifier: MIT
#include "pack/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtx/component_wise.hpp>
#include <numeric>
#include <optional>
#include <utility>

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

}  // namespace fragtrace
