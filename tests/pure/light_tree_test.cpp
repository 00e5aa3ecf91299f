// SPDX-License-Identifier: MIT
// The tree over lights: what src/pack builds of it, and what shaders/lights.glsl chooses by it.
#include "pack/pack_lights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "shader_lights.h"

namespace fragtrace {
namespace {

constexpr double kLimit = 4.5;  // standard errors: a chance of 7e-6 a comparison

const dvec3 kOrigin(0.0);

/// Makes lights of all kinds in a box of 20 x 4 x 4 m. Their powers span four powers of ten, and some are at
/// one place.
std::vector<LightBounds> randomLights(Draw& draw, int count) {
  std::vector<LightBounds> lights;
  for (int i = 0; i < count; ++i) {
    const dvec3 place = i % 17 == 0 ? dvec3(1.0) : dvec3(10.0, 2.0, 2.0) * draw.inCube(1.0);
    const double power = std::pow(10.0, draw.between(-2.0, 2.0));
    const dvec3 axis = glm::normalize(draw.inCube(1.0));
    if (i % 3 == 0) {
      const dvec3 a = place + 0.1 * draw.inCube(1.0);
      lights.push_back(boundsOfTriangle({place, a, place + 0.1 * draw.inCube(1.0)}, power, i % 2 == 0));
      continue;
    }
    Light light;
    light.type = i % 50 == 1 ? LightType::Directional : i % 3 == 1 ? LightType::Spot : LightType::Point;
    light.intensity = vec3(float(power));
    light.position = vec3(place);
    light.direction = vec3(axis);
    light.outerConeAngle = float(draw.between(0.05, 1.5));
    lights.push_back(boundsOfLight(light));
  }
  return lights;
}

TEST(LightTree, HoldsEachLightOnceAndLeadsBackToTheRoot) {
  Draw draw(601);
  for (const int count : {1, 2, 3, 7, 300, 2000}) {
    const std::vector<LightBounds> lights = randomLights(draw, count);
    const std::vector<LightNode> nodes = buildLightTree(lights);
    ASSERT_EQ(nodes.size(), 2 * lights.size() - 1);
    std::vector<int> held(lights.size());
    int deepest = 0;
    for (uint32_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].light == kMissIndex) {
        EXPECT_EQ(nodes[i].child % 2, 1u);  // the shader finds siblings by it
        EXPECT_EQ(nodes[nodes[i].child].parent, i);
        EXPECT_EQ(nodes[nodes[i].child + 1].parent, i);
        continue;
      }
      ++held[nodes[i].light];
      int depth = 0;
      for (uint32_t at = i; at != 0; at = nodes[at].parent) ++depth;
      deepest = std::max(deepest, depth);
    }
    EXPECT_EQ(std::ranges::count(held, 1), count);
    EXPECT_LE(deepest, 40);
  }
  EXPECT_TRUE(buildLightTree({}).empty());
}

TEST(LightTree, ANodeShinesWhereverALightBelowItDoes) {
  Draw draw(607);
  const std::vector<LightNode> nodes = buildLightTree(randomLights(draw, 400));
  int dark = 0;
  for (int k = 0; k < 300; ++k) {
    const dvec3 point = dvec3(12.0, 4.0, 4.0) * draw.inCube(1.0);
    for (const LightNode& leaf : nodes) {
      if (leaf.light == kMissIndex) continue;
      if (importanceOf(leaf.bounds, point) <= 1e-9) continue;
      for (uint32_t at = leaf.parent; at != kMissIndex; at = nodes[at].parent)
        ASSERT_GT(importanceOf(nodes[at].bounds, point), 0.0);
    }
    for (const LightNode& node : nodes)
      dark += node.light == kMissIndex && importanceOf(node.bounds, point) <= 0.0 ? 1 : 0;
  }
  EXPECT_GT(dark, 100);  // bounds that are too loose would leave out no node
}

