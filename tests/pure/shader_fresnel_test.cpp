// SPDX-License-Identifier: MIT
// shaders/fresnel.glsl against closed forms (Hecht, Optics, 4.6), in double precision, and in float against
// double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "glsl.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::vec3;
using glsl_double::fresnelDielectric;
using glsl_double::fresnelSchlick;
using glsl_double::mirrorDirection;
using glsl_double::refractThrough;
using glsl_double::schlickDielectric;
using glsl_double::thinReflectance;

constexpr double kTolerance = 1e-12;
constexpr double kIndices[] = {1.0001, 1.33, 1.5, 2.42, 1.0 / 1.33, 1.0 / 1.5, 1.0 / 2.42};

/// Hecht 4.34 and 4.40, written with the angles themselves.
double fresnelByAngles(double incident, double eta) {
  const double refracted = std::asin(std::sin(incident) / eta);
  const double perpendicular = -std::sin(incident - refracted) / std::sin(incident + refracted);
  const double parallel = std::tan(incident - refracted) / std::tan(incident + refracted);
  return 0.5 * (perpendicular * perpendicular + parallel * parallel);
}

double normalReflectance(double eta) { return std::pow((eta - 1.0) / (eta + 1.0), 2.0); }

TEST(ShaderFresnel, RefractedRaysFollowSnell) {
  Draw draw(1);
  for (double eta : kIndices) {
    for (int i = 0; i < 2000; ++i) {
      const dvec3 normal = draw.direction();
      dvec3 wo = draw.direction();
      if (glm::dot(wo, normal) < 0.0) wo = -wo;
      const double sine = glm::length(glm::cross(wo, normal));
      if (sine >= eta) continue;
      const dvec3 refracted = refractThrough(wo, normal, eta);
      EXPECT_NEAR(glm::length(refracted), 1.0, kTolerance);
      EXPECT_LT(glm::dot(refracted, normal), 0.0);
      // Signed: same plane, opposite side of the normal.
      EXPECT_LE(glm::distance(glm::cross(refracted, normal) * eta, -glm::cross(wo, normal)), kTolerance);
    }
  }
}

TEST(ShaderFresnel, InFloatAnIndexOfOneIsNotThereAtAnyAngle) {
  for (float cosine = 1.0f; cosine > 1e-20f; cosine *= 0.7f) {
    EXPECT_LE(glsl_float::fresnelDielectric(cosine, 1.0f), 1e-6f) << cosine;
    const vec3 wo(std::sqrt(1.0f - cosine * cosine), 0.0f, cosine);
    const vec3 through = glsl_float::refractThrough(wo, vec3(0, 0, 1), 1.0f);
    EXPECT_LE(glm::distance(through, -wo), 2e-7f) << cosine;
  }
  EXPECT_EQ(glsl_float::fresnelDielectric(0.0f, 1.0f), 0.0f);
}

TEST(ShaderFresnel, InFloatTheCriticalAngleIsABorderBetweenNumbers) {
  for (const float index : {1.0001f, 1.33f, 1.5f, 2.42f}) {
    const float eta = 1.0f / index;
    float cosine = float(std::sqrt(1.0 - double(eta) * double(eta)));
    for (int i = 0; i < 200; ++i) cosine = std::nextafter(cosine, 0.0f);
    int reflected = 0;
    for (int i = 0; i < 400; ++i) {
      const float fresnel = glsl_float::fresnelDielectric(cosine, eta);
      EXPECT_TRUE(fresnel >= 0.0f && fresnel <= 1.0f) << index;
      reflected += fresnel == 1.0f ? 1 : 0;
      // A ray that passes by rounding alone goes along the boundary.
      const vec3 wo(std::sqrt(1.0f - cosine * cosine), 0.0f, cosine);
      const vec3 through = glsl_float::refractThrough(wo, vec3(0, 0, 1), eta);
      EXPECT_NEAR(glm::length(through), 1.0f, 1e-6f);
      EXPECT_LE(through.z, 1e-6f);
      EXPECT_GT(through.z, -0.02f);
      cosine = std::nextafter(cosine, 1.0f);
    }
    EXPECT_GT(reflected, 20) << index;
    EXPECT_LT(reflected, 380) << index;
  }
}

