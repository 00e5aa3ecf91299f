// SPDX-License-Identifier: MIT
// shaders/bsdf.glsl: values against formulas written down a second time, samples drawn in float against the
// density in double, reciprocity and energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "glsl.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::vec3;
using glsl_variant::With;

using Bsdf = glsl_double::Bsdf;

/// As makeBsdf of shaders/shade.glsl puts it together from metallic, transmission, roughness and index.
Bsdf makeBsdf(double metallic, double transmission, double roughness, double ior, bool solid, bool front) {
  Bsdf b;
  b.baseColor = dvec3(0.9, 0.6, 0.3);
  b.dielectricF0 = dvec3(std::pow((ior - 1.0) / (ior + 1.0), 2.0));
  b.dielectricF90 = 1.0;
  b.metal = metallic;
  b.glass = (1.0 - metallic) * transmission;
  b.opaque = 1.0 - b.metal - b.glass;
  b.alpha = roughness * roughness;
  b.mirrorLike = b.alpha < glsl_double::kMirrorAlpha;
  b.solid = solid;
  b.eta = front ? ior : 1.0 / ior;
  return glsl_double::compensate(b);
}

glsl_float::Bsdf toFloat(const Bsdf& b) {
  glsl_float::Bsdf f;
  f.baseColor = vec3(b.baseColor);
  f.dielectricF0 = vec3(b.dielectricF0);
  f.dielectricF90 = float(b.dielectricF90);
  f.metal = float(b.metal);
  f.opaque = float(b.opaque);
  f.glass = float(b.glass);
  f.alpha = float(b.alpha);
  f.mirrorLike = b.mirrorLike;
  f.solid = b.solid;
  f.eta = float(b.eta);
  f.between = vec3(b.between);
  return f;
}

struct Case {
  std::string name;
  Bsdf bsdf;
};

Bsdf lambert() {
  Bsdf b = makeBsdf(0, 0, 0.5, 1.5, false, true);
  b.dielectricF0 = dvec3(0.0);
  b.dielectricF90 = 0.0;
  return glsl_double::compensate(b);
}

std::vector<Case> opaqueCases() {
  Bsdf tinted = makeBsdf(0.0, 0.0, 0.4, 1.5, false, true);
  tinted.dielectricF0 = dvec3(0.4, 0.1, 0.0);
  tinted.dielectricF90 = 0.6;
  tinted = glsl_double::compensate(tinted);
  return {{"diffuse", lambert()},
          {"smooth metal", makeBsdf(1, 0, 0.3, 1.5, false, true)},
          {"rough metal", makeBsdf(1, 0, 0.8, 1.5, false, true)},
          {"plastic", makeBsdf(0, 0, 0.4, 1.5, false, true)},
          {"plastic half metal", makeBsdf(0.5, 0, 0.6, 1.8, false, true)},
          {"tinted plastic", tinted}};
}

std::vector<Case> glassCases() {
  return {{"rough glass from outside", makeBsdf(0, 1, 0.4, 1.5, true, true)},
          {"rough glass from inside", makeBsdf(0, 1, 0.4, 1.5, true, false)},
          {"very rough glass from outside", makeBsdf(0, 1, 0.8, 2.0, true, true)},
          {"very rough glass from inside", makeBsdf(0, 1, 0.8, 2.0, true, false)},
          {"thin glass from the front", makeBsdf(0, 1, 0.5, 1.5, false, true)},
          {"thin glass from the back", makeBsdf(0, 1, 0.5, 1.5, false, false)},
          {"half glass, half plastic", makeBsdf(0, 0.5, 0.5, 1.5, true, true)},
          {"glass, plastic and metal", makeBsdf(0.3, 0.5, 0.6, 1.5, false, true)}};
}

std::vector<Case> allCases() {
  std::vector<Case> cases = opaqueCases();
  for (const Case& c : glassCases()) cases.push_back(c);
  return cases;
}

dvec3 atElevation(double z) { return {std::sqrt(1.0 - z * z) * 0.6, std::sqrt(1.0 - z * z) * 0.8, z}; }

