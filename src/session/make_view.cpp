// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "bvh/bvh.h"
#include "bvh/exact_tracer.h"
#include "scene/scene.h"
#include "session/setup.h"

namespace fragtrace {

namespace {

constexpr int kMostHits = 256;

uint32_t materialOf(const Scene& scene, uint32_t primitive) {
  const size_t triangles = scene.triangles.size();
  return primitive < triangles ? scene.triangles[primitive].material
                               : scene.spheres[primitive - triangles].material;
}

/// The material of the solid that a point of local space lies in: of the first whose boundary a ray leaves
/// without having entered. None where it lies in no solid, or the scene has no tree.
std::optional<uint32_t> solidAround(const Scene& scene, const Bvh& bvh, const glm::dvec3& point) {
  if (bvh.leaves.empty()) return std::nullopt;
  const ExactTracer tracer(scene, bvh);
  // The direction is along no axis, so that it runs along no wall.
  const glm::dvec3 direction = glm::normalize(glm::dvec3(0.2113, 0.9371, 0.2776));
  std::map<uint32_t, int> entered;
  glm::dvec3 origin = point;
  for (int hits = 0; hits < kMostHits; ++hits) {
    const Ray ray{glm::vec3(origin), glm::vec3(direction), std::numeric_limits<float>::max()};
    // Without nodes there is no tree, but a list (listLeaves).
    const ExactHit hit = bvh.nodes.empty() ? tracer.nearestOfAll(ray) : tracer.nearest(ray);
    if (hit.primitive == kMissIndex) return std::nullopt;
    const glm::dvec3 there = origin + hit.t * direction;
    const uint32_t index = materialOf(scene, hit.primitive);
    const Material& material = scene.materials[index];
    if (material.solid() && material.passesLight()) {
      const bool leaves = glm::dot(tracer.normal(hit.primitive, there, hit.instance), direction) > 0.0;
      if (leaves && entered[index] == 0) return index;
      entered[index] += leaves ? -1 : 1;
    }
    origin = there + direction * (4.0 * tracer.pointError(hit.primitive));
  }
  return std::nullopt;
}

Lens lensOf(const RenderOptions& options, const Camera& camera, const BoundsDouble& bounds,
            const LocalSpace& space) {
  Lens lens;
  if (!options.camera.lens.fStop || camera.type != CameraType::Perspective) return lens;
  lens.radius = 0.5 * focalLengthOf(camera.fovY) / *options.camera.lens.fStop;
  const glm::dvec3 focalPoint = options.camera.overrides.focalPoint.value_or(focalPointOf(camera, bounds));
  lens.focusDistance =
      options.camera.lens.focusDistance.value_or(glm::dot(focalPoint - camera.position, camera.forward));
  // Beyond, rays are parallel, and the squares of longer ones are no floats.
  constexpr double kParallel = 0x1p50;  // local space
  lens.focusDistance = std::min(lens.focusDistance, kParallel * space.unit);
  lens.blades = options.camera.lens.blades;
  return lens;
}

}  // namespace

Fog fogOf(const FogOptions& options, const BoundsDouble& bounds) {
  constexpr double kReach = 1.5;  // the reach in radii of the ball round the scene's box
  Fog fog;
  fog.extinction = options.density;
  fog.albedo = options.color.value_or(glm::vec3(1.0f));
  fog.anisotropy = float(options.anisotropy);
  fog.height = options.height.value_or(fog.height);
  fog.base = options.base.value_or(bounds.empty() ? 0.0 : bounds.minimum.y);
  if (!bounds.empty()) fog.center = bounds.center();
  fog.radius = options.distance.value_or(kReach * 0.5 * glm::length(bounds.extent()));
  return fog;
}

View makeView(const RenderOptions& options, const LoadedScene& loaded, const Camera& camera) {
  const Scene& scene = loaded.scene;
  View view;
  view.camera = camera;
  view.motion = loaded.motion;
  view.lens = lensOf(options, camera, scene.bounds, scene.space);
  view.space = scene.space;
  view.hdriRotation = glm::radians(environmentTurn(options.light));
  view.hdriIntensity = options.light.hdriIntensity;
  if (options.light.background) view.background = options.light.backgroundColor.value_or(glm::vec3(0.0f));
  const bool map = loaded.environment.kind == Surroundings::Map;
  view.showEnvironment = map && options.light.background && !options.light.backgroundColor;
  view.seesNothing = !options.light.background;
  if (std::ranges::any_of(scene.materials, &Material::scattersInside))
    view.cameraMedium = solidAround(scene, loaded.bvh, scene.space.localOf(camera.position));
  view.volume = scene.volume;
  view.volume.grid.reset();
  view.fog = fogOf(options.fog, scene.bounds);
  view.catcherHeight = catcherHeightOf(options, scene.bounds);
  view.bounces = options.sampling.bounces;
  view.rouletteDepth = options.sampling.rouletteDepth;
  view.seed = options.sampling.seed;
  view.sampleOffset = options.sampling.sampleOffset;
  view.clampIndirect = float(options.sampling.clampIndirect);
  return view;
}

}  // namespace fragtrace