/// 120 triangles in a row before the origin, and the punctual lights.
Scene rowScene() {
  Scene scene = octantScene();
  scene.lights = threeLights();
  Draw draw(613);
  for (int i = 0; i < 120; ++i) {
    const dvec3 place(0.25 * i - 15.0, 2.0 + draw.unit(), draw.between(-1.0, 1.0));
    const auto first = uint32_t(scene.vertices.position.size());
    for (int c = 0; c < 3; ++c) scene.vertices.position.emplace_back(place + 0.1 * draw.inCube(1.0));
    Triangle t;
    t.vertex = {first, first + 1, first + 2};
    t.material = uint32_t(i) % 2;
    scene.triangles.push_back(t);
  }
  for (const vec3& p : scene.vertices.position) scene.bounds.include(dvec3(p));
  return scene;
}

TEST(LightTree, TheShaderChoosesWithTheChancesItTells) {
  const Lit lit(rowScene(), false, LightSelection::Tree);
  Draw draw(617);
  constexpr uint32_t kSteps = 1 << 15;
  for (int k = 0; k < 20; ++k) {
    const dvec3 point = dvec3(14.0, 1.0, 1.0) * draw.inCube(1.0);
    const uint32_t normal =
        k % 2 == 0 ? layout::kNoNormal : glsl_double::packNormal(glm::normalize(draw.inCube(1.0)));
    const auto to = glsl_double::receiverOf(point, normal);
    std::map<int, double> chances;
    std::map<int, double> chosen;
    double lost = 0.0;  // the loss where bounds promised light that is not there
    for (uint32_t i = 0; i < kSteps; ++i) {
      const auto emitter = glsl_double::emitterByTree(1.0, to, i << 17 | 1u << 16, uvec2(0u));
      if (emitter.chance <= 0.0) {
        lost += 1.0 / kSteps;
        continue;
      }
      chances[emitter.emitter] = emitter.chance;
      chosen[emitter.emitter] += 1.0 / kSteps;
    }
    double sum = 0.0;
    for (const auto& [emitter, chance] : chances) {
      sum += chance;
      EXPECT_NEAR(chosen[emitter], chance, 2.0 / kSteps);
    }
    // Those left out are rarer than a step.
    EXPECT_NEAR(sum, 1.0 - lost, 40.0 / kSteps);
    if (normal == layout::kNoNormal) {
      EXPECT_LT(lost, 0.2);
    }
    const auto rounded =
        glsl_float::emitterByTree(1.0f, glsl_float::receiverOf(vec3(point), normal), 1u << 31, uvec2(0u));
    const auto exact = glsl_double::emitterByTree(1.0, to, 1u << 31, uvec2(0u));
    if (rounded.emitter == exact.emitter) {
      EXPECT_NEAR(rounded.chance, exact.chance, 2e-3 * exact.chance);
    }
  }
}

TEST(LightTree, NormalsAreKeptNearly) {
  Draw draw(631);
  for (int k = 0; k < 20000; ++k) {
    const dvec3 n = k < 6 ? dvec3(k / 2 == 0, k / 2 == 1, k / 2 == 2) * (k % 2 ? 1.0 : -1.0)
                          : glm::normalize(draw.inCube(1.0));
    const uint32_t bits = glsl_float::packNormal(vec3(n));
    ASSERT_LT(bits, layout::kNoNormal);
    ASSERT_LE(glm::distance(dvec3(glsl_float::unpackNormal(bits)), n), 8e-3);
  }
}

TEST(LightTree, WhatShinesOnASurfaceIsNeverLeftOut) {
  const Lit lit(rowScene(), false, LightSelection::Tree);
  const std::vector<uint32_t> slots = leafSlots(lit.scene, lit.bvh);
  Draw draw(641);
  int shone = 0;
  for (int k = 0; k < 300; ++k) {
    const dvec3 point = dvec3(16.0, 3.0, 2.0) * draw.inCube(1.0);
    const dvec3 normal = glm::normalize(draw.inCube(1.0));
    for (size_t i = 0; i < lit.scene.triangles.size(); ++i) {
      if (!lit.shines(i)) continue;
      const auto [a, b, c] = cornersOf<dvec3>(lit.scene, lit.scene.triangles[i]);
      const dvec3 towards = (a + b + c) / 3.0 - point;
      const double cosine = -glm::dot(lit.normalOf(i), glm::normalize(towards));
      const bool faces = lit.scene.triangles[i].material == 0 ? std::abs(cosine) > 1e-3 : cosine > 1e-3;
      if (!faces || glm::dot(normal, towards) <= 0.0) continue;
      ++shone;
      ASSERT_GT(
          glsl_float::treePdf(int(slots[i]), vec3(point), glsl_float::packNormal(vec3(normal)), 1.0f, 1.0f),
          0.0f);
    }
  }
  EXPECT_GT(shone, 5000);
}