const std::vector<double> kElevations = {1.0, 0.7, 0.2};

size_t binOf(double x, size_t bins) { return std::min(size_t(std::max(0.0, x) * double(bins)), bins - 1); }

constexpr size_t kBands = 36;  // over the whole sphere, of equal angle
constexpr size_t kTurns = 24;

/// Integrals of f, a number or a vector, over the bins of the sphere.
template <typename Function>
auto integrateBins(Function f) {
  constexpr int kInner = 12;
  constexpr double kStepTheta = M_PI / (kBands * kInner);
  constexpr double kStepPhi = 2.0 * M_PI / (kTurns * kInner);
  std::vector<decltype(f(dvec3()))> bins(kBands * kTurns);
  for (size_t band = 0; band < kBands * kInner; ++band) {
    // Gauss's rule of two points a step: midpoints would be 0.2 % off in narrow lobes about the pole.
    const double side = band % 2 == 0 ? 1.0 - std::sqrt(1.0 / 3.0) : std::sqrt(1.0 / 3.0);
    const double theta = kStepTheta * (double(band) + side);
    const double r = std::sin(theta);
    for (size_t turn = 0; turn < kTurns * kInner; ++turn) {
      const double phi = kStepPhi * (double(turn) + 0.5) - M_PI;
      const dvec3 direction(r * std::cos(phi), r * std::sin(phi), std::cos(theta));
      bins[band / kInner * kTurns + turn / kInner] += r * kStepTheta * kStepPhi * f(direction);
    }
  }
  return bins;
}

size_t binOfDirection(const dvec3& d) {
  return binOf(std::acos(std::clamp(d.z, -1.0, 1.0)) / M_PI, kBands) * kTurns +
         binOf(std::atan2(d.y, d.x) / (2.0 * M_PI) + 0.5, kTurns);
}

template <typename Value>
Value total(const std::vector<Value>& values) {
  Value sum(0.0);
  for (const Value& v : values) sum += v;
  return sum;
}

/// Draws directions in float and compares their histogram with the density in double. Facets that send light
/// to the wrong side lose their samples (weight 0): these are counted in a bin of their own, where the
/// density's integral must leave just that much.
void expectSamplesFollowTheDensity(const Case& c, double elevation, size_t tests) {
  constexpr int kSamples = 1 << 17;
  const dvec3 outgoing = atElevation(elevation);
  std::vector<double> expected =
      integrateBins([&](const dvec3& i) { return glsl_double::evaluateBsdf(c.bsdf, outgoing, i).density; });
  expected.push_back(std::max(0.0, 1.0 - total(expected)));
  for (double& e : expected) e *= kSamples;
  std::vector<double> counts(expected.size());
  Draw draw(17);
  const glsl_float::Bsdf b = toFloat(c.bsdf);
  for (int k = 0; k < kSamples; ++k) {
    const float choice = draw.unit();
    const float u = draw.unit();
    const auto s = glsl_float::sampleBsdf(b, vec3(outgoing), choice, u, draw.unit());
    if (s.density <= 0.0f) {
      ASSERT_EQ(s.weight, vec3(0.0f));
      ++counts.back();
      continue;
    }
    ASSERT_NEAR(glm::length(dvec3(s.incoming)), 1.0, 1e-5);
    ASSERT_EQ(s.transmitted, s.incoming.z < 0.0f);
    ++counts[binOfDirection(dvec3(s.incoming))];
  }
  EXPECT_GT(chiSquareChance(expected, counts), kSignificance / double(tests))
      << c.name << ", elevation " << elevation << ": lost " << counts.back() / kSamples << ", expected "
      << expected.back() / kSamples;
}

TEST(ShaderBsdf, SamplesOfOpaqueMaterialsFollowTheirDensity) {
  for (const Case& c : opaqueCases()) {
    for (double z : kElevations)
      expectSamplesFollowTheDensity(c, z, opaqueCases().size() * kElevations.size());
  }
}

