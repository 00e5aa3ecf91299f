// SPDX-License-Identifier: MIT
// shaders/ggx.glsl and layers.glsl: drawn half vectors, without chance. The density is one over the area that
// a unit of the square of random numbers gets on the sphere.
#include <gtest/gtest.h>

#include "shader_layers_cases.h"

namespace fragtrace {
namespace {

/// The area on the unit sphere of the image of a unit of the square about (u, v), by central differences.
template <typename Map>
double areaPerUnit(Map map, double u, double v) {
  constexpr double kStep = 1e-5;
  const dvec3 along = map(u + kStep, v) - map(u - kStep, v);
  const dvec3 across = map(u, v + kStep) - map(u, v - kStep);
  return glm::length(glm::cross(along, across)) / (4.0 * kStep * kStep);
}

TEST(ShaderFacets, TheDensityIsOneOverTheAreaOfAUnitOfRandomNumbers) {
  for (const bool stretches : {false, true}) {
    const With anisotropy(glsl_variant::kAnisotropy, stretches);
    Draw draw(71);
    for (int k = 0; k < 2000; ++k) {
      const dvec3 o = draw.directionAbove();
      const double alpha = draw.between(0.05, 1.0);
      const double stretch = draw.between(1.0, 3.0);
      const double u = draw.between(0.01, 0.99);
      const double v = draw.between(0.05, 0.95);
      const auto facet = [&](double a, double b) {
        return glsl_double::sampleMicrofacet(o, alpha, stretch, a, b);
      };
      const double pdf = glsl_double::microfacetPdf(o, facet(u, v), alpha, stretch);
      EXPECT_NEAR(pdf * areaPerUnit(facet, u, v), 1.0, 1e-5)
          << "alpha " << alpha << ", stretch " << stretch << ", o.z " << o.z;
    }
  }
}

TEST(ShaderFacets, OfStretchedFacetsTheDensityIsThatOfTheirTwoWidths) {
  // Facets of width alpha x stretch along x have the slopes of isotropic ones, stretched; Heitz 2014,
  // section 5.3.
  const With anisotropy(glsl_variant::kAnisotropy, true);
  for (const double alpha : {0.1, 0.5}) {
    for (const double stretch : {1.5, 2.5}) {
      const double x = alpha * stretch;
      const double y = alpha / stretch;
      const dvec3 o = glm::normalize(dvec3(0.5, 0.3, 0.7));
      const dvec3 h = glm::normalize(dvec3(0.1, -0.2, 1.0));
      const double slopes = h.x * h.x / (x * x) + h.y * h.y / (y * y) + h.z * h.z;
      const double lambda =
          0.5 * (std::sqrt(1.0 + (o.x * o.x * x * x + o.y * o.y * y * y) / (o.z * o.z)) - 1.0);
      const double expected = glm::dot(o, h) / (o.z * (1.0 + lambda) * M_PI * x * y * slopes * slopes);
      EXPECT_NEAR(glsl_double::microfacetPdf(o, h, alpha, stretch), expected, 1e-12 * expected);
    }
  }
}

TEST(ShaderFacets, AClearcoatReflectsAtTheFacetsOfItsOwnWidth) {
  const AllExtensions on;
  const Bsdf b = coated(metal(0.3), 1.0, 0.6);
  Draw draw(73);
  for (int k = 0; k < 2000; ++k) {
    const dvec3 o = draw.directionAbove();
    const double u = draw.between(0.01, 0.99);
    const double v = draw.between(0.05, 0.95);
    const auto facet = [&](double first, double second) {
      return glm::normalize(o + glsl_double::drawCoat(b, o, 1.0, first, second).wi);
    };
    const double pdf = glsl_double::visibleGgxPdf(o, facet(u, v), b.coatAlpha);
    EXPECT_NEAR(pdf * areaPerUnit(facet, u, v), 1.0, 1e-5) << "o.z " << o.z;
  }
}

}  // namespace
}  // namespace fragtrace
