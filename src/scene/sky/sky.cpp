// SPDX-License-Identifier: MIT
#include "scene/sky/sky.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "base/parallel.h"
#include "scene/sky/daylight.h"

namespace fragtrace {

namespace {

constexpr int kSkyWidth = 256;
constexpr int kSkyHeight = 512;  // finer, as the light changes fast above the horizon
constexpr int kRaySteps = 32;    // along a ray

/// A step along a ray that starts on the ground.
struct RayStep {
  double distance;
  double radius;
  // The part of the sun's light there that comes to the eye, except for the phase function.
  Spectrum molecules;
  Spectrum aerosol;
};

std::vector<RayStep> stepsAlong(const SkyAir& sky, double cosine) {
  static const Quadrature along = quadratureOf(kRaySteps);
  const double whole = distanceToTop(kGroundRadius, cosine);
  const AirColumns all = sky.table.columnsFrom(kGroundRadius, cosine);
  std::vector<RayStep> steps;
  for (size_t i = 0; i < along.nodes.size(); ++i) {
    const double s = along.nodes[i];
    RayStep step{};
    step.distance = whole * s * s;
    const RayPoint point = alongRay(kGroundRadius, cosine, step.distance);
    step.radius = point.radius;
    const AirColumns beyond = sky.table.columnsFrom(point.radius, point.cosine);
    AirColumns passed;
    for (size_t k = 0; k < passed.size(); ++k) passed[k] = std::max(0.0, all[k] - beyond[k]);
    const Spectrum passes = transmittanceOf(sky.air, passed);
    const AirColumns density = densityAt(point.radius - kGroundRadius);
    const double length = along.weights[i] * 2.0 * s * whole;
    for (size_t k = 0; k < kWavelengths; ++k) {
      step.molecules[k] = passes[k] * length * sky.air.molecules[k] * density[size_t(Air::Molecules)];
      step.aerosol[k] = passes[k] * length * sky.air.aerosol[k] * density[size_t(Air::Aerosol)];
    }
    steps.push_back(step);
  }
  return steps;
}

Spectrum radianceAlong(const SkyAir& sky, const std::vector<RayStep>& steps, double cosine, double sunCosine,
                       double turn) {
  const double sines = std::sqrt(std::max(0.0, (1.0 - cosine * cosine) * (1.0 - sunCosine * sunCosine)));
  const double between = std::clamp(cosine * sunCosine + sines * std::cos(turn), -1.0, 1.0);
  const double ofMolecules = moleculesPhase(between);
  const double ofAerosol = aerosolPhase(between);
  Spectrum sum{};
  for (const RayStep& step : steps) {
    const double cosineOfSun =
        std::clamp((kGroundRadius * sunCosine + step.distance * between) / step.radius, -1.0, 1.0);
    const Spectrum often = sky.often.at(step.radius, cosineOfSun);
    const double share = sunShare(step.radius, cosineOfSun);
    Spectrum sun{};
    if (share > 0.0) sun = transmittanceOf(sky.air, sky.table.columnsFrom(step.radius, cosineOfSun));
    for (size_t k = 0; k < kWavelengths; ++k)
      sum[k] += step.molecules[k] * (share * sun[k] * ofMolecules + often[k]) +
                step.aerosol[k] * (share * sun[k] * ofAerosol + often[k]);
  }
  return sum;
}

/// The part of the disc above the horizon: how much of its light that is, and what the air lets pass of it.
SunDisc discAt(const SkyAir& sky, double elevation) {
  constexpr int kParts = 32;
  const double radius = glm::radians(kSunRadiusDegrees);
  SunDisc sun;
  const double angle = glm::radians(elevation);
  sun.direction = {0.0, std::sin(angle), -std::cos(angle)};
  Spectrum passes{};
  double visible = 0.0;
  double all = 0.0;
  for (int y = 0; y < kParts; ++y) {
    const double up = 2.0 * (y + 0.5) / kParts - 1.0;
    double strip = 0.0;
    for (int x = 0; x < kParts; ++x) {
      const double across = 2.0 * (x + 0.5) / kParts - 1.0;
      strip += std::pow(std::max(0.0, 1.0 - up * up - across * across), 0.5 * kLimbPowers.g);
    }
    all += strip;
    const double cosine = std::sin(angle + up * radius);
    if (cosine < 0.0) continue;
    visible += strip;
    const Spectrum there = transmittanceOf(sky.air, sky.table.columnsFrom(kGroundRadius, cosine));
    for (size_t k = 0; k < kWavelengths; ++k) passes[k] += strip * there[k];
  }
  if (visible <= 0.0) return sun;
  const glm::dvec3 light = glm::max(colorOf(passes) / visible, 0.0);
  sun.irradiance = light * (visible / all);
  // The mean of the limb's power over the disc is 2 / (2 + power).
  sun.radiance = light * (1.0 + 0.5 * kLimbPowers) / (kHalfTurn * radius * radius);
  return sun;
}

}  // namespace

SkyAir::SkyAir(double turbidity, double groundAlbedo)
    : air(atmosphereOf(turbidity)), often(air, table, groundAlbedo), albedo(groundAlbedo) {}

Spectrum skyRadiance(const SkyAir& sky, double cosine, double sunCosine, double turn) {
  return radianceAlong(sky, stepsAlong(sky, cosine), cosine, sunCosine, turn);
}

SkyMap makeSky(const SkyAir& sky, double sunElevation) {
  SkyMap map;
  map.sun = discAt(sky, sunElevation);
  const double sunCosine = std::sin(glm::radians(sunElevation));
  map.image = {
      kSkyWidth, kSkyHeight, {"R", "G", "B"}, std::vector<float>(size_t(kSkyWidth) * kSkyHeight * 3), {}};
  std::vector<glm::dvec3> sums(kSkyHeight / 2, glm::dvec3(0.0));
  forEachIndex(kSkyHeight / 2, [&](size_t y) {
    const double polar = kHalfTurn * (double(y) + 0.5) / kSkyHeight;
    const std::vector<RayStep> steps = stepsAlong(sky, std::cos(polar));
    // Both sides of the sun are alike.
    for (int i = 0; i < kSkyWidth / 2; ++i) {
      const double turn = 2.0 * kHalfTurn * (i + 0.5) / kSkyWidth;
      const Spectrum part = radianceAlong(sky, steps, std::cos(polar), sunCosine, turn);
      const glm::dvec3 color = glm::max(colorOf(part), 0.0);
      sums[y] += 2.0 * color;
      for (const int x : {kSkyWidth / 4 + i, kSkyWidth / 4 - 1 - i}) {
        float* p = map.image.pixel((x + kSkyWidth) % kSkyWidth, int(y));
        for (int c = 0; c < 3; ++c) p[c] = float(color[c]);
      }
    }
    sums[y] *= std::cos(polar) * std::sin(polar) * (kHalfTurn / kSkyHeight) * (2.0 * kHalfTurn / kSkyWidth);
  });
  // The ground beside the eye takes all this light, and that of the sun.
  glm::dvec3 falls = map.sun.irradiance * std::max(0.0, sunCosine);
  for (const glm::dvec3& sum : sums) falls += sum;
  const glm::vec3 ground(falls * sky.albedo / kHalfTurn);
  for (int y = kSkyHeight / 2; y < kSkyHeight; ++y) {
    for (int x = 0; x < kSkyWidth; ++x) std::copy_n(&ground.x, 3, map.image.pixel(x, y));
  }
  return map;
}

Image withDisc(Image map, const SunDisc& sun) {
  const double u = std::atan2(sun.direction.z, sun.direction.x) / (2.0 * kHalfTurn) + 0.5;
  const double v = std::acos(std::clamp(sun.direction.y, -1.0, 1.0)) / kHalfTurn;
  const double x = u * map.width - 0.5;
  const double y = v * map.height - 0.5;
  for (const int right : {0, 1}) {
    for (const int down : {0, 1}) {
      const int column = (int(std::floor(x)) + right + map.width) % map.width;
      const int row = std::clamp(int(std::floor(y)) + down, 0, map.height - 1);
      const double fx = x - std::floor(x);
      const double fy = y - std::floor(y);
      const double share = (right == 1 ? fx : 1.0 - fx) * (down == 1 ? fy : 1.0 - fy);
      const double solidAngle = 2.0 * kHalfTurn / map.width * kHalfTurn / map.height *
                                std::sin(kHalfTurn * (row + 0.5) / map.height);
      for (int c = 0; c < 3; ++c) map.pixel(column, row)[c] += float(sun.irradiance[c] * share / solidAngle);
    }
  }
  return map;
}

SkyMap makeSky(double turbidity, double groundAlbedo, double sunElevation) {
  struct Kept {
    double turbidity;
    SkyAir sky;
  };
  static std::mutex mutex;
  static std::shared_ptr<const Kept> kept;
  std::shared_ptr<const Kept> own;
  {
    const std::lock_guard lock(mutex);
    own = kept;
  }
  if (!own || own->turbidity != turbidity || own->sky.albedo != groundAlbedo) {
    own = std::make_shared<const Kept>(Kept{turbidity, SkyAir(turbidity, groundAlbedo)});
    const std::lock_guard lock(mutex);
    kept = own;
  }
  return makeSky(own->sky, sunElevation);
}

}  // namespace fragtrace