TEST(ShaderBsdf, SamplesOfGlassFollowTheirDensity) {
  for (const Case& c : glassCases()) {
    for (double z : kElevations)
      expectSamplesFollowTheDensity(c, z, glassCases().size() * kElevations.size());
  }
}

TEST(ShaderBsdf, SamplesOfGlassFollowTheirDensityWithSchlick) {
  const With schlick(glsl_variant::kSchlick, true);
  for (const Case& c : glassCases()) {
    for (double z : kElevations)
      expectSamplesFollowTheDensity(c, z, glassCases().size() * kElevations.size());
  }
}

TEST(ShaderBsdf, SamplesWithoutASpecularLobeFollowTheirDensity) {
  const With specular(glsl_variant::kSpecular, false);
  const With transmission(glsl_variant::kTransmission, false);
  expectSamplesFollowTheDensity({"diffuse", lambert()}, 0.5, 1);
}

TEST(ShaderBsdf, DiffuseDensityIntegratesToOne) {
  for (double z : kElevations) {
    const dvec3 o = atElevation(z);
    EXPECT_NEAR(total(integrateBins(
                    [&](const dvec3& i) { return glsl_double::evaluateBsdf(lambert(), o, i).density; })),
                1.0, 1e-5);
  }
}

TEST(ShaderBsdf, DensitiesIntegrateToAtMostOneAndToOneWhereNoFacetLosesLight) {
  // How much facets lose is checked above, by counting.
  for (const Case& c : allCases()) {
    for (double z : kElevations) {
      const dvec3 o = atElevation(z);
      const double sum = total(
          integrateBins([&](const dvec3& i) { return glsl_double::evaluateBsdf(c.bsdf, o, i).density; }));
      EXPECT_LE(sum, 1.0 + 1e-3) << c.name << ", elevation " << z;
      if (c.bsdf.alpha < 0.1 && z > 0.5) {
        EXPECT_GE(sum, 0.99) << c.name << ", elevation " << z;
      }
    }
  }
}

TEST(ShaderBsdf, WeightIsTheValueOverTheDensity) {
  for (const Case& c : allCases()) {
    Draw draw(23);
    for (int k = 0; k < 3000; ++k) {
      const dvec3 o = draw.directionAbove();
      const double choice = draw.unit();
      const double u = draw.unit();
      const auto s = glsl_double::sampleBsdf(c.bsdf, o, choice, u, draw.unit());
      if (s.density == 0.0) continue;
      const auto v = glsl_double::evaluateBsdf(c.bsdf, o, s.incoming);
      EXPECT_NEAR(v.density, s.density, 1e-9 * s.density) << c.name;
      EXPECT_LE(glm::distance(s.weight * s.density, v.value), 1e-9 * glm::length(v.value)) << c.name;
    }
  }
}

TEST(ShaderBsdf, DiffuseSamplesWeighTheBaseColour) {
  Draw draw(29);
  for (int k = 0; k < 1000; ++k) {
    const dvec3 o = draw.directionAbove();
    const double u = draw.unit();
    const auto s = glsl_double::sampleBsdf(lambert(), o, draw.unit(), u, draw.unit());
    EXPECT_LE(glm::distance(s.weight, lambert().baseColor), 1e-12);
  }
}

// ---- values, by formulas written down a second time ----

/// glTF 2.0, appendix B.3.2: D, and V with the height-correlated Smith term.
double specularBrdf(const dvec3& o, const dvec3& i, double alpha) {
  const dvec3 h = glm::normalize(o + i);
  const double a2 = alpha * alpha;
  const double f = h.z * h.z * (a2 - 1.0) + 1.0;
  const double d = a2 / (M_PI * f * f);
  const double v =
      0.5 / (i.z * std::sqrt(o.z * o.z * (1.0 - a2) + a2) + o.z * std::sqrt(i.z * i.z * (1.0 - a2) + a2));
  return d * v;
}

dvec3 schlick(const dvec3& f0, double f90, double cosine) {
  return f0 + (dvec3(f90) - f0) * std::pow(1.0 - cosine, 5.0);
}

