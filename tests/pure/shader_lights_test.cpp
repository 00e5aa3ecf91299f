// SPDX-License-Identifier: MIT
// shaders/lights.glsl over a scene as src/pack packs it: which emitters are chosen, where on them, and with
// what density.
#include <algorithm>

#include <gtest/gtest.h>

#include "shader_lights.h"

namespace fragtrace {
namespace {

constexpr double kLimit = 4.5;  // standard errors: a chance of 7e-6 a comparison

const dvec3 kOrigin(0.0);

/// Triangles of octantScene that emit and have an area.
constexpr size_t kEmissive = 6;

TEST(ShaderLights, TrianglesAreChosenByPowerAndPointsUniformlyByArea) {
  constexpr int kSamples = 1 << 19;
  constexpr size_t kSide = 8;
  constexpr size_t kCells = kSide * kSide * 2;
  const Lit lit(octantScene());
  ASSERT_EQ(lit.packed.emitterCount, kEmissive);
  const size_t triangles = lit.scene.triangles.size();
  std::vector<double> powers(triangles);
  double power = 0.0;
  for (size_t i = 0; i < triangles; ++i) power += powers[i] = lit.areaOf(i) * luminanceOf(lit.radianceOf(i));

  std::vector<double> chosen(triangles);
  std::vector<double> cells(triangles * kCells);
  Draw draw(173);
  for (int k = 0; k < kSamples; ++k) {
    const uint32_t first = draw.engine();
    const auto s = glsl_float::emitterLight(1.0f, vec3(0.0f), uvec2(first, draw.engine()), false, 0.0f);
    ASSERT_GT(s.pdf, 0.0f);
    ASSERT_NEAR(glm::length(dvec3(s.direction)), 1.0, 1e-6);
    const auto place = lit.placeOf(dvec3(s.direction) * double(s.distance));
    ASSERT_TRUE(place);
    ++chosen[place->triangle];
    // Cells of equal area: squares of the weights' plane, cut by their diagonals.
    const dvec2 w = glm::clamp(place->weights, 0.0, 1.0 - 1e-9) * double(kSide);
    const glm::uvec2 cell(w);
    const bool upper = glm::fract(w.x) + glm::fract(w.y) >= 1.0;
    ++cells[place->triangle * kCells + (cell.y * kSide + cell.x) * 2 + (upper ? 1 : 0)];
  }

  std::vector<double> expectedChosen(triangles);
  std::vector<double> expectedCells(cells.size());
  for (size_t i = 0; i < triangles; ++i) {
    expectedChosen[i] = kSamples * powers[i] / power;
    for (size_t y = 0; y < kSide; ++y) {
      for (size_t x = 0; x + y < kSide; ++x) {
        const size_t at = i * kCells + (y * kSide + x) * 2;
        expectedCells[at] = expectedChosen[i] / (kSide * kSide);
        if (x + y + 1 < kSide) expectedCells[at + 1] = expectedCells[at];
      }
    }
  }
  EXPECT_GT(chiSquareChance(expectedChosen, chosen), kSignificance / 2.0);
  EXPECT_GT(chiSquareChance(expectedCells, cells), kSignificance / 2.0);
}

TEST(ShaderLights, DensityOfASampleIsThatOfTheRayThatFindsIt) {
  for (bool environment : {false, true}) {
    const Lit lit(octantScene(), environment);
    const float share = 1.0f - glsl_variant::frame.environmentChance;
    Draw draw(179);
    for (int k = 0; k < 20000; ++k) {
      const dvec3 point = draw.inCube(0.15);
      const uvec2 bits{uint32_t(draw.engine()), uint32_t(draw.engine())};
      const auto s = glsl_double::emitterLight(share, point, bits, false, 0.0f);
      ASSERT_GT(s.pdf, 0.0);
      const auto place = lit.placeOf(point + s.direction * s.distance);
      ASSERT_TRUE(place);
      // This is the weight that shaders/path.glsl gives to emission that a ray hits.
      const double cosine = std::abs(glm::dot(lit.normalOf(place->triangle), s.direction));
      const uint32_t material = lit.scene.triangles[place->triangle].material;
      EXPECT_NEAR(glsl_double::emitterPdf(material, s.distance, cosine), s.pdf, 1e-6 * s.pdf);
      EXPECT_LE(glm::distance(s.irradiance * s.pdf, lit.radianceOf(place->triangle)),
                1e-6 * glm::length(lit.radianceOf(place->triangle)));
      const auto rounded = glsl_float::emitterLight(share, vec3(point), bits, false, 0.0f);
      EXPECT_NEAR(rounded.pdf, s.pdf, 3e-5 * s.pdf);
      EXPECT_LE(glm::distance(dvec3(rounded.direction), s.direction), 2e-6);
    }
  }
}

/// The density of light samples in one direction, by the triangle that a ray from the point hits first.
double pdfAlong(const Lit& lit, const dvec3& point, const dvec3& direction) {
  const auto shear = glsl_double::makeShear(direction);
  double nearest = 1e30;
  double pdf = 0.0;
  for (size_t i = 0; i < lit.scene.triangles.size(); ++i) {
    if (!lit.shines(i)) continue;
    const auto [a, b, c] = cornersOf<dvec3>(lit.scene, lit.scene.triangles[i]);
    const auto hit = glsl_double::intersectTriangle(point, shear, a, b, c);
    if (!hit.hit || hit.t <= 0.0 || hit.t >= nearest) continue;
    nearest = hit.t;
    pdf = glsl_double::emitterPdf(lit.scene.triangles[i].material, hit.t,
                                  std::abs(glm::dot(lit.normalOf(i), direction)));
  }
  return pdf;
}

TEST(ShaderLights, DensityIntegratesToOneOverAllDirectionsFromWhereAllFrontsAreSeen) {
  const Lit lit(octantScene());
  constexpr int kBands = 700;
  constexpr int kTurns = 1400;
  for (const dvec3& point : {dvec3(0.0), dvec3(0.05, -0.03, 0.04)}) {
    double sum = 0.0;
    for (int j = 0; j < kBands; ++j) {
      const double z = 1.0 - 2.0 * (j + 0.5) / kBands;
      for (int i = 0; i < kTurns; ++i) {
        const double phi = 2.0 * M_PI * (i + 0.5) / kTurns;
        const double r = std::sqrt(1.0 - z * z);
        sum += pdfAlong(lit, point, dvec3(r * std::cos(phi), r * std::sin(phi), z));
      }
    }
    // Edges of triangles cut through the lattice's cells.
    EXPECT_NEAR(sum * 4.0 * M_PI / (double(kBands) * kTurns), 1.0, 2e-3);
  }
}

TEST(ShaderLights, OnlyDoubleSidedTrianglesShineBackwards) {
  const Lit lit(octantScene());
  std::vector<double> lights(lit.scene.materials.size());
  Draw draw(181);
  int emitter = 0;
  for (size_t i = 0; i < lit.scene.triangles.size(); ++i) {
    if (!lit.shines(i)) continue;
    const auto [a, b, c] = cornersOf<dvec3>(lit.scene, lit.scene.triangles[i]);
    const dvec3 behind = (a + b + c) / 3.0 - 2.0 * lit.normalOf(i);
    for (int k = 0; k < 100; ++k) {
      const double u = draw.unit();
      const auto s = glsl_double::triangleLight(emitter, 0.5, behind, u, draw.unit(), 0.0);
      EXPECT_EQ(s.pdf > 0.0, lit.scene.triangles[i].material == 0);
      EXPECT_EQ(luminanceOf(s.irradiance) > 0.0, lit.scene.triangles[i].material == 0);
      lights[lit.scene.triangles[i].material] += 1.0;
    }
    ++emitter;
  }
  EXPECT_GT(lights[0], 0.0);
  EXPECT_GT(lights[1], 0.0);
}

TEST(ShaderLights, APointOnTheTriangleItselfGetsNothingThatIsNotFinite) {
  const Lit lit(octantScene());
  int emitter = -1;
  for (size_t triangle = 0; triangle < lit.scene.triangles.size(); ++triangle) {
    if (!lit.shines(triangle)) continue;
    ++emitter;
    const auto corners = cornersOf<dvec3>(lit.scene, lit.scene.triangles[triangle]);
    for (const vec3& point : {vec3(corners[0]), vec3((corners[0] + corners[1]) * 0.5)}) {
      for (float u : {0.0f, 0.5f, 0x1.fffffep-1f}) {
        for (float v : {0.0f, 0.5f, 0x1.fffffep-1f}) {
          const auto s = glsl_float::triangleLight(emitter, 0.3f, point, u, v, 0.0f);
          EXPECT_TRUE(std::isfinite(s.irradiance.x + s.irradiance.y + s.irradiance.z + s.pdf));
        }
      }
    }
  }
}

// ---- what a light sample brings, on average ----

/// Irradiance on a surface that faces every light: of the triangles, seen from the origin.
double trianglesAtOrigin(const Lit& lit) {
  double sum = 0.0;
  for (size_t i = 0; i < lit.scene.triangles.size(); ++i) {
    if (!lit.shines(i)) continue;
    const auto [a, b, c] = cornersOf<dvec3>(lit.scene, lit.scene.triangles[i]);
    sum += luminanceOf(lit.radianceOf(i)) * solidAngle(a, b, c);
  }
  return sum;
}

/// KHR_lights_punctual, written down a second time, at the origin.
dvec3 punctualAtOrigin(const Light& light) {
  const dvec3 intensity(light.intensity);
  if (light.type == LightType::Directional) return intensity;
  const double d = glm::length(dvec3(light.position));
  double factor = 1.0 / (d * d);
  if (std::isfinite(light.range)) factor *= std::clamp(1.0 - std::pow(d / light.range, 4.0), 0.0, 1.0);
  if (light.type == LightType::Spot) {
    const double inner = std::cos(double(light.innerConeAngle));
    const double outer = std::cos(double(light.outerConeAngle));
    const double cosine =
        glm::dot(glm::normalize(dvec3(light.direction)), -glm::normalize(dvec3(light.position)));
    factor *= std::pow(std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0), 2.0);
  }
  return intensity * factor;
}

double punctualsAtOrigin(const Lit& lit) {
  double sum = 0.0;
  for (const Light& light : lit.scene.lights) sum += luminanceOf(punctualAtOrigin(light));
  return sum;
}

double environmentAllAround() {
  constexpr int kSteps = 400;
  double sum = 0.0;
  for (int j = 0; j < kSteps; ++j) {
    const double v = (j + 0.5) / kSteps;
    for (int i = 0; i < 2 * kSteps; ++i) {
      const dvec3 d = glsl_double::environmentDirection(dvec2((i + 0.5) / (2 * kSteps), v));
      sum += luminanceOf(dvec3(glsl_double::environmentAlong(d))) * std::sin(M_PI * v);
    }
  }
  return sum * 2.0 * M_PI * M_PI / (2.0 * kSteps * kSteps);
}

Scene litScene() {
  Scene scene = octantScene();
  scene.lights = threeLights();
  return scene;
}

TEST(ShaderLights, PunctualLightsAreThoseOfTheirSpecification) {
  const Lit lit(litScene());
  for (size_t i = 0; i < lit.scene.lights.size(); ++i) {
    const Light& light = lit.scene.lights[i];
    const auto s = glsl_double::punctualLight(int(i), kOrigin);
    const dvec3 expected = punctualAtOrigin(light);
    EXPECT_GT(expected.x, 0.0) << "light " << i;
    EXPECT_LE(glm::distance(s.irradiance, expected), 2e-6 * glm::length(expected)) << "light " << i;
    EXPECT_EQ(s.pdf, 0.0) << "light " << i;
    const bool far = light.type == LightType::Directional;
    const dvec3 towards = far ? -dvec3(light.direction) : glm::normalize(dvec3(light.position));
    EXPECT_LE(glm::distance(s.direction, towards), 1e-7) << "light " << i;
    EXPECT_NEAR(s.distance, far ? glsl_double::kFarAway : glm::length(dvec3(light.position)),
                1e-7 * s.distance);
  }
  // Beyond its range, and outside its cone, the spot gives nothing.
  const vec3 axis = lit.scene.lights[1].direction;
  const vec3 place = lit.scene.lights[1].position;
  EXPECT_GT(glsl_float::punctualLight(1, place + 2.9f * axis).irradiance.x, 0.0f);
  EXPECT_EQ(glsl_float::punctualLight(1, place + 3.1f * axis).irradiance, vec3(0.0f));
  EXPECT_EQ(glsl_float::punctualLight(1, place - 1.0f * axis).irradiance, vec3(0.0f));
  EXPECT_EQ(glsl_float::punctualLight(1, place).irradiance, vec3(0.0f));
}

TEST(ShaderLights, ASampleOfAnEmitterBringsOnAverageWhatAllDo) {
  constexpr int kSamples = 1 << 17;
  const Lit lit(litScene());
  Estimate all;
  Estimate triangles;
  Draw draw(191);
  for (int k = 0; k < kSamples; ++k) {
    const uvec2 bits{uint32_t(draw.engine()), uint32_t(draw.engine())};
    all.add(luminanceOf(glsl_double::emitterLight(1.0, kOrigin, bits, false, 0.0f).irradiance));
    triangles.add(luminanceOf(glsl_double::emitterLight(1.0, kOrigin, bits, true, 0.0f).irradiance));
  }
  const double exact = trianglesAtOrigin(lit);
  EXPECT_LE(all.error(), 0.01 * exact);
  EXPECT_LE(std::abs(triangles.mean() - exact), kLimit * triangles.error());
  EXPECT_LE(std::abs(all.mean() - exact - punctualsAtOrigin(lit)), kLimit * all.error());
}

TEST(ShaderLights, OneSampleOfAllLightsAndTheEnvironmentIsUnbiased) {
  constexpr uint32_t kSamples = 1 << 17;
  const With independent(glsl_variant::kSobol, false);
  const Lit lit(litScene(), true);
  ASSERT_GT(environmentChance(lit.packed.lightShare, 1.0), 0.1f);
  ASSERT_LT(environmentChance(lit.packed.lightShare, 1.0), 0.9f);
  ASSERT_EQ(glsl_double::lightSampleCount(), 1);
  Estimate estimate;
  for (uint32_t k = 0; k < kSamples; ++k) {
    const auto sampler = glsl_double::makeSampler(glsl_double::pixelKey(11, 13, 17), k);
    estimate.add(luminanceOf(glsl_double::sampleLight(0, kOrigin, layout::kNoNormal, sampler, 5).irradiance));
  }
  const double exact = trianglesAtOrigin(lit) + punctualsAtOrigin(lit) + environmentAllAround();
  EXPECT_LE(estimate.error(), 0.01 * exact);
  EXPECT_LE(std::abs(estimate.mean() - exact), kLimit * estimate.error());
}

TEST(ShaderLights, BeforeGlobalIlluminationEverySampleIsOfALightOfItsOwn) {
  constexpr uint32_t kSamples = 1 << 15;
  const With local(glsl_variant::kGi, false);
  const With independent(glsl_variant::kSobol, false);
  const Lit lit(litScene(), true);
  ASSERT_EQ(glsl_double::lightSampleCount(), 4);  // three punctual lights, the triangles
  const double expected[] = {luminanceOf(punctualAtOrigin(lit.scene.lights[0])),
                             luminanceOf(punctualAtOrigin(lit.scene.lights[1])),
                             luminanceOf(punctualAtOrigin(lit.scene.lights[2])), trianglesAtOrigin(lit)};
  for (int index = 0; index < 4; ++index) {
    Estimate estimate;
    for (uint32_t k = 0; k < kSamples; ++k) {
      const auto sampler = glsl_double::makeSampler(glsl_double::pixelKey(11, 13, 17), k);
      estimate.add(
          luminanceOf(glsl_double::sampleLight(index, kOrigin, layout::kNoNormal, sampler, 5).irradiance));
    }
    EXPECT_LE(std::abs(estimate.mean() - expected[index]), kLimit * estimate.error() + 3e-5 * expected[index])
        << "light sample " << index;
  }
}

TEST(LightShare, FollowsTheIntensityOfTheEnvironment) {
  EXPECT_EQ(environmentChance({.samplesEnvironment = false}, 1.0), 0.0f);
  EXPECT_EQ(environmentChance({.samplesEnvironment = true, .environment = 0.0}, 1.0), 1.0f);
  const LightShare both{true, 1.0, 3.0, true};
  EXPECT_EQ(environmentChance(both, 1.0), 0.25f);
  EXPECT_EQ(environmentChance(both, 3.0), 0.5f);
  EXPECT_EQ(environmentChance(both, 0.0), 0.1f);
  EXPECT_EQ(environmentChance(both, 1e6), 0.9f);
  EXPECT_EQ(environmentChance({true, 0.0, 0.0, true}, 1.0), 0.5f);
}

TEST(LightShare, OfTheSunIsNothingByNightAndAllWithoutLamps) {
  EXPECT_EQ(sunChance({.samplesEnvironment = true, .environment = 1.0}, 1.0), 0.0f);
  EXPECT_EQ(sunChance({.samplesEnvironment = false, .sun = 1.0}, 1.0), 0.0f);
  EXPECT_EQ(sunChance({.samplesEnvironment = true, .sun = 1.0}, 0.5), 1.0f);
  const LightShare both{true, 5.0, 3.0, true, 1.0};
  EXPECT_EQ(sunChance(both, 1.0), 0.25f);
  EXPECT_EQ(sunChance(both, 0.0), 0.0f);
  EXPECT_EQ(sunChance(both, 1e6), 0.9f);
  EXPECT_EQ(sunChance(both, 1e-6), 0.1f);
}

}  // namespace
}  // namespace fragtrace