/// Lights of the scene that some number chooses.
std::set<uint32_t> lightsWithin(const glsl_float::Receiver& to) {
  std::set<uint32_t> found;
  std::vector<uint32_t> open{glsl_float::readEmitters(glsl_float::lightNodes() + 1).w};
  while (!open.empty()) {
    const uint32_t child = open.back();
    open.pop_back();
    const int index = int(child & layout::kLightIndex);
    if ((child & layout::kLightLeaf) != 0u) {
      const uint32_t kind = glsl_float::emitterRow(index, 3).w;
      if ((kind & layout::kEmitterPunctual) != 0u) found.insert(kind & ~layout::kEmitterPunctual);
      continue;
    }
    for (const int i : {index, index + 1}) {
      const auto node = glsl_float::lightNodeFrom(i, to);
      if (node.importance > 0.0f) open.push_back(node.child);
    }
  }
  return found;
}

TEST(LightTree, ASpotIsChosenWhereverItShines) {
  Scene scene = octantScene();
  Draw draw(659);
  // Groups of spots that look the same way, so that nodes keep a narrow cone and are seen from the side.
  for (int i = 0; i < 48; ++i) {
    Light spot;
    spot.type = LightType::Spot;
    spot.intensity = vec3(1.0f);
    const int column = i / 8;
    spot.position = dvec3(6.0 * column - 15.0, 0.0, 0.0) + draw.inCube(1.0);
    spot.direction = glm::normalize(dvec3(0.1 * column, -1.0, 0.2) + 0.05 * draw.inCube(1.0));
    spot.innerConeAngle = 0.1f;
    spot.outerConeAngle = 0.2f;
    scene.lights.push_back(spot);
  }
  for (const vec3& p : scene.vertices.position) scene.bounds.include(dvec3(p));
  const Lit lit(scene, false, LightSelection::Tree);
  int shone = 0;
  int dark = 0;
  for (int k = 0; k < 4000; ++k) {
    const dvec3 point = dvec3(0.0, -3.0, 0.0) + dvec3(18.0, 3.0, 3.0) * draw.inCube(1.0);
    const auto within = lightsWithin(glsl_float::receiverOf(vec3(point), layout::kNoNormal));
    for (uint32_t i = 0; i < lit.scene.lights.size(); ++i) {
      const bool shines =
          luminanceOf(dvec3(glsl_float::punctualLight(int(i), vec3(point)).irradiance)) > 1e-6;
      shone += shines ? 1 : 0;
      dark += within.contains(i) ? 0 : 1;
      ASSERT_TRUE(!shines || within.contains(i));
    }
  }
  EXPECT_GT(shone, 1000);
  EXPECT_GT(dark, 40000);  // and most are left out where they do not shine
}

