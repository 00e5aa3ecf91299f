// SPDX-License-Identifier: MIT
// What extensions of materials make of shaders/bsdf.glsl, ggx.glsl, sheen.glsl, iridescence.glsl and
// layers.glsl: sampling, energy, reciprocity, and values by formulas written down a second time.
#include <gtest/gtest.h>

#include <numeric>

#include "shader_bsdf_cases.h"

namespace fragtrace {
namespace {

/// Turns on what the cases below need, until the end of the scope.
struct AllExtensions {
  With<bool> anisotropy{glsl_variant::kAnisotropy, true};
  With<bool> iridescence{glsl_variant::kIridescence, true};
  With<bool> diffuseTransmission{glsl_variant::kDiffuseTransmission, true};
  With<bool> sheen{glsl_variant::kSheen, true};
  With<bool> clearcoat{glsl_variant::kClearcoat, true};
};

/// As stretchFacets of shaders/material_layers.glsl.
Bsdf stretched(Bsdf b, double strength) {
  const double across = std::max(b.alpha, glsl_double::kMirrorAlpha);
  const double along = across + (1.0 - across) * strength * strength;
  b.alpha = std::sqrt(along * across);
  b.stretch = std::sqrt(along / across);
  b.mirrorLike = false;
  return glsl_double::compensate(b);
}

Bsdf filmed(Bsdf b, double index, double thickness, double weight = 1.0) {
  b.film = weight;
  b.filmIndex = index;
  b.filmThickness = thickness;
  return glsl_double::compensate(b);
}

Bsdf coated(Bsdf b, double weight, double roughness, const dvec3& normal = dvec3(0.0, 0.0, 1.0)) {
  b.coat = weight;
  b.coatAlpha = roughness * roughness;
  b.coatNormal = glm::normalize(normal);
  return b;
}

Bsdf sheened(Bsdf b, const dvec3& color, double roughness) {
  b.sheenColor = color;
  b.sheenAlpha = roughness * roughness;
  return b;
}

Bsdf letsThrough(Bsdf b, double share, const dvec3& color) {
  b.diffuseThrough = share;
  b.throughColor = color;
  return b;
}

Bsdf plastic(double roughness) { return makeBsdf(0, 0, roughness, 1.5, false, true); }
Bsdf metal(double roughness) { return makeBsdf(1, 0, roughness, 1.5, false, true); }
Bsdf glass(bool solid, bool front = true) { return makeBsdf(0, 1, 0.5, 1.5, solid, front); }

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
      return glm::dvec4(value.value * (i.z < 0.0 && b.solid ? b.eta * b.eta : 1.0), value.density);
    });
    std::vector<double> expected;
    for (const glm::dvec4& bin : bins) expected.push_back(bin.w * kDraws);
    std::vector<double> counted(expected.size(), 0.0);
    double lost = 0.0;
    for (int k = 0; k < kDraws; ++k) {
      const double choice = draw.between(0.0, 1.0);
      const double u = draw.between(0.0, 1.0);
      const auto s = glsl_double::sampleBsdf(b, o, choice, u, draw.between(0.0, 1.0));
      s.density > 0.0 ? counted[binOfDirection(s.incoming)] += 1.0 : lost += 1.0;
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

TEST(ShaderLayers, StretchedMetalLosesNoMoreThanMaskingDoes) {
  const AllExtensions on;
  const With compensation(glsl_variant::kCompensation, true);
  for (double roughness : {0.1, 0.4, 0.8}) {
    for (double strength : {0.0, 0.3, 1.0}) {
      Bsdf b = metal(roughness);
      b.baseColor = dvec3(1.0);
      b = stretched(b, strength);
      for (double z : {1.0, 0.6, 0.2, 0.05}) {
        const double albedo = albedoByDrawing(b, atElevation(z)).x;
        EXPECT_LE(albedo, 1.008) << roughness << ", strength " << strength << ", z " << z;
        EXPECT_GE(albedo, strength == 0.0 ? 0.99 : 0.5) << roughness << ", strength " << strength;
      }
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
  const double roughness = 0.6;  // where no direction gives out more than it gets
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
    const SheenAlbedoTable& table = sheenAlbedoTable();
    const double most =
        std::max(sheenAlbedo(table, float(o.z), float(alpha)), sheenAlbedo(table, float(i.z), float(alpha)));
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

// ---- thin films ----

/// The interference of the first orders, integrated over wave numbers against the sensors' Gaussians.
dvec3 filmByIntegration(const dvec3& baseF0, double index, double thickness, double cosine) {
  const double inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
  const double r12 = schlick(dvec3(std::pow((index - 1.0) / (index + 1.0), 2.0)), 1.0, cosine).x;
  const double path = 2.0 * index * thickness * 1e-9 * inside;
  constexpr double kHeight[] = {5.4856e-13, 4.4201e-13, 5.2481e-13, 9.7470e-14};
  constexpr double kPlace[] = {1.6810e6, 1.7953e6, 2.2084e6, 2.2399e6};
  constexpr double kWidth[] = {4.3278e9, 9.3046e9, 6.6121e9, 4.5282e9};
  dvec3 result(0.0);
  dvec3 shifts(0.0);
  dvec3 strength(0.0);
  dvec3 order(0.0);
  for (int c = 0; c < 3; ++c) {
    const double root = std::sqrt(baseF0[c] + 1e-4);
    const double base = (1.0 + root) / (1.0 - root);
    const double r23 = schlick(dvec3(std::pow((base - index) / (base + index), 2.0)), 1.0, inside).x;
    shifts[c] = M_PI + (base < index ? M_PI : 0.0);
    const double both = std::clamp(r12 * r23, 1e-5, 0.9999);  // as the extension has it
    order[c] = std::sqrt(both);
    const double sum = (1.0 - r12) * (1.0 - r12) * r23 / (1.0 - both);
    result[c] = r12 + sum;
    strength[c] = sum - (1.0 - r12);
  }
  for (int m = 1; m <= 2; ++m) {
    dvec3 xyz(0.0);
    for (int sensor = 0; sensor < 4; ++sensor) {
      const int c = sensor % 3;
      // A Gaussian of variance 2 x width, of which the cosine's mean is what the film shows.
      const double deviation = std::sqrt(2.0 * kWidth[sensor]);
      double mean = 0.0;
      constexpr int kSteps = 400;
      for (int k = 0; k < kSteps; ++k) {
        const double t = -6.0 + 12.0 * (k + 0.5) / kSteps;
        mean += std::exp(-0.5 * t * t) / std::sqrt(2.0 * M_PI) * 12.0 / kSteps *
                std::cos((kPlace[sensor] + deviation * t) * 2.0 * M_PI * m * path + m * shifts[c]);
      }
      xyz[c] += kHeight[sensor] * std::sqrt(2.0 * M_PI * kWidth[sensor]) * mean / 1.0685e-7;
    }
    const dvec3 seen(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                     -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                     0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
    for (int c = 0; c < 3; ++c) result[c] += strength[c] * std::pow(order[c], m) * 2.0 * seen[c];
  }
  return glm::clamp(result, 0.0, 1.0);
}

TEST(ShaderIridescence, IsTheInterferenceOfTheFirstOrders) {
  Draw draw(353);
  for (int k = 0; k < 300; ++k) {
    const dvec3 baseF0 = 0.45 + draw.inCube(0.4);
    const double index = draw.between(1.05, 2.2);
    const double thickness = draw.between(1.0, 1200.0);
    const double cosine = draw.between(0.0, 1.0);
    EXPECT_LE(glm::distance(glsl_double::filmReflectance(baseF0, index, thickness, cosine),
                            filmByIntegration(baseF0, index, thickness, cosine)),
              2e-4)
        << "index " << index << ", " << thickness << " nm, cosine " << cosine;
  }
}

TEST(ShaderIridescence, NoFilmIsTheBareSurfaceAndAllStaysBetweenZeroAndOne) {
  Draw draw(359);
  for (int k = 0; k < 2000; ++k) {
    const dvec3 baseF0 = 0.5 + draw.inCube(0.5);
    const double index = draw.between(1.0, 2.5);
    const double cosine = draw.between(0.0, 1.0);
    EXPECT_LE(
        glm::distance(glsl_double::filmReflectance(baseF0, index, 0.0, cosine), schlick(baseF0, 1.0, cosine)),
        1e-12);
    const vec3 film = glsl_float::filmReflectance(vec3(baseF0), float(index),
                                                  float(draw.between(0.0, 1500.0)), float(cosine));
    for (int c = 0; c < 3; ++c) {
      ASSERT_GE(film[c], 0.0f);
      ASSERT_LE(film[c], 1.0f);
    }
  }
}

TEST(ShaderIridescence, SmoothGlassUnderAFilmGivesBackAllButItsColour) {
  const AllExtensions on;
  for (bool solid : {false, true}) {
    Bsdf b = filmed(makeBsdf(0, 1, 0.0, 1.5, solid, true), 1.33, 300);
    b.baseColor = dvec3(1.0);
    for (double z : {1.0, 0.5, 0.1}) {
      const dvec3 albedo = albedoByDrawing(b, atElevation(z));
      // One channel is whole; what the others lack is what their reflection lacks.
      EXPECT_NEAR(std::max({albedo.x, albedo.y, albedo.z}), 1.0, 1e-6);
      const dvec3 r = glsl_double::glassReflectance(b, z);
      const dvec3 expected = dvec3(1.0) + r - dvec3(std::max({r.x, r.y, r.z}));
      EXPECT_LE(glm::distance(albedo, expected), 2e-3) << "solid " << solid << ", z " << z;
    }
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
      const vec3 outgoing(o);
      const vec3 incoming(draw.direction());
      const auto value = glsl_float::evaluateBsdf(b, outgoing, incoming);
      const auto expected = glsl_double::evaluateBsdf(c.bsdf, dvec3(outgoing), dvec3(incoming));
      ASSERT_TRUE(std::isfinite(value.value.x + value.value.y + value.value.z + value.density)) << c.name;
      ASSERT_GE(std::min({value.value.x, value.value.y, value.value.z, value.density}), 0.0f) << c.name;
      ++count;
      if (glm::distance(dvec3(value.value), expected.value) > 3e-3 * glm::length(expected.value) + 1e-6)
        ++far;
      const float choice = draw.unit();
      const float u = draw.unit();
      const auto s = glsl_float::sampleBsdf(b, outgoing, choice, u, draw.unit());
      ASSERT_TRUE(std::isfinite(s.weight.x + s.weight.y + s.weight.z + s.density)) << c.name << ", z " << o.z;
      ASSERT_GE(std::min({s.weight.x, s.weight.y, s.weight.z}), 0.0f) << c.name;
      ASSERT_GE(s.density, 0.0f) << c.name;
    }
  }
  EXPECT_LE(double(far), 2e-3 * double(count));
}

}  // namespace
}  // namespace fragtrace
