// SPDX-License-Identifier: MIT
// shaders/environment.glsl over maps as src/pack/pack_lights.cpp packs them: what is seen, and how directions
// are drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "glsl_lights.h"
#include "pack/pack_environment.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::uvec2;
using glm::vec3;
using glsl_variant::With;

constexpr int kWidth = 32;
constexpr int kHeight = 16;
constexpr double kTexelError = 1.0 / 4096.0;  // of the largest channel
constexpr double kTurn = 2.0 * M_PI / 9.0;    // 40 degrees: no whole number of texels
constexpr double kRotations[] = {0.0, kTurn};

/// The left half black, the rest uneven, one texel a thousand times as bright.
Image sunnyMap() {
  Image image;
  image.width = kWidth;
  image.height = kHeight;
  image.channels = {"R", "G", "B"};
  Draw draw(101);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double bright = x < kWidth / 2 ? 0.0 : x == 25 && y == 4 ? 1000.0 : 1.0;
      for (int c = 0; c < 3; ++c) image.values.push_back(float(bright * draw.between(0.2, 1.8)));
    }
  }
  return image;
}

/// The map as the shader reads it, turned by an angle, until the end of the scope.
class Surrounded {
 public:
  explicit Surrounded(const Image& image, double rotation, EnvironmentDraws draws = EnvironmentDraws::Light)
      : packed_(packEnvironment(image, draws)),
        texels_(glsl_variant::environment, packed_.texels),
        inversion_(glsl_variant::environmentInversion, packed_.inversion),
        frame_(glsl_variant::frame, frameOf(image, rotation)) {}

 private:
  static layout::Frame frameOf(const Image& image, double rotation) {
    layout::Frame frame{};
    frame.environmentScale = 1.0f;
    frame.environmentSize = {image.width, image.height};
    frame.environmentRotation = {std::cos(rotation), std::sin(rotation)};
    return frame;
  }

  PackedEnvironment packed_;
  With<std::span<const uint32_t>> texels_;
  With<std::span<const uint32_t>> inversion_;
  With<layout::Frame> frame_;
};

dvec3 radianceAlong(const dvec3& d) { return dvec3(glsl_double::environmentAlong(d)); }

double pdfAlong(const dvec3& d) { return glsl_double::environmentPdf(glsl_double::environmentAlong(d), d); }

/// docs/design/conventions.md: u from atan2(z, x), v from acos(y).
dvec3 directionAt(double u, double v) {
  const double phi = (u - 0.5) * 2.0 * M_PI;
  return {std::sin(v * M_PI) * std::cos(phi), std::cos(v * M_PI), std::sin(v * M_PI) * std::sin(phi)};
}

/// Counter-clockwise seen from +y.
dvec3 turned(const dvec3& d, double angle) {
  return {d.x * std::cos(angle) + d.z * std::sin(angle), d.y, d.z * std::cos(angle) - d.x * std::sin(angle)};
}

// The bins have equal angles about the world's axes. Their steps meet the edges of all texels, at rotations
// of 0 and of 40 degrees. The density is constant over a texel except for the sine, so its sums are exact.
constexpr size_t kBands = 32;
constexpr size_t kTurns = 36;
constexpr size_t kInner = 8;

/// Integrals of f over the bins.
template <typename Function>
std::vector<double> integrateBins(Function f) {
  std::vector<double> bins(kBands * kTurns);
  const double stepU = 1.0 / (kTurns * kInner);
  const double stepV = 1.0 / (kBands * kInner);
  for (size_t j = 0; j < kBands * kInner; ++j) {
    const double v = stepV * (double(j) + 0.5);
    const double area = 2.0 * M_PI * M_PI * stepU * stepV * std::sin(M_PI * v);
    for (size_t i = 0; i < kTurns * kInner; ++i) {
      const double u = stepU * (double(i) + 0.5);
      bins[j / kInner * kTurns + i / kInner] += area * f(directionAt(u, v));
    }
  }
  return bins;
}

double total(const std::vector<double>& values) {
  double sum = 0.0;
  for (double v : values) sum += v;
  return sum;
}

double luminanceOf(const dvec3& c) { return glm::dot(c, dvec3(0.2126, 0.7152, 0.0722)); }

