// SPDX-License-Identifier: MIT
// These tests add extensions of materials to shaders/bsdf.glsl, ggx.glsl, iridescence.glsl and
// layers.glsl: sampling, energy, reciprocity, and values by formulas written down a second time.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "shader_layers_cases.h"

namespace fragtrace {
namespace {

std::vector<Case> anisotropicCases() {
  return {{"brushed metal", stretched(metal(0.4), 0.7)},
          {"brushed plastic", stretched(plastic(0.5), 0.5)},
          {"brushed glass from outside", stretched(glass(true), 0.6)},
          {"brushed glass from inside", stretched(glass(true, false), 0.6)},
          {"brushed thin glass", stretched(glass(false), 0.6)}};
}

std::vector<Case> filmCases() {
  return {{"filmed metal", filmed(metal(0.4), 1.3, 400)},
          {"filmed plastic", filmed(plastic(0.4), 1.8, 550, 0.7)},
          {"filmed glass", filmed(glass(true), 1.3, 300)},
          {"filmed glass from inside", filmed(glass(true, false), 1.3, 300)},
          {"soap bubble", filmed(glass(false), 1.33, 250)}};
}

std::vector<Case> throughCases() {
  return {{"leaf", letsThrough(plastic(0.5), 0.6, dvec3(0.4, 0.9, 0.2))},
          {"all through", letsThrough(lambert(), 1.0, dvec3(0.8))},
          {"wax", letsThrough(makeBsdf(0, 0, 0.4, 1.4, true, true), 0.7, dvec3(0.9, 0.6, 0.4))},
          {"wax from inside", letsThrough(makeBsdf(0, 0, 0.4, 1.4, true, false), 0.7, dvec3(0.9, 0.6, 0.4))},
          {"wax and glass", letsThrough(makeBsdf(0, 0.4, 0.4, 1.4, true, true), 0.5, dvec3(0.9))}};
}

std::vector<Case> sheenCases() {
  return {{"velvet", sheened(plastic(0.8), dvec3(0.9, 0.4, 0.2), 0.5)},
          {"black velvet", sheened(letsThrough(lambert(), 0.0, dvec3(1.0)), dvec3(1.0), 0.3)},
          {"dusty metal", sheened(metal(0.5), dvec3(0.3), 0.9)},
          {"dusty glass", sheened(glass(true), dvec3(0.3), 0.6)}};
}

std::vector<Case> coatCases() {
  return {{"car paint", coated(metal(0.6), 1.0, 0.3)},
          {"varnish with a map", coated(plastic(0.5), 0.8, 0.4, dvec3(0.2, -0.1, 1.0))},
          {"coated velvet", coated(sheened(plastic(0.8), dvec3(0.5), 0.5), 1.0, 0.5)},
          {"coated glass", coated(glass(true), 1.0, 0.4)}};
}

std::vector<Case> everyCase() {
  std::vector<Case> all;
  for (const auto& cases : {anisotropicCases(), filmCases(), throughCases(), sheenCases(), coatCases()})
    all.insert(all.end(), cases.begin(), cases.end());
  return all;
}

TEST(ShaderLayers, DirectionsFollowTheDensityAndTheMeanWeightIsTheIntegralOfTheValue) {
  const AllExtensions on;
  const With compensation(glsl_variant::kCompensation, true);
  constexpr int kDraws = 40000;
  Draw draw(307);
  const std::vector<Case> cases = everyCase();
  for (const Case& c : cases) {
    const Bsdf b = glsl_double::compensate(c.bsdf);
    const dvec3 o = atElevation((&c - cases.data()) % 2 == 0 ? 0.7 : 0.3);
    const auto bins = integrateBins([&](const dvec3& i) {
      const auto value = glsl_double::evaluateBsdf(b, o, i);
      return glm::dvec4(value.value * (i.z < 0.0 && b.solid ? b.eta * b.eta : 1.0), value.pdf);
    });
    std::vector<double> expected;
    expected.reserve(bins.size());
    for (const glm::dvec4& bin : bins) expected.push_back(bin.w * kDraws);
    std::vector<double> counted(expected.size(), 0.0);
    double lost = 0.0;
    for (int k = 0; k < kDraws; ++k) {
      const double choice = draw.between(0.0, 1.0);
      const double u = draw.between(0.0, 1.0);
      const auto s = glsl_double::sampleBsdf(b, o, choice, u, draw.between(0.0, 1.0));
      s.pdf > 0.0 ? counted[binOfDirection(s.wi)] += 1.0 : lost += 1.0;
    }
    expected.push_back(std::max(0.0, kDraws - total(expected)));
    counted.push_back(lost);
    EXPECT_GE(chiSquareChance(expected, counted), kSignificance / double(cases.size())) << c.name;
    EXPECT_LE(glm::distance(albedoByDrawing(b, o), dvec3(total(bins))), 0.012) << c.name;
  }
}

TEST(ShaderLayers, AllButTheClearcoatAreReciprocal) {
  const AllExtensions on;
  const With compensation(glsl_variant::kCompensation, true);
  for (const Case& c : everyCase()) {
    if (c.bsdf.coat > 0.0) continue;  // its Fresnel term is that of the viewer's direction
    const Bsdf b = glsl_double::compensate(c.bsdf);
    Draw draw(311);
    for (int k = 0; k < 500; ++k) {
      const dvec3 o = draw.directionAbove();
      const dvec3 i = draw.directionAbove();
      const dvec3 there = glsl_double::evaluateBsdf(b, o, i).value / i.z;
      const dvec3 back = glsl_double::evaluateBsdf(b, i, o).value / o.z;
      EXPECT_LE(glm::distance(there, back), 1e-8 * glm::length(there)) << c.name;
    }
  }
}

TEST(ShaderLayers, DiffuseLightThroughASolidIsTheSameBothWaysOnceCompressionIsTakenOff) {
  const AllExtensions on;
  const Bsdf outside = letsThrough(makeBsdf(0, 0, 0.4, 1.4, true, true), 0.7, dvec3(0.9, 0.6, 0.4));
  const Bsdf inside = letsThrough(makeBsdf(0, 0, 0.4, 1.4, true, false), 0.7, dvec3(0.9, 0.6, 0.4));
  Draw draw(313);
  for (int k = 0; k < 1000; ++k) {
    const dvec3 o = draw.directionAbove();
    const dvec3 i = -draw.directionAbove();
    const dvec3 there = glsl_double::evaluateBsdf(outside, o, i).value / -i.z;
    const dvec3 back =
        glsl_double::evaluateBsdf(inside, dvec3(-i.x, i.y, -i.z), dvec3(-o.x, o.y, -o.z)).value / o.z;
    EXPECT_GT(back.x, 0.0);
    EXPECT_LE(glm::distance(there * 1.4 * 1.4, back / (1.4 * 1.4)), 1e-9 * glm::length(back));
  }
}

// ---- energy ----

TEST(ShaderLayers, NoLayerOverWhiteMetalOrGlassGivesMoreThanItGets) {
  const AllExtensions on;
  Draw draw(317);
  for (int k = 0; k < 24; ++k) {
    const With compensation(glsl_variant::kCompensation, k % 2 == 0);
    Bsdf b = makeBsdf(k % 3 == 0 ? 1.0 : 0.0, 1.0, draw.between(0.1, 1.0), draw.between(1.05, 2.0), k % 4 < 2,
                      k % 5 < 3);
    b.baseColor = dvec3(1.0);
    b = stretched(b, draw.between(0.0, 1.0));
    if (k % 3 != 1) b = filmed(b, draw.between(1.1, 2.0), draw.between(0.0, 900.0), draw.between(0.0, 1.0));
    if (k % 2 == 1) b = sheened(b, dvec3(draw.between(0.0, 1.0)), draw.between(0.05, 1.0));
    if (k % 4 == 3) b = coated(b, draw.between(0.0, 1.0), draw.between(0.0, 1.0));
    const dvec3 o = glm::normalize(draw.directionAbove() + dvec3(0.0, 0.0, 0.02));
    const dvec3 albedo = albedoByDrawing(b, o);
    EXPECT_LE(std::max({albedo.x, albedo.y, albedo.z}), 1.008) << k << ", alpha " << b.alpha << ", z " << o.z;
  }
}

TEST(ShaderLayers, WhiteDiffuseLightIsAllThere) {
  const AllExtensions on;
  for (double share : {0.0, 0.3, 1.0}) {
    Bsdf b = letsThrough(lambert(), share, dvec3(1.0));
    b.baseColor = dvec3(1.0);
    for (double z : kElevations) EXPECT_NEAR(albedoByDrawing(b, atElevation(z)).x, 1.0, 1e-9) << share;
  }
}

TEST(ShaderLayers, SmoothClearcoatOverWhiteKeepsAll) {
  const AllExtensions on;
  Bsdf b = coated(lambert(), 1.0, 0.0);
  b.baseColor = dvec3(1.0);
  for (double z : kElevations) EXPECT_NEAR(albedoByDrawing(b, atElevation(z)).x, 1.0, 2e-3) << z;
}

TEST(ShaderLayers, SheenTakesFromTheBaseWhatItGives) {
  const AllExtensions on;
  for (double roughness : {0.05, 0.1, 0.2, 0.4, 0.7, 1.0}) {
    Bsdf b = sheened(lambert(), dvec3(1.0), roughness);
    b.baseColor = dvec3(1.0);
    for (double z : {0.9, 0.2, 0.05, 0.01}) {
      const double albedo = albedoByDrawing(b, atElevation(z)).x;
      // The base is scaled by the larger albedo of both directions, so something is lost, by design.
      EXPECT_LE(albedo, 1.008) << roughness << ", z " << z;
      EXPECT_GE(albedo, 0.6) << roughness << ", z " << z;
    }
  }
}

TEST(ShaderLayers, StretchedMetalKeepsItsEnergy) {
  const AllExtensions on;
  const With compensation(glsl_variant::kCompensation, true);
  for (double roughness : {0.1, 0.4, 0.55, 0.8, 0.95}) {
    for (double strength : {0.0, 0.3, 0.7, 1.0}) {
      Bsdf b = metal(roughness);
      b.baseColor = dvec3(1.0);
      b = stretched(b, strength);
      double sum = 0.0;
      double weights = 0.0;
      for (double z : {1.0, 0.7, 0.35, 0.05}) {
        for (double azimuth : {0.0, 0.8, M_PI_2}) {
          const double sine = std::sqrt(1.0 - z * z);
          const dvec3 o(sine * std::cos(azimuth), sine * std::sin(azimuth), z);
          const double albedo = albedoByDrawing(b, o).x;
          EXPECT_LE(albedo, 1.008) << roughness << ", strength " << strength << ", z " << z;
          EXPECT_GE(albedo, strength == 0.0 ? 0.99 : 0.93)
              << roughness << ", strength " << strength << ", z " << z;
          sum += z * albedo;
          weights += z;
        }
      }
      EXPECT_GE(sum / weights, 0.97) << roughness << ", strength " << strength;
    }
  }
}

// ---- values ----

TEST(ShaderLayers, StretchedFacetsAreThoseOfTheSpecification) {
  const AllExtensions on;
  const double at = 0.7;
  const double ab = 0.2;
  Bsdf b = metal(0.3);
  b.alpha = std::sqrt(at * ab);
  b.stretch = std::sqrt(at / ab);
  Draw draw(331);
  for (int k = 0; k < 2000; ++k) {
    const dvec3 o = draw.directionAbove();
    const dvec3 i = draw.directionAbove();
    const dvec3 h = glm::normalize(o + i);
    const double f = h.x * h.x / (at * at) + h.y * h.y / (ab * ab) + h.z * h.z;
    const double d = 1.0 / (M_PI * at * ab * f * f);
    const auto reach = [&](const dvec3& v) { return glm::length(dvec3(at * v.x, ab * v.y, v.z)); };
    const double v = 0.5 / (i.z * reach(o) + o.z * reach(i));
    const dvec3 expected = schlick(b.baseColor, 1.0, glm::dot(o, h)) * (d * v * i.z);
    EXPECT_LE(glm::distance(glsl_double::evaluateBsdf(b, o, i).value, expected),
              1e-9 * glm::length(expected));
  }
}

/// KHR_materials_clearcoat, fresnel_coat, about a normal of its own.
TEST(ShaderLayers, ClearcoatIsTheSpecificationsLayer) {
  const AllExtensions on;
  const dvec3 normal = glm::normalize(dvec3(0.3, 0.1, 1.0));
  const Bsdf base = plastic(0.6);
  const Bsdf b = coated(base, 0.7, 0.5, normal);
  Draw draw(337);
  size_t compared = 0;
  for (int k = 0; k < 2000; ++k) {
    const dvec3 o = draw.directionAbove();
    const dvec3 i = draw.directionAbove();
    const double seen = glm::dot(o, normal);
    const double lit = glm::dot(i, normal);
    if (seen <= 0.0 || lit <= 0.0) continue;
    const double share = 0.7 * schlick(dvec3(0.04), 1.0, seen).x;
    const double hn = glm::dot(glm::normalize(o + i), normal);
    const double a2 = 0.0625;
    const double f = hn * hn * (a2 - 1.0) + 1.0;
    const double d = a2 / (M_PI * f * f);
    const double v = 0.5 / (lit * std::sqrt(seen * seen * (1.0 - a2) + a2) +
                            seen * std::sqrt(lit * lit * (1.0 - a2) + a2));
    const dvec3 expected =
        (1.0 - share) * glsl_double::evaluateBase(base, o, i).value + dvec3(share * d * v * lit);
    EXPECT_LE(glm::distance(glsl_double::evaluateBsdf(b, o, i).value, expected),
              1e-9 * glm::length(expected));
    ++compared;
  }
  EXPECT_GT(compared, 1000u);
}

TEST(ShaderLayers, SheenIsTheSpecificationsLobeOverAScaledBase) {
  const AllExtensions on;
  const double roughness = 0.6;  // at this roughness no direction gives out more than it gets
  const double alpha = roughness * roughness;
  const Bsdf base = plastic(0.7);
  const dvec3 color(0.8, 0.4, 0.1);
  const Bsdf b = sheened(base, color, roughness);
  const auto l = [&](double x) {
    const double t = (1.0 - alpha) * (1.0 - alpha);
    const auto between = [&](double p, double q) { return p * (1.0 - t) + q * t; };
    return between(21.5473, 25.3245) /
               (1.0 + between(3.82987, 3.32435) * std::pow(x, between(0.19823, 0.16801))) +
           between(-1.97760, -1.27393) * x + between(-4.32054, -4.85967);
  };
  const auto lambda = [&](double x) { return std::exp(x < 0.5 ? l(x) : 2.0 * l(0.5) - l(1.0 - x)); };
  Draw draw(347);
  for (int k = 0; k < 1000; ++k) {
    const dvec3 o = draw.directionAbove();
    const dvec3 i = draw.directionAbove();
    const double nh = glm::normalize(o + i).z;
    const double d = (2.0 + 1.0 / alpha) * std::pow(1.0 - nh * nh, 0.5 / alpha) / (2.0 * M_PI);
    const double v = 1.0 / ((1.0 + lambda(o.z) + lambda(i.z)) * 4.0 * o.z * i.z);
    const EnergyTable& table = sheenAlbedoTable();
    const double most = std::max(table.at(float(o.z), float(alpha)), table.at(float(i.z), float(alpha)));
    const dvec3 expected =
        color * (d * v * i.z) + (1.0 - 0.8 * most) * glsl_double::evaluateBase(base, o, i).value;
    EXPECT_LE(glm::distance(glsl_double::evaluateBsdf(b, o, i).value, expected),
              1e-6 * glm::length(expected));
  }
}

TEST(ShaderLayers, ADiffuseWallLetsItsShareThrough) {
  const AllExtensions on;
  const Bsdf b = letsThrough(plastic(0.5), 0.3, dvec3(0.2, 0.4, 0.6));
  const Bsdf opaque = plastic(0.5);
  Draw draw(349);
  for (int k = 0; k < 1000; ++k) {
    const dvec3 o = draw.directionAbove();
    const dvec3 i = draw.directionAbove();
    const double through = 1.0 - schlick(opaque.dielectricF0, 1.0, glm::dot(o, glm::normalize(o + i))).x;
    const dvec3 lambertian = through * opaque.baseColor * (i.z / M_PI);
    const dvec3 above = glsl_double::evaluateBsdf(opaque, o, i).value - 0.3 * lambertian;
    EXPECT_LE(glm::distance(glsl_double::evaluateBsdf(b, o, i).value, above), 1e-9);
    const dvec3 below = 0.3 * through * dvec3(0.2, 0.4, 0.6) * (i.z / M_PI);
    EXPECT_LE(glm::distance(glsl_double::evaluateBsdf(b, o, dvec3(i.x, i.y, -i.z)).value, below), 1e-9);
  }
}

// ---- float ----

TEST(ShaderLayers, FloatValuesAndSamplesAreFiniteAndNearDouble) {
  const AllExtensions on;
  size_t far = 0;
  size_t count = 0;
  for (const Case& c : everyCase()) {
    const glsl_float::Bsdf b = toFloat(c.bsdf);
    Draw draw(367);
    for (int k = 0; k < 4000; ++k) {
      dvec3 o = draw.directionAbove();
      if (k % 8 == 0) o = glm::normalize(dvec3(o.x, o.y, o.z * 1e-4));
      const vec3 wo(o);
      const vec3 wi(draw.direction());
      const auto value = glsl_float::evaluateBsdf(b, wo, wi);
      const auto expected = glsl_double::evaluateBsdf(c.bsdf, dvec3(wo), dvec3(wi));
      ASSERT_TRUE(std::isfinite(value.value.x + value.value.y + value.value.z + value.pdf)) << c.name;
      ASSERT_GE(std::min({value.value.x, value.value.y, value.value.z, value.pdf}), 0.0f) << c.name;
      ++count;
      if (glm::distance(dvec3(value.value), expected.value) > 3e-3 * glm::length(expected.value) + 1e-6)
        ++far;
      const float choice = draw.unit();
      const float u = draw.unit();
      const auto s = glsl_float::sampleBsdf(b, wo, choice, u, draw.unit());
      ASSERT_TRUE(std::isfinite(s.weight.x + s.weight.y + s.weight.z + s.pdf)) << c.name << ", z " << o.z;
      ASSERT_GE(std::min({s.weight.x, s.weight.y, s.weight.z}), 0.0f) << c.name;
      ASSERT_GE(s.pdf, 0.0f) << c.name;
    }
  }
  EXPECT_LE(double(far), 2e-3 * double(count));
}

}  // namespace
}  // namespace fragtrace