TEST(ShaderBsdf, OpaqueValuesAreThoseOfTheGltfSpecification) {
  for (const Case& c : opaqueCases()) {
    const Bsdf& b = c.bsdf;
    Draw draw(31);
    for (int k = 0; k < 3000; ++k) {
      const dvec3 o = draw.directionAbove();
      const dvec3 i = draw.directionAbove();
      const double oh = glm::dot(o, glm::normalize(o + i));
      const dvec3 dielectric = schlick(b.dielectricF0, b.dielectricF90, oh);
      const double through = 1.0 - std::max({dielectric.x, dielectric.y, dielectric.z});
      const dvec3 metal = schlick(b.baseColor, 1.0, oh) * specularBrdf(o, i, b.alpha);
      const dvec3 plastic = b.baseColor / M_PI * through + dielectric * specularBrdf(o, i, b.alpha);
      const dvec3 expected = i.z * (b.metal * metal + b.opaque * plastic);
      const dvec3 value = glsl_double::evaluateBsdf(b, o, i).value;
      EXPECT_LE(glm::distance(value, expected), 1e-9 * glm::length(expected)) << c.name;
    }
  }
}

double fresnelExact(double cosine, double eta) {
  const double refracted2 = 1.0 - (1.0 - cosine * cosine) / (eta * eta);
  if (refracted2 <= 0.0) return 1.0;
  const double refracted = std::sqrt(refracted2);
  const double s = (cosine - eta * refracted) / (cosine + eta * refracted);
  const double p = (refracted - eta * cosine) / (refracted + eta * cosine);
  return 0.5 * (s * s + p * p);
}

double smithLambda(const dvec3& v, double alpha) {
  const double tangent2 = (1.0 - v.z * v.z) / (v.z * v.z);
  return 0.5 * (std::sqrt(1.0 + alpha * alpha * tangent2) - 1.0);
}

TEST(ShaderBsdf, RoughGlassValuesAreThoseOfWalter) {
  // Walter et al. 2007, equations 20 and 21, with the height-correlated Smith term, for radiance (divided by
  // eta^2).
  size_t refracted = 0;
  for (bool front : {true, false}) {
    const Bsdf b = makeBsdf(0, 1, 0.6, 1.5, true, front);
    Draw draw(37);
    for (int k = 0; k < 5000; ++k) {
      const dvec3 o = draw.directionAbove();
      const dvec3 i = draw.direction();
      const auto value = glsl_double::evaluateBsdf(b, o, i);
      const double g =
          1.0 / (1.0 + smithLambda(o, b.alpha) + smithLambda(dvec3(i.x, i.y, std::abs(i.z)), b.alpha));
      dvec3 expected(0.0);
      if (i.z > 0.0) {
        const double oh = glm::dot(o, glm::normalize(o + i));
        // specularBrdf holds G / (4 o.z i.z).
        expected = dvec3(fresnelExact(oh, b.eta) * specularBrdf(o, i, b.alpha) * i.z);
      } else {
        // Index on the side of o: 1, on the side of i: eta.
        dvec3 h = -glm::normalize(o + b.eta * i);
        if (h.z < 0.0) h = -h;
        const double oh = glm::dot(o, h);
        const double ih = glm::dot(i, h);
        if (oh > 0.0 && ih < 0.0) {
          const double a2 = b.alpha * b.alpha;
          const double f = h.z * h.z * (a2 - 1.0) + 1.0;
          const double d = a2 / (M_PI * f * f);
          const double jacobian =
              std::abs(oh * ih / (o.z * i.z)) * b.eta * b.eta / std::pow(oh + b.eta * ih, 2.0);
          expected =
              b.baseColor * (jacobian * (1.0 - fresnelExact(oh, b.eta)) * g * d * -i.z / (b.eta * b.eta));
          if (expected.x > 0.0) ++refracted;
        }
      }
      EXPECT_LE(glm::distance(value.value, expected), 1e-8 * glm::length(expected) + 1e-15);
    }
  }
  EXPECT_GT(refracted, 1000u);
}

