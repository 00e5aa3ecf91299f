// SPDX-License-Identifier: MIT
// shaders/media/volume.glsl against numerical integration of the same grid.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "glsl.h"
#include "pack/gpu_scene.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::ivec3;
using glm::vec3;

/// The shader reads these.
Words texels;

}  // namespace

namespace glsl_float {
namespace {
using glm::ivec2;      // NOLINT: as the shader has them
using glm::ivec3;      // NOLINT
using layout::Volume;  // NOLINT
uvec2 readBricks(int index) { return {texels[2 * size_t(index)], texels[2 * size_t(index) + 1]}; }
vec2 unpackHalf2x16(uint32_t word) { return glm::unpackHalf2x16(word); }
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "media/volume.glsl"
#pragma GCC diagnostic pop
}  // namespace
}  // namespace glsl_float

namespace {

constexpr int kWalks = 1 << 16;
constexpr double kSide = 0.1;  // side of a voxel, local space

/// Bricks of which some are empty, with values between 0 and 1, some of them 0.
VolumeGrid sampleGrid() {
  VolumeGrid grid;
  grid.minimum = {-8, 0, 16};
  grid.bricks = {3, 2, 2};
  grid.largest = 4.0;
  Draw draw(1);
  uint32_t stored = 0;
  for (int brick = 0; brick < 12; ++brick) grid.table.push_back(brick % 4 == 1 ? 0 : ++stored);
  for (size_t i = 0; i < stored * kBrickVoxels; ++i) {
    const float value = draw.unit();
    grid.values.push_back(glm::packHalf1x16(value < 0.3f ? 0.0f : value));
  }
  return grid;
}

float storedAt(const VolumeGrid& grid, ivec3 voxel) {
  const ivec3 place = voxel - grid.minimum;
  for (int axis = 0; axis < 3; ++axis) {
    if (place[axis] < 0 || place[axis] >= kBrickSide * grid.bricks[axis]) return 0.0f;
  }
  const ivec3 brick = place / kBrickSide;
  const uint32_t number =
      grid.table[(size_t(brick.z) * size_t(grid.bricks.y) + size_t(brick.y)) * size_t(grid.bricks.x) +
                 size_t(brick.x)];
  const ivec3 inside = place % kBrickSide;
  if (number == 0) return 0.0f;
  return glm::unpackHalf1x16(grid.values[(number - 1) * kBrickVoxels +
                                         (size_t(inside.z) * 8 + size_t(inside.y)) * 8 + size_t(inside.x)]);
}

/// Trilinear, as a part of the largest; voxel i lies at kSide * i.
double densityAt(const VolumeGrid& grid, const dvec3& point) {
  const dvec3 place = point / kSide;
  const dvec3 base = glm::floor(place);
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const ivec3 side(corner & 1, (corner >> 1) & 1, corner >> 2);
    const dvec3 part = place - base;
    const dvec3 weights = glm::mix(1.0 - part, part, dvec3(side));
    sum += weights.x * weights.y * weights.z * double(storedAt(grid, ivec3(base) + side));
  }
  return sum;
}

layout::Volume shaderVolume(const VolumeGrid& grid, double extinction) {
  texels.clear();
  const PackedGrid packed = packGrid(grid, texels);
  const glm::dmat4 voxels = glm::scale(glm::dmat4(1.0), dvec3(1.0 / kSide));
  const glm::dmat4 rows = glm::transpose(packed.fromFile * voxels);
  return {glm::vec4(rows[0]),
          glm::vec4(rows[1]),
          glm::vec4(rows[2]),
          glm::vec4(1.0f),
          {float(extinction), 0.0f, 0.0f, 0.0f},
          {packed.bricks, 0}};
}

struct RayCase {
  dvec3 origin;
  dvec3 direction;
};

/// Makes a ray towards the middle of the grid, from outside or inside. Some rays run along an axis.
RayCase rayCase(Draw& draw, int i) {
  const dvec3 middle(0.4, 0.8, 2.4);
  const dvec3 target =
      middle + dvec3(draw.between(-0.5, 0.5), draw.between(-0.5, 0.5), draw.between(-0.5, 0.5));
  dvec3 direction = glm::normalize(dvec3(draw.between(-1, 1), draw.between(-1, 1), draw.between(-1, 1)));
  if (i % 4 == 0) direction = dvec3(i % 3 == 0, i % 3 == 1, i % 3 == 2);
  if (i % 8 == 4) direction = -direction;
  return {target - direction * draw.between(0.0, 4.0), direction};
}

