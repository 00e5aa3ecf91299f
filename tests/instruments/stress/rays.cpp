// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/rows.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.h"
#include "bvh/build.h"
#include "bvh/scene_tree.h"
#include "gl/driver_choice.h"
#include "pack/literals.h"
#include "pack/pack_tree.h"
#include "shader/variant.h"
#include "tests/instruments/rays/ray_caster.h"
#include "tests/instruments/rays/ray_judge.h"

namespace fragtrace {

namespace {

/// One way of finding triangles: its tree, packed, and its variant.
struct Way {
  const char* name;
  Bvh bvh;
  ShaderVariant variant;
  bool merges = false;  ///< a hit names either triangle of a quadrilateral
};

ShaderVariant variantOf(const StressSetting& setting, const Scene& scene, TraversalMethod method,
                        uint32_t depth) {
  RenderOptions options;
  options.stages = stagesUpTo(Stage::Flat);
  options.stages.set(size_t(Stage::Watertight), setting.watertight);
  options.device.traversal = method;
  return chooseVariant(options, traitsOf(scene, Surroundings::None), Surroundings::None, depth,
                       BufferReads::Auto);
}

std::vector<Way> waysOf(const StressSetting& setting, const Scene& scene) {
  constexpr size_t kMostIterative = 2500;
  const std::vector<Bounds> bounds = primitiveBounds(scene);
  const auto triangles = uint32_t(scene.triangles.size());
  const Bvh bvh = buildBvh(bounds, triangles);
  std::vector<Way> ways;
  for (const auto& [name, method] :
       {std::pair{"bvh", TraversalMethod::Bvh}, std::pair{"front-to-back", TraversalMethod::FrontToBack}})
    ways.push_back({name, bvh, variantOf(setting, scene, method, bvh.stackNeed)});
  if (std::vector<BuildItem> pieces = cutLong(scene, bounds, 0.0); !pieces.empty()) {
    Bvh tree = buildFromItems(std::move(pieces), triangles);
    const ShaderVariant variant = variantOf(setting, scene, TraversalMethod::FrontToBack, tree.stackNeed);
    ways.push_back({"pieces", std::move(tree), variant});
  }
  if (bounds.size() <= kMostIterative)
    ways.push_back(
        {"iterative", listLeaves(scene), variantOf(setting, scene, TraversalMethod::Iterative, 0)});
  // Literals have a test of their own, which the fast one does not replace.
  if (!setting.watertight) return ways;
  ShaderVariant literal = variantOf(setting, scene, TraversalMethod::FrontToBack, bvh.stackNeed);
  const GpuScene packed = packScene(scene, bvh, {}, literal);
  if (whyNoLiterals(scene, packed).empty()) {
    literal.traversal = TraversalMethod::Literals;
    literal.literals = literalScene(scene, bvh, packed, literal);
    ways.push_back({"literals", bvh, literal, true});
  }
  const std::vector<uint32_t> large = largeTriangles(bounds, triangles);
  if (!large.empty() && large.size() < triangles) {
    Bvh beside = buildBvhBeside(bounds, triangles, large);
    ShaderVariant variant = variantOf(setting, scene, TraversalMethod::FrontToBack, beside.depth);
    variant.literals = largeFirst(scene, beside, variant);
    ways.push_back({"large-first", std::move(beside), std::move(variant), true});
  }
  return ways;
}

/// Triangles that share an edge with this one and lie in its plane.
std::vector<uint32_t> matesOf(const Scene& scene, uint32_t primitive) {
  constexpr double kSamePlane = 1.0 - 1e-9;
  const Bvh none;
  const ExactTracer tracer(scene, none);
  const auto own = cornersOf(scene, scene.triangles[primitive]);
  std::vector<uint32_t> mates;
  for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
    const auto others = cornersOf(scene, scene.triangles[i]);
    const auto shared = std::ranges::count_if(
        own, [&](const glm::vec3& p) { return std::ranges::find(others, p) != others.end(); });
    if (i != primitive && shared == 2 &&
        std::abs(glm::dot(tracer.normal(i, {}), tracer.normal(primitive, {}))) >= kSamePlane)
      mates.push_back(i);
  }
  return mates;
}

const char* nameOf(RayFault fault) {
  constexpr std::array kNames{"none", "hits where nothing is", "hits what lies behind", "misses"};
  return kNames[size_t(fault)];
}

}  // namespace

StressOutcome attackByRays(const StressSetting& setting, const RayAttack& attack) {
  constexpr uint32_t kSeed = 20260;
  const glm::ivec2 size = setting.quick ? glm::ivec2(128) : glm::ivec2(1024);
  const Scene scene = attack.scene();
  const auto [rays, leaves] = attack.rays(scene, size_t(size.x) * size_t(size.y), kSeed + setting.seed);
  const Bvh bvh = buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size()));
  const ExactTracer tracer(scene, bvh);
  proveTree(tracer, scene.triangles.size() + scene.spheres.size(), rays);
  const std::vector<ExactHit> exact = tracer.nearest(rays);
  StressOutcome outcome;
  for (Way& way : waysOf(setting, scene)) {
    setting.goOn();
    GpuScene packed = packScene(scene, way.bvh, {}, way.variant);
    way.variant.reads = chooseReads(BufferReads::Auto, setting.context.software, packed, readLimits()).reads;
    RayCaster caster(setting.context, std::move(packed), way.variant, size, setting.shaderFolder);
    caster.trace(RayCaster::RaySet(rays), false);
    const std::vector<FoundHit> traced = foundBy(caster, way.bvh);
    for (size_t i = 0; i < rays.size(); ++i) {
      FoundHit found = traced[i];
      RayFault fault = judgeRay(scene, rays[i], found, exact[i]);
      if (attack.closed && found.primitive == kMissIndex) fault = RayFault::Missed;
      for (const uint32_t mate : fault == RayFault::FalseHit && way.merges ? matesOf(scene, found.primitive)
                                                                           : std::vector<uint32_t>()) {
        const FoundHit other{mate, found.t};
        const RayFault otherFault = judgeRay(scene, rays[i], other, exact[i]);
        if (otherFault == RayFault::FalseHit) continue;
        found = other;
        fault = otherFault;
        break;
      }
      if (!leaves.empty() && found.primitive == leaves[i]) fault = RayFault::FalseHit;
      ++outcome.cases;
      if (fault == RayFault::None) continue;
      ++outcome.failures;
      const glm::vec3& o = rays[i].origin;
      const glm::vec3& d = rays[i].direction;
      outcome.worst = formatted(
          "%s: ray %zu, origin (%.9g, %.9g, %.9g), direction (%.9g, %.9g, %.9g), %s: primitive %d at %.9g, "
          "in double %d at %.12g",
          way.name, i, double(o.x), double(o.y), double(o.z), double(d.x), double(d.y), double(d.z),
          nameOf(fault), int(found.primitive), double(found.t), int(exact[i].primitive), exact[i].t);
    }
  }
  return outcome;
}

}  // namespace fragtrace
