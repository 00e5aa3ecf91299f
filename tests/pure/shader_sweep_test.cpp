// SPDX-License-Identifier: MIT
// Every lobe of shaders/bsdf.glsl and layers.glsl in float, over random materials and directions that favour
// extremes: nothing that is not finite, nothing negative, no drawn direction that has a weight and no
// density. FRAGTRACE_SWEEP: inputs a lobe.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <sstream>

#include "shader_layers_cases.h"

namespace fragtrace {
namespace {

int inputsOfALobe() {
  const char* asked = std::getenv("FRAGTRACE_SWEEP");
  return asked ? std::atoi(asked) : 20'000;
}

/// 0, 1, nearly so, or anything between.
double extreme(Draw& draw) {
  switch (draw.integer(0, 5)) {
    case 0:
      return 0.0;
    case 1:
      return 1.0;
    case 2:
      return std::pow(10.0, draw.between(-8.0, 0.0));
    case 3:
      return 1.0 - std::pow(10.0, draw.between(-8.0, 0.0));
    default:
      return draw.between(0.0, 1.0);
  }
}

dvec3 extremeColor(Draw& draw) {
  const double grey = extreme(draw);
  return draw.integer(0, 1) == 0 ? dvec3(grey) : dvec3(grey, extreme(draw), extreme(draw));
}

/// Above the surface: grazing, straight up with what rounding adds, or anywhere.
vec3 extremeDirection(Draw& draw) {
  if (draw.integer(0, 7) == 0) return {0.0f, 0.0f, std::nextafter(1.0f, 2.0f)};
  const double z = std::max(1e-7, extreme(draw));
  const double phi = draw.between(0.0, 2.0 * M_PI);
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  return vec3(dvec3(r * std::cos(phi), r * std::sin(phi), z));
}

/// Makes a BSDF within the limits of scenes; the least roughness of sheen is that of material_layers.glsl.
Bsdf extremeBase(Draw& draw, double metallic, double transmission) {
  const double indices[] = {1.0, 1.0004, 1.33, 1.5, 2.5};
  Bsdf b = makeBsdf(metallic, transmission, extreme(draw), indices[draw.integer(0, 4)],
                    draw.integer(0, 1) == 0, draw.integer(0, 1) == 0);
  b.baseColor = extremeColor(draw);
  b.dielectricF0 *= extremeColor(draw);
  b.dielectricF90 = extreme(draw);
  return glsl_double::compensate(b);
}

struct Lobe {
  const char* name;
  std::function<Bsdf(Draw&)> make;
};

std::vector<Lobe> lobes() {
  const auto mixed = [](Draw& d) { return extremeBase(d, extreme(d), extreme(d)); };
  return {{"metal", [](Draw& d) { return extremeBase(d, 1.0, 0.0); }},
          {"plastic", [](Draw& d) { return extremeBase(d, 0.0, 0.0); }},
          {"glass", [](Draw& d) { return extremeBase(d, 0.0, 1.0); }},
          {"mixed", mixed},
          {"stretched", [=](Draw& d) { return stretched(mixed(d), extreme(d)); }},
          {"filmed",
           [=](Draw& d) { return filmed(mixed(d), d.between(1.0, 2.5), 1200.0 * extreme(d), extreme(d)); }},
          {"letting through", [=](Draw& d) { return letsThrough(mixed(d), extreme(d), extremeColor(d)); }},
          {"sheen", [=](Draw& d) { return sheened(mixed(d), extremeColor(d), std::max(0.05, extreme(d))); }},
          {"clearcoat",
           [=](Draw& d) { return coated(mixed(d), extreme(d), extreme(d), dvec3(extremeDirection(d))); }},
          {"all", [=](Draw& d) {
             Bsdf b = stretched(mixed(d), extreme(d));
             b = filmed(letsThrough(b, extreme(d), extremeColor(d)), 1.3, 800.0 * extreme(d), extreme(d));
             b = sheened(b, extremeColor(d), std::max(0.05, extreme(d)));
             return coated(b, extreme(d), extreme(d), dvec3(extremeDirection(d)));
           }}};
}

bool isSound(const vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && v.x >= 0.0f && v.y >= 0.0f &&
         v.z >= 0.0f;
}

std::string text(const vec3& v) {
  std::ostringstream out;
  out << '(' << v.x << ", " << v.y << ", " << v.z << ')';
  return out.str();
}

/// Returns the fault of one input, or an empty text.
std::string faultOf(const glsl_float::Bsdf& b, Draw& draw) {
  const vec3 out = extremeDirection(draw);
  vec3 in = extremeDirection(draw);
  if (draw.integer(0, 3) == 0) in = vec3(-out.x, -out.y, out.z);
  if (draw.integer(0, 2) == 0) in.z = -in.z;
  const glsl_float::BsdfValue value = glsl_float::evaluateBsdf(b, out, in);
  const std::string where = " for " + text(out) + " and " + text(in) + ", alpha " + std::to_string(b.alpha) +
                            ", sheen " + std::to_string(b.sheenAlpha) + ", coat " +
                            std::to_string(b.coatAlpha);
  if (!isSound(value.value)) return "value " + text(value.value) + where;
  if (!std::isfinite(value.pdf) || value.pdf < 0.0f) return "density " + std::to_string(value.pdf) + where;
  // Light in a direction that is never drawn would be missing from the picture. Weights below 1e-6 are lost
  // in rounding, however high and narrow the lobe that they weigh.
  const float highest = std::max(1.0f, 1.0f / (4.0f * float(M_PI) * b.alpha * b.alpha * out.z));
  if (value.pdf == 0.0f && std::max({value.value.x, value.value.y, value.value.z}) > 1e-6f * highest)
    return "value " + text(value.value) + " without pdf" + where;
  const float choice = draw.unit();
  const float u = draw.unit();
  const glsl_float::BsdfSample s = glsl_float::sampleBsdf(b, out, choice, u, draw.unit());
  if (!isSound(s.weight)) return "weight " + text(s.weight) + where;
  if (!std::isfinite(s.pdf) || s.pdf < 0.0f) return "drawn pdf " + std::to_string(s.pdf) + where;
  if (std::abs(glm::length(s.wi) - 1.0f) > 1e-3f) return "direction " + text(s.wi) + where;
  return {};
}

TEST(ShaderSweep, EveryLobeIsFiniteAndNotNegativeAtTheExtremes) {
  const AllExtensions on;
  for (const bool compensated : {false, true}) {
    const With compensation(glsl_variant::kCompensation, compensated);
    for (const Lobe& lobe : lobes()) {
      Draw draw(4711);
      int faults = 0;
      std::string first;
      for (int k = 0; k < inputsOfALobe() / 2; ++k) {
        const std::string fault = faultOf(toFloat(lobe.make(draw)), draw);
        if (!fault.empty() && faults++ == 0) first = fault;
      }
      EXPECT_EQ(faults, 0) << lobe.name << (compensated ? ", compensated: " : ": ") << first;
    }
  }
}

}  // namespace
}  // namespace fragtrace