double depthAlong(const VolumeGrid& grid, const RayCase& ray, double to) {
  constexpr int kSteps = 4000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i)
    sum += densityAt(grid, ray.origin + ray.direction * (to * (i + 0.5) / kSteps)) * to / kSteps;
  return sum;
}

TEST(ShaderVolume, WalksThroughHaveTheTransmittanceOfTheIntegral) {
  const VolumeGrid grid = sampleGrid();
  Draw draw(2);
  for (int i = 0; i < 12; ++i) {
    const double extinction = i % 2 == 0 ? 1.5 : 8.0;
    const layout::Volume volume = shaderVolume(grid, extinction);
    const RayCase ray = rayCase(draw, i);
    const double to = draw.between(1.0, 6.0);
    const double expected = std::exp(-extinction * depthAlong(grid, ray, to));
    double sum = 0.0;
    double squares = 0.0;
    for (uint32_t k = 0; k < kWalks; ++k) {
      const uint32_t seed = glsl_float::mixBits(k + 77u * uint32_t(i));
      const auto walk =
          glsl_float::walkVolume(volume, vec3(ray.origin), vec3(ray.direction), 0.0f, float(to), true, seed);
      sum += double(walk.transmittance);
      squares += double(walk.transmittance) * double(walk.transmittance);
      ASSERT_LT(walk.steps, layout::kMostVolumeSteps);
    }
    const double mean = sum / kWalks;
    const double error = std::sqrt(std::max(0.0, squares / kWalks - mean * mean) / kWalks);
    EXPECT_NEAR(mean, expected, 4.5 * error + 1e-4) << i;
  }
}

TEST(ShaderVolume, FlightsEndAsDenselyAsTheIntegralSays) {
  const VolumeGrid grid = sampleGrid();
  Draw draw(3);
  constexpr size_t kBins = 24;
  constexpr int kTests = 8;
  for (int i = 0; i < kTests; ++i) {
    const layout::Volume volume = shaderVolume(grid, 2.0);
    const RayCase ray = rayCase(draw, i);
    const double to = draw.between(2.0, 5.0);
    std::vector<double> counted(kBins + 1, 0.0);
    std::vector<double> expected(kBins + 1);
    double passed = 1.0;
    for (size_t bin = 0; bin <= kBins; ++bin) {
      const double next =
          bin == kBins ? 0.0 : std::exp(-2.0 * depthAlong(grid, ray, to * double(bin + 1) / kBins));
      expected[bin] = kWalks * (passed - next);
      passed = next;
    }
    for (uint32_t k = 0; k < kWalks; ++k) {
      const auto walk = glsl_float::walkVolume(volume, vec3(ray.origin), vec3(ray.direction), 0.0f, float(to),
                                               false, glsl_float::mixBits(k + 1000003u * uint32_t(i)));
      const bool ends = walk.end < glsl_float::kFarAway;
      counted[ends ? std::min(kBins - 1, size_t(double(walk.end) / to * kBins)) : kBins] += 1.0;
    }
    EXPECT_GE(chiSquareChance(expected, counted), kSignificance / kTests) << i;
  }
}

/// One brick of a quarter except for a corner of 1: walks are long, and most end by roulette.
TEST(ShaderVolume, RouletteKeepsTheMeanOfWhatPassesADenseGrid) {
  VolumeGrid grid;
  grid.bricks = {1, 1, 1};
  grid.largest = 1.0;
  grid.table = {1};
  grid.values.assign(kBrickVoxels, glm::packHalf1x16(0.25f));
  grid.values.front() = glm::packHalf1x16(1.0f);
  constexpr double kExtinction = 40.0;
  const layout::Volume volume = shaderVolume(grid, kExtinction);
  const RayCase ray{{0.41, 0.38, -1.0}, {0.0, 0.0, 1.0}};
  const double expected = std::exp(-kExtinction * depthAlong(grid, ray, 3.0));
  double sum = 0.0;
  for (uint32_t k = 0; k < 4 * kWalks; ++k)
    sum += double(glsl_float::walkVolume(volume, vec3(ray.origin), vec3(ray.direction), 0.0f, 3.0f, true,
                                         glsl_float::mixBits(k))
                      .transmittance);
  EXPECT_NEAR(sum / (4 * kWalks) / expected, 1.0, 0.03);
}