TEST(ShaderBsdf, ThinGlassTransmitsTheMirrorImageOfWhatItReflects) {
  const Bsdf b = makeBsdf(0, 1, 0.5, 1.5, false, true);
  Draw draw(41);
  for (int k = 0; k < 2000; ++k) {
    const dvec3 o = draw.directionAbove();
    const dvec3 i = draw.directionAbove();
    const double single = fresnelExact(glm::dot(o, glm::normalize(o + i)), 1.5);
    const double wall = 2.0 * single / (1.0 + single);
    const double lobe = specularBrdf(o, i, b.alpha) * i.z;
    EXPECT_LE(glm::distance(glsl_double::evaluateBsdf(b, o, i).value, dvec3(wall * lobe)), 1e-9 * lobe);
    EXPECT_LE(glm::distance(glsl_double::evaluateBsdf(b, o, dvec3(i.x, i.y, -i.z)).value,
                            b.baseColor * ((1.0 - wall) * lobe)),
              1e-9 * lobe);
  }
}

// ---- reciprocity and energy ----

TEST(ShaderBsdf, OpaqueMaterialsAreReciprocal) {
  for (const Case& c : opaqueCases()) {
    Draw draw(43);
    for (int k = 0; k < 3000; ++k) {
      const dvec3 o = draw.directionAbove();
      const dvec3 i = draw.directionAbove();
      const dvec3 there = glsl_double::evaluateBsdf(c.bsdf, o, i).value / i.z;
      const dvec3 back = glsl_double::evaluateBsdf(c.bsdf, i, o).value / o.z;
      EXPECT_LE(glm::distance(there, back), 1e-9 * glm::length(there)) << c.name;
    }
  }
}

TEST(ShaderBsdf, GlassIsReciprocalInRadianceOverTheSquaredIndex) {
  size_t transmitted = 0;
  for (bool schlickFresnel : {false, true}) {
    const With variant(glsl_variant::kSchlick, schlickFresnel);
    for (double transmission : {1.0, 0.6}) {
      const Bsdf outside = makeBsdf(0.0, transmission, 0.6, 1.5, true, true);
      const Bsdf inside = makeBsdf(0.0, transmission, 0.6, 1.5, true, false);
      Draw draw(47);
      for (int k = 0; k < 5000; ++k) {
        const dvec3 o = draw.directionAbove();
        const dvec3 i = -draw.directionAbove();
        const dvec3 there = glsl_double::evaluateBsdf(outside, o, i).value / -i.z;
        // The other way round, in the frame whose z points inwards: x and z turn.
        const dvec3 back =
            glsl_double::evaluateBsdf(inside, dvec3(-i.x, i.y, -i.z), dvec3(-o.x, o.y, -o.z)).value / o.z;
        EXPECT_LE(glm::distance(there * 1.5 * 1.5, back), 1e-8 * glm::length(back) + 1e-15);
        if (back.x > 0.0) ++transmitted;
      }
    }
  }
  EXPECT_GT(transmitted, 1000u);
}

TEST(ShaderBsdf, ThinGlassIsReciprocalFromBothSides) {
  const Bsdf front = makeBsdf(0.0, 1.0, 0.6, 1.5, false, true);
  const Bsdf back = makeBsdf(0.0, 1.0, 0.6, 1.5, false, false);
  Draw draw(53);
  for (int k = 0; k < 3000; ++k) {
    const dvec3 o = draw.directionAbove();
    const dvec3 i = draw.directionAbove();
    const dvec3 down(i.x, i.y, -i.z);
    EXPECT_LE(glm::distance(glsl_double::evaluateBsdf(front, o, i).value,
                            glsl_double::evaluateBsdf(back, o, i).value),
              1e-12);
    const dvec3 there = glsl_double::evaluateBsdf(front, o, down).value / i.z;
    const dvec3 again =
        glsl_double::evaluateBsdf(back, dvec3(i.x, i.y, i.z), dvec3(o.x, o.y, -o.z)).value / o.z;
    EXPECT_LE(glm::distance(there, again), 1e-9 * glm::length(there));
  }
}