TEST(ShaderEnvironment, MiddleOfATexelShowsTheTexelAndTheMiddleOfTheMapIsAlongX) {
  const Image image = sunnyMap();
  const Surrounded here(image, 0.0);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float* p = image.pixel(x, y);
      const dvec3 seen = radianceAlong(directionAt((x + 0.5) / kWidth, (y + 0.5) / kHeight));
      const double rounding = kTexelError * std::max({p[0], p[1], p[2]});
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(seen[c], p[c], rounding + 1e-10 * p[1] + 1e-12) << x << ", " << y;
    }
  }
  EXPECT_LE(glm::distance(glsl_double::environmentCoordinates(dvec3(1, 0, 0)), dvec2(0.5)), 1e-14);
}

TEST(ShaderEnvironment, TexelsKeepSunsHuesGreysAndDensities) {
  Draw draw(97);
  const auto read = [](const vec3& radiance, float density) {
    const glm::uvec2 texel = packTexel(radiance);
    const std::vector<uint32_t> words{0, 0, texel.x, withDensity(texel.y, density)};
    const With<std::span<const uint32_t>> texels(glsl_variant::environment, words);
    EXPECT_EQ(luminanceOfTexel(texel.x, texel.y),
              glm::dot(vec3(glsl_float::environmentTexel({1, 0}, {2, 1}, 0)), vec3(kLuminance)));
    return glsl_float::environmentTexel({1, 0}, {2, 1}, 0);
  };
  for (int k = 0; k < 20000; ++k) {
    const double scale = std::pow(10.0, draw.between(-15.0, 22.0));
    const vec3 light(scale * dvec3(draw.between(0.0, 1.0), draw.between(0.5, 1.0), draw.between(0.0, 1.0)));
    const auto density = float(std::pow(10.0, draw.between(-12.0, 9.0)));
    const glm::vec4 seen = read(light, density);
    const double most = std::max({light.x, light.y, light.z});
    for (int c = 0; c < 3; ++c) EXPECT_LE(std::abs(seen[c] - light[c]), kTexelError * most) << scale;
    EXPECT_LE(std::abs(seen.w - density), 6.2e-5f * density);
    const glm::vec4 grey = read(vec3(light.x), 0.0f);
    EXPECT_TRUE(grey.x == grey.y && grey.x == grey.z && grey.w == 0.0f);
  }
  EXPECT_EQ(read(vec3(0.0f), 1.0f), glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  EXPECT_EQ(read(vec3(1.0f, 0.5f, 0.25f), 1.0f), glm::vec4(1.0f, 0.5f, 0.25f, 1.0f));
  EXPECT_EQ(read(vec3(1.0f, 3e38f, -1.0f), 1.0f), glm::vec4(0.0f, kMostRadiance, 0.0f, 1.0f));
}

TEST(ShaderEnvironment, FilteringIsBilinearAndWrapsAround) {
  const Image image = sunnyMap();
  const Surrounded here(image, 0.0);
  // The point is between the last column and the first, a quarter of the way from row 7 to row 8.
  const double v = (7.75) / kHeight;
  const auto at = [&](int x, int y) {
    return radianceAlong(directionAt((x + 0.5) / kWidth, (y + 0.5) / kHeight)).y;
  };
  const double expected =
      0.75 * (0.5 * at(kWidth - 1, 7) + 0.5 * at(0, 7)) + 0.25 * (0.5 * at(kWidth - 1, 8) + 0.5 * at(0, 8));
  EXPECT_NEAR(radianceAlong(directionAt(1e-12, v)).y, expected, 1e-9);
  EXPECT_NEAR(radianceAlong(directionAt(1.0 - 1e-12, v)).y, expected, 1e-9);
}

TEST(ShaderEnvironment, RotationTurnsWhatIsSeenCounterClockwise) {
  Draw draw(103);
  const Image image = sunnyMap();
  for (int k = 0; k < 1000; ++k) {
    const dvec3 d = draw.direction();
    dvec3 unturned;
    {
      const Surrounded here(image, 0.0);
      unturned = radianceAlong(d);
    }
    const Surrounded here(image, kTurn);
    const dvec3 seen = radianceAlong(turned(d, kTurn));
    EXPECT_LE(glm::distance(seen, unturned), 1e-4 * (1.0 + glm::length(unturned)));
  }
}

TEST(ShaderEnvironment, DirectionUndoesCoordinates) {
  for (double rotation : kRotations) {
    const Surrounded here(sunnyMap(), rotation);
    Draw draw(107);
    for (int k = 0; k < 10000; ++k) {
      const dvec3 d = draw.direction();
      // The cosine and the sine of the rotation are floats.
      EXPECT_LE(glm::distance(glsl_double::environmentDirection(glsl_double::environmentCoordinates(d)), d),
                3e-7);
      const vec3 f(d);
      EXPECT_LE(glm::distance(glsl_float::environmentDirection(glsl_float::environmentCoordinates(f)), f),
                2e-6f);
    }
  }
}

TEST(ShaderEnvironment, FloatRadianceIsNearDouble) {
  const Surrounded here(sunnyMap(), kTurn);
  Draw draw(109);
  for (int k = 0; k < 20000; ++k) {
    const vec3 d(draw.direction());
    const dvec3 exact = radianceAlong(dvec3(d));
    // A float's direction is good to 1e-7, near the poles to the root of that: by the brightest texel's
    // slope.
    const double pole = std::sqrt(std::max(1e-6, 1.0 - double(d.y) * d.y));
    EXPECT_LE(glm::distance(dvec3(vec3(glsl_float::environmentAlong(d))), exact), 3e-2 / pole);
  }
}

TEST(ShaderEnvironment, DensityIntegratesToOneAndMissesNoLight) {
  for (double rotation : kRotations) {
    const Surrounded here(sunnyMap(), rotation);
    const double whole = total(integrateBins([](const dvec3& d) { return pdfAlong(d); }));
    EXPECT_NEAR(whole, 1.0, 1e-5);
    size_t dark = 0;
    integrateBins([&](const dvec3& d) {
      const bool lit = luminanceOf(radianceAlong(d)) > 1e-6;
      const bool drawn = pdfAlong(d) > 0.0;
      EXPECT_TRUE(drawn || !lit);
      dark += drawn ? 0 : 1;
      return 0.0;
    });
    // The whole black half is dark, except for the halves of two columns that filtering lights. Half a column
    // is no whole number of steps.
    EXPECT_NEAR(double(dark) / (kBands * kTurns * kInner * kInner), 15.0 / 32.0, 4e-3);
  }
}

TEST(ShaderEnvironment, SampledDirectionsFollowTheDensity) {
  constexpr int kSamples = 1 << 20;
  for (double rotation : kRotations) {
    const Surrounded here(sunnyMap(), rotation);
    std::vector<double> expected = integrateBins([](const dvec3& d) { return pdfAlong(d); });
    for (double& e : expected) e *= kSamples;
    std::vector<double> counts(expected.size());
    Draw draw(113);
    for (int k = 0; k < kSamples; ++k) {
      const uint32_t first = draw.engine();
      const glm::vec2 place = glsl_float::sampleEnvironment(uvec2(first, draw.engine()));
      const dvec3 d(glsl_float::environmentDirection(place / glm::vec2(kWidth, kHeight)));
      ASSERT_NEAR(glm::length(d), 1.0, 1e-6);
      const double u = std::atan2(d.z, d.x) / (2.0 * M_PI) + 0.5;
      const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / M_PI;
      ++counts[std::min(size_t(v * kBands), kBands - 1) * kTurns + std::min(size_t(u * kTurns), kTurns - 1)];
    }
    EXPECT_GT(chiSquareChance(expected, counts), kSignificance / 2.0) << "rotation " << rotation;
  }
}

TEST(ShaderEnvironment, SampledIrradianceIsThatOfQuadrature) {
  constexpr int kSamples = 1 << 17;
  const Surrounded here(sunnyMap(), kTurn);
  Draw normals(127);
  for (int n = 0; n < 4; ++n) {
    // Away from the bright texel the map's power says little about the light.
    dvec3 normal = normals.direction();
    while (glm::dot(normal, turned(directionAt(25.5 / kWidth, 4.5 / kHeight), kTurn)) < 0.2)
      normal = normals.direction();
    const double exact = total(integrateBins(
        [&](const dvec3& d) { return luminanceOf(radianceAlong(d)) * std::max(0.0, glm::dot(d, normal)); }));
    double sum = 0.0;
    double squares = 0.0;
    Draw draw(131);
    for (int k = 0; k < kSamples; ++k) {
      const uint32_t first = draw.engine();
      const auto s = glsl_double::environmentLight(1.0, uvec2(first, draw.engine()));
      const double x = luminanceOf(s.irradiance) * std::max(0.0, glm::dot(s.direction, normal));
      sum += x / kSamples;
      squares += x * x / kSamples;
    }
    const double error = std::sqrt((squares - sum * sum) / kSamples);
    EXPECT_LE(error, 0.01 * exact);
    EXPECT_LE(std::abs(sum - exact), 4.5 * error + 1e-3 * exact) << "normal " << n;
  }
}

/// Variance of the irradiance that 64 light samples estimate on a plane, over its square.
double relativeVariance(const dvec3& normal, bool stratified) {
  constexpr uint32_t kRepeats = 400;
  constexpr uint32_t kSamples = 64;
  Draw draw(139);
  double sum = 0.0;
  double squares = 0.0;
  for (uint32_t r = 0; r < kRepeats; ++r) {
    double estimate = 0.0;
    for (uint32_t k = 0; k < kSamples; ++k) {
      const auto sampler = glsl_float::makeSampler(glsl_float::mixBits(r), k);
      const uvec2 independent(uint32_t(draw.engine()), uint32_t(draw.engine()));
      const auto s = glsl_float::environmentLight(
          1.0f, stratified ? glsl_float::drawPairBits(sampler, 0u) : independent);
      estimate +=
          luminanceOf(dvec3(s.irradiance)) * std::max(0.0, glm::dot(dvec3(s.direction), normal)) / kSamples;
    }
    sum += estimate / kRepeats;
    squares += estimate * estimate / kRepeats;
  }
  return squares / (sum * sum) - 1.0;
}

TEST(ShaderEnvironment, StratifiedNumbersDrawStratifiedDirections) {
  const Surrounded here(sunnyMap(), 0.0);
  // An alias table leaves 0.4 to 0.9 of the variance of independent numbers; the sample variance of 400 is
  // good to 7 %.
  for (const dvec3& normal :
       {dvec3(0.0, 1.0, 0.0), glm::normalize(dvec3(0.8, 0.5, 0.4)), dvec3(0.0, 0.0, 1.0)}) {
    EXPECT_LE(relativeVariance(normal, true), 0.25 * relativeVariance(normal, false));
  }
}

TEST(ShaderEnvironment, BesideScatteredRaysOnlyWhatIsBrighterThanTheMeanIsDrawn) {
  const Image image = sunnyMap();
  const Surrounded here(image, 0.0, EnvironmentDraws::LightAndPaths);
  EXPECT_NEAR(total(integrateBins([](const dvec3& d) { return pdfAlong(d); })), 1.0, 1e-3);
  const double area = 4.0 * M_PI;
  const double mean =
      total(integrateBins([](const dvec3& d) { return luminanceOf(radianceAlong(d)); })) / area;
  integrateBins([&](const dvec3& d) {
    if (luminanceOf(radianceAlong(d)) > 1.1 * mean) {
      EXPECT_GT(pdfAlong(d), 0.0);
    }
    return 0.0;
  });
  EXPECT_EQ(pdfAlong(directionAt(0.1, 0.5)), 0.0);  // the black half
  // A map without anything brighter is drawn evenly.
  Image even = image;
  for (float& x : even.values) x = 1.0f;
  const Surrounded there(even, 0.0, EnvironmentDraws::LightAndPaths);
  EXPECT_NEAR(pdfAlong(directionAt(0.3, 0.4)), 1.0 / area, 0.01 / area);
}

TEST(ShaderEnvironment, ChanceOfTheEnvironmentScalesDensityAndIrradiance) {
  const Surrounded here(sunnyMap(), kTurn);
  const uvec2 bits(0x789abcdeu, 0x13579bdfu);
  const auto whole = glsl_double::environmentLight(1.0, bits);
  const auto part = glsl_double::environmentLight(0.25, bits);
  EXPECT_EQ(part.direction, whole.direction);
  EXPECT_NEAR(part.pdf, 0.25 * whole.pdf, 1e-12 * whole.pdf);
  EXPECT_LE(glm::distance(part.irradiance, 4.0 * whole.irradiance), 1e-9 * glm::length(whole.irradiance));
}

TEST(ShaderEnvironment, ABlackMapIsDrawnEvenlyAndGivesNothing) {
  Image image = sunnyMap();
  for (float& x : image.values) x = 0.0f;
  const Surrounded here(image, 0.0);
  Draw draw(137);
  for (int k = 0; k < 1000; ++k) {
    const uint32_t first = draw.engine();
    const auto s = glsl_float::environmentLight(1.0f, uvec2(first, draw.engine()));
    EXPECT_EQ(s.irradiance, vec3(0.0f));
    EXPECT_TRUE(std::isfinite(s.pdf));
  }
}

}  // namespace
}  // namespace fragtrace