TEST(ShaderVolume, RaysBesideTheGridMeetNothing) {
  const VolumeGrid grid = sampleGrid();
  const layout::Volume volume = shaderVolume(grid, 100.0);
  const dvec3 low(-1.6, -0.8, 0.8);
  const dvec3 high(1.6, 1.6, 3.2);
  Draw draw(5);
  for (uint32_t i = 0; i < 3000; ++i) {
    // Both ends lie on the same outer side of the grid, by one axis after the other.
    const int axis = int(i % 3);
    dvec3 from(draw.between(-4, 4), draw.between(-4, 4), draw.between(-2, 6));
    dvec3 to(draw.between(-4, 4), draw.between(-4, 4), draw.between(-2, 6));
    from[axis] = i % 2 == 0 ? high[axis] + draw.unit() : low[axis] - draw.unit();
    to[axis] = i % 2 == 0 ? high[axis] + draw.unit() : low[axis] - draw.unit();
    const dvec3 way = to - from;
    const auto walk = glsl_float::walkVolume(volume, vec3(from), vec3(glm::normalize(way)), 0.0f,
                                             float(glm::length(way)), true, i);
    EXPECT_EQ(walk.transmittance, 1.0f) << i;
    EXPECT_EQ(walk.steps, 0) << i;
  }
}

TEST(ShaderVolume, RadianceIsInterpolatedLinearly) {
  VolumeGrid grid = sampleGrid();
  VolumeGrid red = grid;
  Draw draw(6);
  for (uint16_t& value : red.values) {
    value = glm::packHalf1x16(float(draw.between(0.5, 1.0)));
    for (const uint16_t half : {value, uint16_t(0), value}) grid.radiance.push_back(half);
  }
  layout::Volume volume = shaderVolume(grid, 1.0);
  volume.extinction.y = 3.0f;
  for (int i = 0; i < 8; ++i) {
    const dvec3 point(draw.between(-1.0, 1.8), draw.between(-0.2, 1.8), draw.between(1.4, 3.4));
    dvec3 sum(0.0);
    for (uint32_t k = 0; k < kWalks; ++k) {
      const uint32_t bits = glsl_float::mixBits(k + 313u * uint32_t(i));
      sum += dvec3(glsl_float::volumeRadiance(volume, vec3(point), bits));
    }
    EXPECT_NEAR(sum.x / kWalks, 3.0 * densityAt(red, point), 0.01) << i;
    EXPECT_EQ(sum.y, 0.0);
    EXPECT_EQ(sum.z, sum.x);
  }
}

TEST(ShaderVolume, MajorantsBoundTheDensities) {
  const VolumeGrid grid = sampleGrid();
  const layout::Volume volume = shaderVolume(grid, 1.0);
  Draw draw(4);
  for (int i = 0; i < 100000; ++i) {
    const dvec3 voxel(draw.between(-18, 18), draw.between(-10, 18), draw.between(6, 34));
    const vec3 place = glsl_float::inBricks(volume, vec3(voxel * kSide), 1.0f);
    const ivec3 brick(glm::floor(place));
    const double density = densityAt(grid, voxel * kSide);
    if (!glsl_float::isInTable(volume, brick)) {
      EXPECT_LT(density, 1e-5) << voxel.x << ' ' << voxel.y << ' ' << voxel.z;
      continue;
    }
    const float majorant = glm::uintBitsToFloat(glsl_float::brickEntry(volume, brick).y);
    EXPECT_LE(density, double(majorant) + 1e-5) << voxel.x << ' ' << voxel.y << ' ' << voxel.z;
  }
}

}  // namespace
}  // namespace fragtrace
