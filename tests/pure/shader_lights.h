// SPDX-License-Identifier: MIT
// A scene of emissive triangles round the origin with punctual lights, packed as for the GPU, and read by the
// shader's files.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "bvh/bvh.h"
#include "glsl_lights.h"
#include "pack/gpu_scene.h"
#include "pack/pack_tree.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::uvec2;
using glm::vec3;
using glsl_variant::With;

inline double luminanceOf(const dvec3& c) { return glm::dot(c, dvec3(0.2126, 0.7152, 0.0722)); }

inline Material emitting(const vec3& color, float strength, bool doubleSided) {
  Material m;
  m.emissiveFactor = color;
  m.emissiveStrength = strength;
  m.doubleSided = doubleSided;
  return m;
}

/// One triangle in each octant, its front to the origin, at distances and of shapes of their own, so that the
/// origin sees all of each. Materials: 0 emits from both sides, 1 from the front, 2 not at all.
inline Scene octantScene() {
  Scene scene;
  scene.materials = {emitting({1.0f, 0.5f, 0.2f}, 2.0f, true), emitting({0.3f, 0.6f, 1.0f}, 12.0f, false),
                     Material{}};
  Draw draw(167);
  for (uint32_t octant = 0; octant < 8; ++octant) {
    const dvec3 sign(octant & 1u ? 1.0 : -1.0, octant & 2u ? 1.0 : -1.0, octant & 4u ? 1.0 : -1.0);
    dvec3 p[3] = {{0.9, 0.2, 0.2}, {0.2, 0.9, 0.2}, {0.2, 0.2, 0.9}};
    for (dvec3& v : p) v *= draw.between(1.0, 4.0) * sign;
    if (glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), p[0]) > 0.0) std::swap(p[1], p[2]);
    if (octant == 6) p[2] = p[1];  // no area
    const auto first = uint32_t(scene.vertices.position.size());
    for (const dvec3& v : p) scene.vertices.position.emplace_back(v);
    Triangle t;
    t.vertex = {first, first + 1, first + 2};
    t.material = octant == 7 ? 2 : octant % 2;
    scene.triangles.push_back(t);
  }
  return scene;
}

/// A point light, a spot with a range, and a directional light.
inline std::vector<Light> threeLights() {
  Light point;
  point.intensity = {3, 2, 1};
  point.position = {0.5f, 1.5f, -0.25f};
  Light spot;
  spot.type = LightType::Spot;
  spot.intensity = {5, 9, 4};
  spot.position = {-1, 0.5f, 0.75f};
  spot.direction = glm::normalize(vec3(1.0f, -0.7f, -0.6f));
  spot.range = 3.0f;
  spot.innerConeAngle = 0.1f;  // the origin lies at 0.18
  spot.outerConeAngle = 0.4f;
  Light sun;
  sun.type = LightType::Directional;
  sun.intensity = {0.4f, 0.5f, 0.6f};
  sun.direction = glm::normalize(vec3(-0.2f, -1.0f, 0.3f));
  return {point, spot, sun};
}

/// A dim map, brighter above and brightest in one texel.
inline Image dimMap() {
  Image image;
  image.width = 16;
  image.height = 8;
  image.channels = {"R", "G", "B"};
  for (int i = 0; i < 16 * 8; ++i) {
    const float bright = i == 35 ? 20.0f : i < 64 ? 0.5f : 0.1f;
    for (float color : {1.0f, 0.8f, 0.6f}) image.values.push_back(bright * color);
  }
  return image;
}