TEST(ShaderFresnel, WaterBendsThirtyDegreesToTwentyTwo) {
  const dvec3 wo(0.5, 0.0, std::sqrt(0.75));
  const dvec3 refracted = refractThrough(wo, dvec3(0, 0, 1), 1.33);
  EXPECT_NEAR(std::atan2(-refracted.x, -refracted.z) * 180.0 / M_PI, 22.08241, 1e-5);
}

TEST(ShaderFresnel, TotalInternalReflectionBeginsAtTheCriticalAngle) {
  for (double eta : {1.0 / 1.33, 1.0 / 1.5, 1.0 / 2.42}) {
    const double critical = std::asin(eta);
    for (double beyond : {-0.1, -1e-3, -1e-6, 1e-6, 1e-3, 0.1}) {
      const double angle = critical + beyond;
      const dvec3 refracted = refractThrough(dvec3(std::sin(angle), 0, std::cos(angle)), dvec3(0, 0, 1), eta);
      const double reflectance = fresnelDielectric(std::cos(angle), eta);
      if (beyond > 0.0) {
        EXPECT_LE(glm::distance(refracted, dvec3(-1.0, 0.0, 0.0)), kTolerance);
        EXPECT_EQ(reflectance, 1.0);
        EXPECT_EQ(schlickDielectric(std::cos(angle), eta), 1.0);
      } else {
        EXPECT_NEAR(glm::length(refracted), 1.0, kTolerance);
        EXPECT_LT(reflectance, 1.0);
      }
    }
  }
}

TEST(ShaderFresnel, ReflectanceRisesToOneAtTheCriticalAngle) {
  for (double eta : {1.0 / 1.33, 1.0 / 1.5, 1.0 / 2.42}) {
    // It falls from 1 as the square root of the distance, so this close it is this near.
    EXPECT_NEAR(fresnelDielectric(std::cos(std::asin(eta) - 1e-10), eta), 1.0, 3e-4);
    EXPECT_LT(fresnelDielectric(std::cos(std::asin(eta) - 1e-2), eta), 0.9);
  }
}

TEST(ShaderFresnel, ReflectanceAtNormalIncidenceIsTheSquareOfTheIndices) {
  for (double eta : kIndices) EXPECT_NEAR(fresnelDielectric(1.0, eta), normalReflectance(eta), kTolerance);
  EXPECT_NEAR(fresnelDielectric(1.0, 1.5), 0.04, kTolerance);
}

TEST(ShaderFresnel, ReflectanceAtGrazingIncidenceIsOne) {
  for (double eta : kIndices) EXPECT_NEAR(fresnelDielectric(0.0, eta), 1.0, kTolerance);
}

TEST(ShaderFresnel, ParallelPartVanishesAtBrewstersAngle) {
  for (double eta : kIndices) {
    const double cosine = std::cos(std::atan(eta));
    // Half of the perpendicular part remains, ((eta^2 - 1) / (eta^2 + 1))^2.
    const double perpendicular = (eta * eta - 1.0) / (eta * eta + 1.0);
    EXPECT_NEAR(fresnelDielectric(cosine, eta), 0.5 * perpendicular * perpendicular, kTolerance);
  }
}

TEST(ShaderFresnel, IsTheClosedFormAtEveryAngle) {
  for (double eta : kIndices) {
    const double largest = std::asin(std::min(1.0, eta));
    for (int step = 1; step < 1000; ++step) {
      const double incident = largest * step / 1000.0;
      EXPECT_NEAR(fresnelDielectric(std::cos(incident), eta), fresnelByAngles(incident, eta), 1e-9);
    }
  }
}

TEST(ShaderFresnel, BothSidesOfABoundaryReflectAlike) {
  for (double eta : {1.33, 1.5, 2.42}) {
    for (int step = 0; step < 1000; ++step) {
      const double incident = 0.5 * M_PI * step / 1000.0;
      const double refracted = std::asin(std::sin(incident) / eta);
      EXPECT_NEAR(fresnelDielectric(std::cos(incident), eta),
                  fresnelDielectric(std::cos(refracted), 1.0 / eta), 1e-10);
      EXPECT_NEAR(schlickDielectric(std::cos(incident), eta),
                  schlickDielectric(std::cos(refracted), 1.0 / eta), 1e-10);
    }
  }
}