TEST(LightTree, DensityOfASampleIsThatOfTheRayThatFindsIt) {
  for (const LightSelection selection : {LightSelection::Tree, LightSelection::Uniform}) {
    const Lit lit(rowScene(), true, selection);
    const std::vector<uint32_t> slots = leafSlots(lit.scene, lit.bvh);
    const double share = 1.0 - glsl_variant::frame.environmentChance;
    Draw draw(619);
    int found = 0;
    for (int k = 0; k < 20000; ++k) {
      const dvec3 point = draw.inCube(1.0);
      const uvec2 bits{uint32_t(draw.engine()), uint32_t(draw.engine())};
      const uint32_t normal =
          k % 2 == 0 ? layout::kNoNormal : glsl_double::packNormal(glm::normalize(draw.inCube(1.0)));
      const auto s =
          glsl_double::lightOfChoice(glsl_double::emitterByTree(share, glsl_double::receiverOf(point, normal),
                                                                uint32_t(draw.engine()), bits),
                                     point);
      if (s.pdf <= 0.0) continue;
      const auto place = lit.placeOf(point + s.direction * s.distance);
      if (!place) continue;  // one of two triangles at the same place was hit
      ++found;
      const double cosine = std::abs(glm::dot(lit.normalOf(place->triangle), s.direction));
      EXPECT_NEAR(glsl_double::treePdf(int(slots[place->triangle]), point, normal, s.distance, cosine), s.pdf,
                  2e-4 * s.pdf);  // where lamps are seen edge-on, the single precision of their edges matters
      EXPECT_LE(glm::distance(s.irradiance * s.pdf, lit.radianceOf(place->triangle)),
                1e-5 * glm::length(lit.radianceOf(place->triangle)));
    }
    EXPECT_GT(found, 5000);
    // A triangle that is no light has no pdf.
    EXPECT_EQ(glsl_double::treePdf(int(slots[7]), kOrigin, layout::kNoNormal, 1.0, 1.0), 0.0);
  }
}

TEST(LightTree, OneSampleOfAllLightsAndTheEnvironmentIsUnbiased) {
  constexpr uint32_t kSamples = 1 << 17;
  const With independent(glsl_variant::kSobol, false);
  Scene scene = octantScene();
  scene.lights = threeLights();
  for (const vec3& p : scene.vertices.position) scene.bounds.include(dvec3(p));
  double byPower = 0.0;
  for (const LightSelection selection :
       {LightSelection::Power, LightSelection::Tree, LightSelection::Uniform}) {
    const Lit lit(scene, true, selection);
    Estimate estimate;
    for (uint32_t k = 0; k < kSamples; ++k) {
      const auto sampler = glsl_double::makeSampler(glsl_double::pixelKey(11, 13, 17), k);
      estimate.add(
          luminanceOf(glsl_double::sampleLight(0, kOrigin, layout::kNoNormal, sampler, 5).irradiance));
    }
    // Another test (ShaderLights) checks that light samples by power have the right mean.
    if (selection == LightSelection::Power) byPower = estimate.mean();
    EXPECT_LE(estimate.error(), 0.01 * byPower);
    EXPECT_LE(std::abs(estimate.mean() - byPower), kLimit * M_SQRT2 * estimate.error());
  }
}

/// A surface that takes light from one side, or from both.
struct LitPlace {
  dvec3 point = kOrigin;
  dvec3 normal{0.0, 0.0, 1.0};
  bool through = false;

  uint32_t packed() const { return glsl_double::packNormal(normal); }
  /// Returns the normal as a light sample takes it.
  uint32_t receiver(bool tree) const { return tree && !through ? packed() : uint32_t(layout::kNoNormal); }
};

auto reservoirOn(const LitPlace& place, bool tree, const glsl_double::Sampler& sampler) {
  glsl_double::LitSurface on;
  on.point = place.point;
  on.normal = place.packed();
  on.through = place.through;
  return glsl_double::makeReservoir(on, place.receiver(tree), sampler, 5);
}

/// One of the light samples of the place and of four others, some of which are not there, each kept in
/// texels.
auto reusedLight(const LitPlace& place, bool tree, uint32_t k) {
  const With records(glsl_variant::kStoresReservoirs, true);
  const auto kept = [](const auto& r) {
    return glsl_double::reservoirOf(glsl_double::firstTexel(r), glsl_double::secondTexel(r));
  };
  const auto own =
      kept(reservoirOn(place, tree, glsl_double::makeSampler(glsl_double::pixelKey(11, 13, 17), k)));
  const double target = own.weight > 0.0 ? glsl_double::targetOf(own.light, own.surface) : 0.0;
  Draw draw(k);
  auto reuse = glsl_double::beginReuse(draw.unit());
  for (uint32_t i = 0; i < layout::kReuseNeighbours; ++i) {
    LitPlace other = place;
    other.point += 0.2 * draw.inCube(1.0);
    other.normal = glm::normalize(place.normal + draw.inCube(1.0));
    auto near = kept(reservoirOn(other, tree, glsl_double::makeSampler(glsl_double::pixelKey(i, 19, 23), k)));
    near.known = draw.unit() < 0.8;
    reuse = glsl_double::addNeighbour(reuse, own, target, near);
  }
  return glsl_double::endReuse(reuse, own, target, place.point, place.receiver(tree));
}