/// The mean weight over a lattice of samples: what the surface sends back of white light from all around.
/// Radiance through a solid's boundary is scaled by 1 / eta^2, which is no energy, so it is scaled back.
dvec3 albedoByDrawing(const Bsdf& b, const dvec3& outgoing) {
  constexpr int kSide = 32;
  constexpr int kChoices = 32;
  dvec3 sum(0.0);
  for (int x = 0; x < kSide; ++x) {
    for (int y = 0; y < kSide; ++y) {
      const double shift = std::fmod((x * kSide + y) * 0.6180339887498949, 1.0);
      for (int c = 0; c < kChoices; ++c) {
        const auto s = glsl_double::sampleBsdf(b, outgoing, (c + shift) / kChoices, (x + 0.5) / kSide,
                                               (y + 0.5) / kSide);
        sum += s.weight * (s.transmitted && b.solid ? b.eta * b.eta : 1.0);
      }
    }
  }
  return sum / double(kSide * kSide * kChoices);
}

dvec3 albedoByIntegration(const Bsdf& b, const dvec3& outgoing) {
  return total(integrateBins([&](const dvec3& i) {
    const double scale = i.z < 0.0 && b.solid ? b.eta * b.eta : 1.0;
    return glsl_double::evaluateBsdf(b, outgoing, i).value * scale;
  }));
}

void expectUnbiasedWeights(const Case& c, double elevation) {
  const dvec3 drawn = albedoByDrawing(c.bsdf, atElevation(elevation));
  const dvec3 integrated = albedoByIntegration(c.bsdf, atElevation(elevation));
  EXPECT_LE(glm::distance(drawn, integrated), 0.01) << c.name << ", elevation " << elevation;
}

TEST(ShaderBsdf, MeanWeightIsTheIntegralOfTheValue) {
  for (const Case& c : allCases()) {
    for (double z : kElevations) expectUnbiasedWeights(c, z);
  }
}

TEST(ShaderBsdf, NoWhiteMetalOrGlassReturnsMoreThanItGets) {
  Draw draw(59);
  for (int k = 0; k < 150; ++k) {
    const double metallic = k % 3 == 0 ? 1.0 : draw.between(0.0, 1.0);
    Bsdf b = makeBsdf(metallic, 1.0, draw.between(0.0, 1.0), draw.between(1.0, 2.5), k % 2 == 0, k % 4 < 2);
    b.baseColor = dvec3(1.0);
    const dvec3 albedo = albedoByDrawing(b, draw.directionAbove());
    EXPECT_LE(albedo.x, 1.002) << "metallic " << metallic << ", alpha " << b.alpha << ", eta " << b.eta;
    EXPECT_GE(albedo.x, 0.3) << "metallic " << metallic << ", alpha " << b.alpha << ", eta " << b.eta;
  }
}

TEST(ShaderBsdf, WhiteDiffuseReturnsAllItGets) {
  Bsdf b = lambert();
  b.baseColor = dvec3(1.0);
  for (double z : kElevations) EXPECT_NEAR(albedoByDrawing(b, atElevation(z)).x, 1.0, 1e-12);
}

TEST(ShaderBsdf, WhitePlasticGainsEnergyOnlyTowardsGrazing) {
  // glTF's fresnel_mix weighs the diffuse base by the Fresnel term of the half vector alone, so light that
  // grazes is reflected by the layer and still reaches most of the base: the specification's own gain.
  for (double roughness : {0.05, 0.1, 0.3, 0.6, 1.0}) {
    for (double z : {1.0, 0.8, 0.6, 0.4, 0.2, 0.1, 0.01}) {
      Bsdf b = makeBsdf(0, 0, roughness, 1.5, false, true);
      b.baseColor = dvec3(1.0);
      EXPECT_LE(albedoByDrawing(b, atElevation(z)).x, z >= 0.6 ? 1.02 : 1.9)
          << "roughness " << roughness << ", z " << z;
    }
  }
}