TEST(ShaderFresnel, EqualIndicesReflectNothing) {
  for (double cosine : {1.0, 0.5, 0.01}) {
    EXPECT_NEAR(fresnelDielectric(cosine, 1.0), 0.0, kTolerance);
    const dvec3 wo(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
    EXPECT_LE(glm::distance(refractThrough(wo, dvec3(0, 0, 1), 1.0), -wo), kTolerance);
  }
}

TEST(ShaderFresnel, SchlickIsF0AtNormalAndF90AtGrazingIncidence) {
  const dvec3 f0(0.04, 0.5, 0.9);
  EXPECT_EQ(fresnelSchlick(f0, 1.0, 1.0), f0);
  EXPECT_LE(glm::distance(fresnelSchlick(f0, 1.0, 0.0), dvec3(1.0)), kTolerance);
  EXPECT_LE(glm::distance(fresnelSchlick(f0, 0.3, 0.0), dvec3(0.3)), kTolerance);
  EXPECT_LE(glm::distance(fresnelSchlick(f0, 1.0, 0.5), f0 + (dvec3(1.0) - f0) / 32.0), kTolerance);
  for (double eta : {1.33, 1.5, 2.42}) {
    EXPECT_NEAR(schlickDielectric(1.0, eta), normalReflectance(eta), kTolerance);
    EXPECT_NEAR(schlickDielectric(0.0, eta), 1.0, kTolerance);
  }
}

TEST(ShaderFresnel, SchlickIsWithinSevenHundredthsOfTheExactReflectance) {
  for (double eta : {1.33, 1.5, 1.8}) {
    for (int step = 0; step <= 1000; ++step) {
      const double cosine = step / 1000.0;
      EXPECT_NEAR(schlickDielectric(cosine, eta), fresnelDielectric(cosine, eta), 0.07);
    }
  }
}

TEST(ShaderFresnel, ThinWallCountsAllReflectionsBetweenItsSides) {
  for (double single : {0.0, 0.04, 0.3, 0.9, 1.0}) {
    // R + (1 - R)^2 R (1 + R^2 + R^4 + ...).
    double sum = single;
    double inside = (1.0 - single) * single;
    for (int bounce = 0; bounce < 2000; ++bounce) {
      sum += inside * (1.0 - single);
      inside *= single * single;
    }
    EXPECT_NEAR(thinReflectance(single), sum, kTolerance);
  }
}

TEST(ShaderFresnel, MirrorDirectionKeepsTheAngleAndThePlane) {
  Draw draw(2);
  for (int i = 0; i < 1000; ++i) {
    const dvec3 normal = draw.direction();
    const dvec3 wo = draw.direction();
    const dvec3 mirrored = mirrorDirection(wo, normal);
    EXPECT_NEAR(glm::dot(mirrored, normal), glm::dot(wo, normal), kTolerance);
    EXPECT_LE(glm::distance(glm::cross(mirrored, normal), -glm::cross(wo, normal)), kTolerance);
  }
}

TEST(ShaderFresnel, FloatIsWithinAMillionthOfDoubleExceptNearTheCriticalAngle) {
  for (double eta : kIndices) {
    const float index = float(eta);
    for (int step = 0; step <= 4096; ++step) {
      const float cosine = float(step) / 4096.0f;
      // The square root of what is left to the critical angle divides the rounding error by itself.
      const double left = 1.0 - (1.0 - double(cosine) * cosine) / (double(index) * index);
      const double bound = 1e-6 + 6e-7 / std::sqrt(std::max(std::abs(left), 1e-7));
      EXPECT_NEAR(glsl_float::fresnelDielectric(cosine, index), fresnelDielectric(cosine, index), bound)
          << "cosine " << cosine << ", eta " << eta;
      EXPECT_NEAR(glsl_float::schlickDielectric(cosine, index), schlickDielectric(cosine, index), bound)
          << "cosine " << cosine << ", eta " << eta;
    }
  }
}

}  // namespace
}  // namespace fragtrace