/// A scene as the shader reads it, until the end of the scope.
class Lit {
 public:
  explicit Lit(const Scene& from, bool environment = false, LightSelection lights = LightSelection::Power)
      : scene(from),
        bvh(buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size()))),
        packed(packScene(scene, bvh, {Surroundings::Map, environment ? dimMap() : Image{}},
                         variantOf(scene, environment, lights))),
        leaves_(glsl_variant::leaves, packed.buffers[layout::kLeavesBinding]),
        faces_(glsl_variant::faces, packed.buffers[layout::kFacesBinding]),
        materials_(glsl_variant::materials, packed.buffers[layout::kMaterialsBinding]),
        emitters_(glsl_variant::emitters, packed.buffers[layout::kEmittersBinding]),
        lights_(glsl_variant::lights, packed.buffers[layout::kLightsBinding]),
        texels_(glsl_variant::environment, packed.buffers[layout::kEnvironmentBinding]),
        inversion_(glsl_variant::environmentInversion, packed.buffers[layout::kEnvironmentInversionBinding]),
        frame_(glsl_variant::frame, frameOf(packed)),
        punctual_(glsl_variant::kPunctualLights, !scene.lights.empty()),
        surrounded_(glsl_variant::kEnvironmentSampling, environment),
        tree_(glsl_variant::kLightTree, lights != LightSelection::Power) {}

  double areaOf(size_t triangle) const {
    const auto [a, b, c] = cornersOf<dvec3>(scene, scene.triangles[triangle]);
    return 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  dvec3 radianceOf(size_t triangle) const {
    const Material& m = scene.materials[scene.triangles[triangle].material];
    return dvec3(m.emissiveFactor) * double(m.emissiveStrength);
  }
  dvec3 normalOf(size_t triangle) const {
    const auto [a, b, c] = cornersOf<dvec3>(scene, scene.triangles[triangle]);
    return glm::normalize(glm::cross(b - a, c - a));
  }
  bool shines(size_t triangle) const {
    return luminanceOf(radianceOf(triangle)) > 0.0 && areaOf(triangle) > 0.0;
  }

  /// The triangle that a point lies on, and its barycentric weights of the second and the third corner.
  struct Place {
    size_t triangle;
    dvec2 weights;
  };
  std::optional<Place> placeOf(const dvec3& p) const {
    for (size_t i = 0; i < scene.triangles.size(); ++i) {
      if (!shines(i)) continue;
      const auto [a, b, c] = cornersOf<dvec3>(scene, scene.triangles[i]);
      const dvec3 n = glm::cross(b - a, c - a);
      const double squared = glm::dot(n, n);
      const double w1 = glm::dot(glm::cross(p - a, c - a), n) / squared;
      const double w2 = glm::dot(glm::cross(b - a, p - a), n) / squared;
      const double off = std::abs(glm::dot(p - a, n)) / std::sqrt(squared);
      if (off < 1e-5 && std::min({w1, w2, 1.0 - w1 - w2}) > -1e-5) return Place{i, {w1, w2}};
    }
    return std::nullopt;
  }

  Scene scene;
  Bvh bvh;
  GpuScene packed;

 private:
  static ShaderVariant variantOf(const Scene& scene, bool environment, LightSelection lights) {
    ShaderVariant v;
    v.traits.set(size_t(Trait::Emission)).set(size_t(Trait::EmissiveTriangles));
    v.traits.set(size_t(Trait::PunctualLights), !scene.lights.empty());
    v.traits.set(size_t(Trait::Environment), environment);
    v.traits.set(size_t(Trait::EnvironmentSampling), environment);
    v.traits.set(size_t(Trait::LightTree), lights != LightSelection::Power);
    v.uniformLights = lights == LightSelection::Uniform;
    return v;
  }
  /// Fills the frame as src/render/renderer.cpp does.
  static layout::Frame frameOf(const GpuScene& packed) {
    layout::Frame frame{};
    frame.environmentSize = packed.environmentSize;
    frame.environmentRotation = {1.0f, 0.0f};
    frame.environmentScale = 1.0f;
    frame.environmentChance = environmentChance(packed.lightShare, 1.0);
    frame.emitterCount = float(packed.emitterCount);
    frame.punctualCount = float(packed.punctualLights);
    return frame;
  }

  using Span = std::span<const uint32_t>;
  With<Span> leaves_;
  With<Span> faces_;
  With<Span> materials_;
  With<Span> emitters_;
  With<Span> lights_;
  With<Span> texels_;
  With<Span> inversion_;
  With<layout::Frame> frame_;
  With<bool> punctual_;
  With<bool> surrounded_;
  With<bool> tree_;
};

/// Solid angle of a triangle seen from the origin (Van Oosterom and Strackee, 1983).
inline double solidAngle(dvec3 a, dvec3 b, dvec3 c) {
  a = glm::normalize(a);
  b = glm::normalize(b);
  c = glm::normalize(c);
  const double volume = std::abs(glm::dot(a, glm::cross(b, c)));
  return 2.0 * std::atan2(volume, 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

/// Sums of draws, by which their mean and its standard error are known.
struct Estimate {
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;

  void add(double x) {
    sum += x;
    squares += x * x;
    count += 1.0;
  }
  double mean() const { return sum / count; }
  double error() const { return std::sqrt(std::max(0.0, squares / count - mean() * mean()) / count); }
};

}  // namespace
}  // namespace fragtrace