TEST(ShaderBsdf, SmoothWhiteGlassAndMetalReturnAllTheyGet) {
  Draw draw(61);
  for (int k = 0; k < 40; ++k) {
    for (double transmission : {0.0, 1.0}) {
      Bsdf b = makeBsdf(1.0 - transmission, transmission, 0.02, 1.5, k % 2 == 0, k % 4 < 2);
      ASSERT_TRUE(b.mirrorLike);
      b.baseColor = dvec3(1.0);
      EXPECT_LE(glm::distance(albedoByDrawing(b, draw.directionAbove()), dvec3(1.0)), 1e-9);
    }
  }
}

TEST(ShaderBsdf, LobeChancesAddUpToOne) {
  for (const Case& c : allCases()) {
    for (double cosine : {1.0, 0.5, 0.01}) {
      const dvec3 chances = glsl_double::lobeChances(c.bsdf, cosine);
      EXPECT_NEAR(chances.x + chances.y + chances.z, 1.0, 1e-14);
      EXPECT_GE(std::min({chances.x, chances.y, chances.z}), 0.0);
      EXPECT_NEAR(chances.x, c.bsdf.glass, 1e-14);
    }
  }
}

// ---- compensation of what single scattering loses (more in ggx_energy_test.cpp) ----

TEST(ShaderBsdf, CompensatedSamplesFollowTheirDensity) {
  const With compensation(glsl_variant::kCompensation, true);
  for (const Case& c : allCases()) {
    for (double z : kElevations) expectSamplesFollowTheDensity(c, z, allCases().size() * kElevations.size());
  }
}

TEST(ShaderBsdf, CompensatedMeanWeightIsTheIntegralOfTheValue) {
  const With compensation(glsl_variant::kCompensation, true);
  for (const Case& c : allCases()) {
    for (double z : kElevations) expectUnbiasedWeights(c, z);
  }
}

// ---- single directions ----

TEST(ShaderBsdf, SmoothGlassReflectsWithTheChanceOfItsReflectance) {
  for (bool solid : {true, false}) {
    for (bool front : {true, false}) {
      const Bsdf b = makeBsdf(0, 1, 0.0, 1.5, solid, front);
      for (double z : {1.0, 0.9, 0.7, 0.3}) {
        const dvec3 o = atElevation(z);
        const double single = fresnelExact(z, solid ? b.eta : 1.5);
        const double reflectance = solid ? single : 2.0 * single / (1.0 + single);
        constexpr int kChoices = 10000;
        int reflected = 0;
        for (int k = 0; k < kChoices; ++k) {
          const auto s = glsl_double::sampleBsdf(b, o, (k + 0.5) / kChoices, 0.3, 0.6);
          EXPECT_EQ(s.density, 0.0);
          if (s.transmitted) {
            EXPECT_LT(s.incoming.z, 0.0);
            EXPECT_LE(glm::distance(s.weight, b.baseColor / (solid ? b.eta * b.eta : 1.0)), 1e-12);
            const double bend = solid ? b.eta : 1.0;
            EXPECT_LE(glm::distance(glm::dvec2(s.incoming) * bend, -glm::dvec2(o)), 1e-12);
          } else {
            ++reflected;
            EXPECT_EQ(s.weight, dvec3(1.0));
            EXPECT_LE(glm::distance(s.incoming, dvec3(-o.x, -o.y, o.z)), 1e-14);
          }
        }
        EXPECT_NEAR(double(reflected) / kChoices, reflectance, 1.5 / kChoices);
      }
    }
  }
}

TEST(ShaderBsdf, SmoothMetalReflectsSchlicksShare) {
  const Bsdf b = makeBsdf(1, 0, 0.0, 1.5, false, true);
  for (double z : {1.0, 0.5, 0.1}) {
    const auto s = glsl_double::sampleBsdf(b, atElevation(z), 0.4, 0.3, 0.6);
    EXPECT_EQ(s.density, 0.0);
    EXPECT_LE(glm::distance(s.weight, schlick(b.baseColor, 1.0, z)), 1e-12);
  }
}