/// Estimates the light that all lights bring to a surface, except for the part that rays of a pdf of 0.3
/// find: by one light sample, or by one of several.
Estimate lightOnSurface(const LitPlace& place, LightReuse by, bool tree) {
  constexpr uint32_t kSamples = 1 << 17;
  Estimate estimate;
  for (uint32_t k = 0; k < kSamples; ++k) {
    const auto sampler = glsl_double::makeSampler(glsl_double::pixelKey(11, 13, 17), k);
    const uint32_t packed = place.receiver(tree);
    const auto s =
        by == LightReuse::Spatial ? reusedLight(place, tree, k)
        : by == LightReuse::Candidates
            ? glsl_double::lightOfCandidates(place.point, place.normal, place.through, packed, sampler, 5)
            : glsl_double::sampleLight(0, place.point, packed, sampler, 5);
    const double cosine = glm::dot(s.direction, place.normal);
    const double weight = s.pdf > 0.0 ? s.pdf / (s.pdf + 0.3) : 1.0;
    // From behind light comes through as red glass lets it.
    const double part = cosine > 0.0 ? cosine : place.through ? -0.3 * cosine : 0.0;
    estimate.add(luminanceOf(s.irradiance) * part * weight);
  }
  return estimate;
}

TEST(LightCandidates, OneOfSeveralBringsWhatOneAloneDoesWithLessNoise) {
  const With independent(glsl_variant::kSobol, false);
  Scene scene = octantScene();
  scene.lights = threeLights();
  for (const vec3& p : scene.vertices.position) scene.bounds.include(dvec3(p));
  for (const LightSelection selection : {LightSelection::Power, LightSelection::Tree}) {
    const Lit lit(scene, true, selection);
    const bool tree = selection == LightSelection::Tree;
    const dvec3 front = glm::normalize(dvec3(0.3, 0.8, -0.5));
    // The last one gets most of its light from behind.
    for (const LitPlace& place :
         {LitPlace{kOrigin, front}, {kOrigin, front, true}, {kOrigin, -front, true}}) {
      const Estimate one = lightOnSurface(place, LightReuse::None, tree);
      EXPECT_LE(one.error(), 0.01 * one.mean());
      for (const LightReuse by : {LightReuse::Candidates, LightReuse::Spatial}) {
        const Estimate several = lightOnSurface(place, by, tree);
        EXPECT_LE(several.error(), 0.8 * one.error());
        EXPECT_LE(std::abs(several.mean() - one.mean()), kLimit * std::hypot(one.error(), several.error()));
      }
    }
  }
}

TEST(LightCandidates, EachAloneIsUniform) {
  constexpr int kParts = 8;
  for (int index = 0; index < int(layout::kLightCandidates); ++index) {
    std::array<int, kParts * kParts> cells{};
    Draw draw(653 + uint64_t(index));
    constexpr int kDraws = 1 << 14;
    for (int k = 0; k < kDraws; ++k) {
      glsl_double::LightNumbers first;
      first.choice = uint32_t(draw.engine());
      first.bits = {uint32_t(draw.engine()), uint32_t(draw.engine())};
      const auto n = glsl_double::shifted(first, index);
      ++cells[(n.bits.x >> 29) * kParts + (n.bits.y >> 29)];
    }
    double squared = 0.0;
    for (const int count : cells) squared += std::pow(count - kDraws / 64.0, 2) / (kDraws / 64.0);
    EXPECT_LT(squared, 125.0);  // 63 degrees of freedom, chance 1e-5
  }
}

}  // namespace
}  // namespace fragtrace
