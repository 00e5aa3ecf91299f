// SPDX-License-Identifier: MIT
#include <algorithm>
#include <vector>

#include "scene/scene.h"
#include "session/setup.h"

namespace fragtrace {

namespace {

/// Frame::cameraSolids of a camera at this point of local space.
uint32_t cameraSolids(const Solids& solids, const glm::dvec3& point) {
  const std::vector<uint32_t> around = solidsAround(solids, point);
  if (around.empty()) return layout::kPrimitiveNone;
  constexpr uint32_t kNoOuter = 0xffff;
  return solids.nested ? around[0] | (around.size() > 1 ? around[1] : kNoOuter) << 16 : around[0];
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
  view.lens = lensOf(options, camera, loaded.framed, scene.space);
  view.space = scene.space;
  view.hdriRotation = glm::radians(environmentTurn(options.light));
  view.hdriIntensity = options.light.hdriIntensity;
  if (options.light.background) view.background = options.light.backgroundColor.value_or(glm::vec3(0.0f));
  const bool map = loaded.environment.kind == Surroundings::Map;
  view.showEnvironment = map && options.light.background && !options.light.backgroundColor;
  view.seesNothing = !options.light.background;
  view.cameraSolids = cameraSolids(scene.solids, scene.space.localOf(camera.position));
  view.volume = scene.volume;
  view.volume.grid.reset();
  view.fog = fogOf(options.fog, scene.bounds);
  view.catcherHeight = catcherHeightOf(options, scene.bounds);
  view.shadowFade = options.light.shadowFade.value_or(loaded.shadowFade);
  view.bounces = options.sampling.bounces;
  view.rouletteDepth = options.sampling.rouletteDepth;
  view.seed = options.sampling.seed;
  view.sampleOffset = options.sampling.sampleOffset;
  view.needsLightPaths = options.light.caustics == Caustics::On;
  view.clampIndirect = float(options.sampling.clampIndirect);
  return view;
}

}  // namespace fragtrace
