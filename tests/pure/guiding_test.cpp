// SPDX-License-Identifier: MIT
// src/pack/guiding.h: lobes are aimed at what photons come from.
#include "pack/guiding.h"

#include <gtest/gtest.h>

#include <utility>

#include "glsl_lights.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec2;
using glm::vec3;
using glsl_variant::With;

const std::vector<glm::vec4> kBall{{0.0f, 0.0f, 0.0f, 1.0f}};
const vec3 kPlace(1.75f, 1.75f, 1.75f);  // in the middle of a cell that is half a radius wide

/// Photons on places of a cell that come from a lamp of a size, or converge on it.
std::vector<Photon> photonsOf(const vec3& lamp, bool away, size_t count, float size, Draw& draw,
                              uint32_t chain = 1) {
  std::vector<Photon> photons;
  const auto place = [&] { return vec3(draw.unit(), draw.unit(), draw.unit()) - 0.5f; };
  for (size_t i = 0; i < count; ++i) {
    const vec3 point = kPlace + 0.2f * place();
    const vec3 towards = glm::normalize(lamp + size * place() - point);
    photons.push_back({point, away ? -towards : towards, 1.0f, chain});
  }
  return photons;
}

/// The shader reads the lobes.
struct Reading {
  explicit Reading(std::vector<uint32_t> fitted) : rows(std::move(fitted)) {}
  std::vector<uint32_t> rows;
  With<std::vector<glm::vec4>> casters{glsl_variant::casters, kBall};
  With<int> count{glsl_variant::casterCount, 1};
  With<std::span<const uint32_t>> lights{glsl_variant::lights, std::span<const uint32_t>(rows)};
};

/// The lobes of a cell, whose shares must rise to all of its directions: else the pdf would be that of
/// others.
int lobesOf(uint32_t cell) {
  float before = 0.0f;
  int count = 0;
  for (; count < layout::kGuidingLobes; ++count) {
    const float upTo = glsl_float::guidingLobe(cell, count).upTo;
    if (upTo == 0.0f) break;
    EXPECT_GT(upTo, before) << count;
    before = upTo;
  }
  EXPECT_EQ(before, count > 0 ? 1.0f : 0.0f);
  return count;
}

/// The mean of the cosine between guiding directions from a point, and what is wanted.
double meanCosine(const vec3& from, const vec3& wanted, Draw& draw) {
  const uint32_t cell = glsl_float::guidingCell(from);
  double sum = 0.0;
  for (int i = 0; i < 4096; ++i) {
    const vec3 d = glsl_float::guidingDirection(from, cell, float(draw.unit()), {draw.unit(), draw.unit()});
    sum += glm::dot(d, wanted);
  }
  return sum / 4096.0;
}

TEST(Guiding, IsAimedAtTheVirtualImageWhereverInItsCellAPathBegins) {
  Draw draw(311);
  for (const bool away : {false, true}) {
    const vec3 lamp = kPlace + vec3(1.5f, -0.5f, -1.0f);
    std::vector<Photon> photons = photonsOf(lamp, away, 500, 0.02f, draw);
    const Reading guide(fitGuiding(photons, kBall));
    for (const vec3 beside : {vec3(0.0f), vec3(0.1f, -0.1f, 0.1f), vec3(-0.1f, 0.1f, 0.1f)}) {
      const vec3 from = kPlace + beside;
      const vec3 wanted = glm::normalize(lamp - from) * (away ? -1.0f : 1.0f);
      // Without the parallax it would be off by 0.1 radians, a cosine of 0.995.
      EXPECT_GT(meanCosine(from, wanted, draw), 0.9995) << away;
      EXPECT_GT(glsl_float::guidingPdf(from, glsl_float::guidingCell(from), wanted), 500.0f) << away;
    }
  }
}