TEST(ShaderBsdf, SmoothPlasticReflectsSchlicksShareAndTheRestOfItsBase) {
  for (double metallic : {0.0, 0.3}) {
    const Bsdf b = makeBsdf(metallic, 0, 0.0, 1.5, false, true);
    for (double z : {1.0, 0.5, 0.2}) {
      const dvec3 mirrored =
          b.metal * schlick(b.baseColor, 1.0, z) + b.opaque * schlick(b.dielectricF0, b.dielectricF90, z);
      const dvec3 expected = mirrored + albedoByIntegration(b, atElevation(z));
      EXPECT_LE(glm::distance(albedoByDrawing(b, atElevation(z)), expected), 2e-3) << "elevation " << z;
    }
  }
}

TEST(ShaderBsdf, SmoothLobesHaveNoValueInAnyDirection) {
  Draw draw(67);
  const Bsdf metal = makeBsdf(1, 0, 0.0, 1.5, false, true);
  const Bsdf glass = makeBsdf(0, 1, 0.0, 1.5, true, true);
  for (int k = 0; k < 1000; ++k) {
    const dvec3 o = draw.directionAbove();
    const dvec3 i = draw.direction();
    EXPECT_EQ(glsl_double::evaluateBsdf(metal, o, i).value, dvec3(0.0));
    EXPECT_EQ(glsl_double::evaluateBsdf(glass, o, i).value, dvec3(0.0));
    EXPECT_EQ(glsl_double::evaluateBsdf(glass, o, i).density, 0.0);
  }
}

// ---- float ----

TEST(ShaderBsdf, FloatValuesAreFiniteAndNearDouble) {
  size_t far = 0;
  size_t count = 0;
  for (const Case& c : allCases()) {
    const glsl_float::Bsdf b = toFloat(c.bsdf);
    Draw draw(71);
    for (int k = 0; k < 20000; ++k) {
      dvec3 o = draw.directionAbove();
      if (k % 8 == 0) o = glm::normalize(dvec3(o.x, o.y, o.z * 1e-4));
      const vec3 outgoing(o);
      const vec3 incoming(draw.direction());
      const auto value = glsl_float::evaluateBsdf(b, outgoing, incoming);
      const auto expected = glsl_double::evaluateBsdf(c.bsdf, dvec3(outgoing), dvec3(incoming));
      ASSERT_TRUE(std::isfinite(value.value.x + value.value.y + value.value.z + value.density)) << c.name;
      ASSERT_GE(std::min({value.value.x, value.value.y, value.value.z, value.density}), 0.0f) << c.name;
      ++count;
      // Near the edge of what refraction can reach, the half vector's side is decided by rounding.
      if (glm::distance(dvec3(value.value), expected.value) > 2e-3 * glm::length(expected.value) + 1e-6)
        ++far;
    }
  }
  EXPECT_LE(double(far), 1e-3 * double(count));
}

TEST(ShaderBsdf, FloatSamplesAreFiniteAtGrazingDirections) {
  for (const Case& c : allCases()) {
    for (double roughness : {0.0, 0.04, 0.2, 1.0}) {
      glsl_float::Bsdf b = toFloat(c.bsdf);
      b.alpha = float(roughness * roughness);
      b.mirrorLike = b.alpha < glsl_float::kMirrorAlpha;
      Draw draw(73);
      for (int k = 0; k < 4000; ++k) {
        const double z = std::pow(10.0, draw.between(-7.0, 0.0));
        const vec3 o(atElevation(z));
        const float choice = draw.unit();
        const float u = draw.unit();
        const auto s = glsl_float::sampleBsdf(b, o, choice, u, draw.unit());
        ASSERT_TRUE(std::isfinite(s.weight.x + s.weight.y + s.weight.z + s.density)) << c.name << ", z " << z;
        ASSERT_GE(std::min({s.weight.x, s.weight.y, s.weight.z}), 0.0f) << c.name << ", z " << z;
        ASSERT_NEAR(glm::length(dvec3(s.incoming)), 1.0, 1e-3) << c.name << ", z " << z;
      }
    }
  }
}

}  // namespace
}  // namespace fragtrace
