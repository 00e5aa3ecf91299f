// SPDX-License-Identifier: MIT
#include "session/sequence_camera.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "scene/camera.h"
#include "scene/fit.h"
#include "scene/parts.h"
#include "session/caught_light.h"
#include "session/environment.h"
#include "session/file_light.h"
#include "session/say.h"
#include "session/setup.h"

namespace fragtrace {

namespace {

/// The space that the poses fill together, world space.
struct Filled {
  BoundsDouble bounds;
  FittedPoints points;  ///< whose hull is that of all, nearly
};

void append(std::vector<glm::dvec3>& all, std::vector<glm::dvec3> points) {
  std::ranges::copy(farthest(std::move(points)), std::back_inserter(all));
}

/// Seconds, over all of the animation; where its length is not known, those of the pictures asked for.
std::vector<double> timesOf(const Scene& scene, const RenderOptions& options) {
  constexpr double kPerSecond = 12.0;
  constexpr int kFewest = 8;
  constexpr int kMost = 48;
  const SequenceOptions& sequence = options.output.sequence;
  const std::optional<double> length = animationLength(scene, options.selection);
  const double first = length ? 0.0 : sequence.frames->first / sequence.fps;
  const double last = length.value_or(sequence.frames->last / sequence.fps);
  const int count = int(std::clamp(std::ceil((last - first) * kPerSecond), double(kFewest), double(kMost)));
  std::vector<double> times;
  for (int i = 0; i <= count; ++i) times.push_back(first + (last - first) * i / count);
  return times;
}

}  // namespace

std::optional<double> animationLength(const Scene& scene, const SceneSelection& selection) {
  std::optional<double> length;
  for (const size_t index : chosenAnimations(selection.animation, scene.animationNames)) {
    const std::optional<double>& seconds = scene.animationSeconds[index];
    if (!seconds) return std::nullopt;
    length = std::max(length.value_or(0.0), *seconds);
  }
  return length;
}

RenderOptions placedForAllPoses(RenderOptions options, std::shared_ptr<KeptDocument>& kept) {
  const CameraOverrides asked = options.camera.overrides;
  const bool placed = asked.asksForFit() || asked.orbit;
  RenderOptions posed = options;
  posed.selection.animationTime = 0.0;
  const Scene first = loadGltf(posed.scene, gltfOptionsOf(posed), &kept);
  if (first.animationNames.empty())
    throw UsageError("--frames: " + options.scene.string() + " has no animation");
  if (!placed && (asked.position || !first.cameras.empty())) return options;
  const CameraOverrides overrides = settledOverrides(asked, first);
  const bool shadow = fitsShadow(options, overrides);
  Environment environment;
  FileLight light;
  if (shadow) {
    std::vector<std::string> repeated;
    const SaidHere silence(repeated);  // the first picture's messages say it
    std::future<LinearImage> map;
    if (!options.light.hdriFile.empty())
      map = std::async(std::launch::deferred, [&] { return readMap(options); });
    light = fileLightOf(posed, first, nullptr, &kept);
    environment = makeEnvironment(options, map, countedLight(options, light), repeated);
  }
  Filled filled;
  double lowest = std::numeric_limits<double>::infinity();
  Volume volume;
  for (const double time : timesOf(first, options)) {
    posed.selection.animationTime = time;
    Scene scene = loadGltf(posed.scene, gltfOptionsOf(posed), &kept);
    placeVolume(scene, options, &volume);
    volume = scene.volume;
    setLampScale(scene, light.lampScale);
    if (scene.bounds.empty()) continue;
    if (!overrides.fit) {
      filled.bounds.include(scene.bounds);
      continue;
    }
    FittedPoints points = pointsToFit(scene, environment, options, overrides);
    filled.bounds.include(points.bounds);
    append(filled.points.scene, std::move(points.scene));
    append(filled.points.shadow, std::move(points.shadow));
    lowest = std::min(lowest, points.catcherHeight);
  }
  filled.points.catcherHeight = lowest;
  Camera camera = chooseCamera(first.cameras,
                               cameraIndexOf(options.camera.index, options.selection.camera, first.cameras),
                               overrides, filled.bounds, framedAspect(options));
  const glm::ivec2 size = chooseSize(camera, options);
  if (overrides.fit) camera = fitCamera(camera, filled.points, overrides, size);
  const glm::dvec2 fade = shadowFadeOf(options, overrides, camera, filled.points.scene, size);
  if (fade != glm::dvec2(0.0)) options.light.shadowFade = fade;
  options.camera.overrides = asPlaced(camera, filled.bounds);
  return options;
}

CameraOverrides asPlaced(const Camera& camera, const BoundsDouble& bounds) {
  CameraOverrides all;
  all.position = camera.position;
  all.focalPoint = focalPointOf(camera, bounds);
  all.viewUp = camera.up;
  if (camera.type == CameraType::Orthographic)
    all.parallelScale = camera.halfHeight;
  else if (camera.type != CameraType::Panorama)
    all.viewAngleDegrees = glm::degrees(camera.fovY);
  if (!isRectilinear(camera.type)) all.type = camera.type;
  if (camera.shift != glm::dvec2(0.0)) all.lensShift = camera.shift;
  return all;
}

}  // namespace fragtrace