TEST(Guiding, DrawsAsDenselyAsItTells) {
  Draw draw(313);
  std::vector<Photon> photons = photonsOf(kPlace + vec3(-1.0f, -1.5f, 0.5f), false, 300, 1.2f, draw, 1);
  for (const Photon& p : photonsOf(kPlace + vec3(-1.0f, 0.3f, -1.2f), true, 60, 1.6f, draw, 2))
    photons.push_back(p);
  const Reading guide(fitGuiding(photons, kBall));
  const uint32_t cell = glsl_float::guidingCell(kPlace);
  constexpr int kCells = 24;
  constexpr int kParts = 96;
  constexpr int kSamples = 1 << 19;
  std::vector<double> counted(kCells * kCells);
  std::vector<double> expected(counted.size());
  for (int i = 0; i < kSamples; ++i) {
    const vec3 d = glsl_float::guidingDirection(kPlace, cell, float(draw.unit()), {draw.unit(), draw.unit()});
    const dvec2 place(std::atan2(d.y, d.x) / (2.0 * M_PI) + 0.5, 0.5 * d.z + 0.5);
    const dvec2 at = glm::clamp(place, dvec2(0.0), dvec2(1.0 - 1e-9)) * double(kCells);
    ++counted[size_t(at.y) * kCells + size_t(at.x)];
  }
  double sum = 0.0;
  for (int y = 0; y < kCells * kParts; ++y) {
    for (int x = 0; x < kCells * kParts; ++x) {
      const double z = 2.0 * (y + 0.5) / (kCells * kParts) - 1.0;
      const double phi = 2.0 * M_PI * ((x + 0.5) / (kCells * kParts) - 0.5);
      const double r = std::sqrt(1.0 - z * z);
      const double pdf = glsl_float::guidingPdf(kPlace, cell, vec3(r * std::cos(phi), r * std::sin(phi), z));
      const double part = pdf * 4.0 * M_PI / (kCells * kCells * kParts * kParts);
      expected[size_t(y / kParts) * kCells + size_t(x / kParts)] += kSamples * part;
      sum += part;
    }
  }
  EXPECT_NEAR(sum, 1.0, 0.002);
  EXPECT_GT(chiSquareChance(expected, counted), kSignificance);
}

TEST(Guiding, KeepsTheStrongestLobesOfACellAndHasNoneElsewhere) {
  Draw draw(317);
  std::vector<Photon> photons;
  for (uint32_t chain = 0; chain < 20; ++chain) {
    const vec3 lamp = kPlace + vec3(1.0f, 0.1f * float(chain) - 1.0f, -1.0f);
    for (const Photon& p : photonsOf(lamp, false, 20 + chain, 0.01f, draw, chain)) photons.push_back(p);
  }
  const Reading guide(fitGuiding(photons, kBall));
  const uint32_t cell = glsl_float::guidingCell(kPlace);
  EXPECT_EQ(lobesOf(cell), layout::kGuidingLobes);
  const vec3 strongest = glm::normalize(vec3(1.0f, 0.9f, -1.0f));
  const vec3 weakest = glm::normalize(vec3(1.0f, -1.0f, -1.0f));
  EXPECT_GT(glsl_float::guidingPdf(kPlace, cell, strongest), 10.0f);
  EXPECT_EQ(glsl_float::guidingPdf(kPlace, cell, weakest), 0.0f);
  EXPECT_TRUE(glsl_float::hasGuiding(cell));
  EXPECT_FALSE(glsl_float::hasGuiding(glsl_float::guidingCell(vec3(20.0f, 3.0f, -9.0f))));
}

TEST(Guiding, LeavesOutLobesThatHaveNoShare) {
  std::vector<Photon> photons;
  for (uint32_t chain = 0; chain < 7; ++chain) {
    const vec3 wi = glm::normalize(vec3(0.3f * float(chain), 1.0f, 0.0f));
    photons.push_back({kPlace, wi, chain == 0 ? 1.0f : 3e-5f, chain});
  }
  const Reading guide(fitGuiding(photons, kBall));
  EXPECT_LT(lobesOf(glsl_float::guidingCell(kPlace)), 7);
}

TEST(Guiding, StaysFiniteWithOnePhotonManyAlikeAndNone) {
  Draw draw(331);
  std::vector<Photon> none;
  EXPECT_EQ(fitGuiding(none, kBall), std::vector<uint32_t>(kGuidingRows * 4));
  for (const size_t count : {size_t(1), size_t(1000)}) {
    std::vector<Photon> photons(count, Photon{kPlace, {0.0f, 1.0f, 0.0f}, 2.0f, 7});
    photons.push_back({kPlace, {0.0f, 1.0f, 0.0f}, 0.0f, 9});  // it has no flux
    const Reading guide(fitGuiding(photons, kBall));
    EXPECT_EQ(lobesOf(glsl_float::guidingCell(kPlace)), 1);
    EXPECT_GT(meanCosine(kPlace, {0.0f, 1.0f, 0.0f}, draw), count == 1 ? 0.9 : 0.9999);
  }
}

}  // namespace
}  // namespace fragtrace
