// SPDX-License-Identifier: MIT
#include "session/shutter.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "scene/camera.h"
#include "scene/strokes.h"
#include "session/ground.h"
#include "session/motion_error.h"
#include "shader/layout.h"

namespace fragtrace {

namespace {

constexpr uint32_t kMostSegments = layout::kMostCameraSegments;
constexpr size_t kMostTriangles = size_t(1) << 26;  ///< triangles of all segments together
constexpr size_t kMostKeys = 64;
constexpr double kMostPixels = 0.5;
constexpr double kMostOfLamp = 0.005;

/// Reads the scene at times of the shutter.
class MomentReader {
 public:
  MomentReader(const LoadedScene& loaded, const RenderOptions& options,
               std::shared_ptr<KeptDocument>& document)
      : loaded_(loaded), options_(options), document_(document), seconds_(shutterSeconds(options)) {
    options_.camera.sceneOrigin = loaded.scene.space.origin;
    if (document_) keys_ = keyTimesOf(*document_);
  }

  /// Returns false if the scene has other triangles at that time, 0..1.
  bool read(double time) {
    if (moments_.contains(time)) return true;
    GltfOptions loading = gltfOptionsOf(options_);
    loading.selection.animationTime = opens() + time * seconds_;
    if (!keys_.empty()) loading.shutter = {*options_.selection.animationTime, keys_.front(), keys_.back()};
    loading.readsVolume = false;
    Scene scene = loadGltf(options_.scene, loading, &document_);
    addGround(scene, options_, loaded_.scene.bounds);
    addStrokes(scene, loaded_.camera, loaded_.size, options_.camera.lineWidth);
    const bool sameCount = scene.triangles.size() == loaded_.scene.triangles.size();
    Pose pose = poseOf(std::move(scene), loaded_.scene.space);
    if (!sameCount || !matches(pose, loaded_.scene)) return false;
    const Camera camera = cameraOf(pose);
    moments_.emplace(time, Moment{std::move(pose), camera});
    return true;
  }

  bool readEach(uint32_t parts) {
    for (uint32_t i = 0; i <= parts; ++i) {
      if (!read(double(i) / parts)) return false;
    }
    return true;
  }

  /// Reads the scene at the keys of its animation, and halfway between two of them.
  bool readKeys() {
    std::vector<double> times{0.0};
    for (const double key : keys_) {
      const double time = (key - opens()) / seconds_;
      if (time > 1e-9 && time < 1.0 - 1e-9) times.push_back(time);
    }
    times.push_back(1.0);
    const size_t step = times.size() / kMostKeys + 1;
    for (size_t i = 0; i + 1 < times.size(); i += step) {
      const double next = times[std::min(i + step, times.size() - 1)];
      if (!read(times[i]) || !read(0.5 * (times[i] + next))) return false;
    }
    return read(1.0);
  }

  Moments& moments() { return moments_; }

 private:
  double opens() const { return *options_.selection.animationTime - 0.5 * seconds_; }

  /// The camera in a pose, with the lens that the picture has.
  Camera cameraOf(const Pose& pose) const {
    const bool placed = loaded_.overrides.fit || loaded_.overrides.orbit;
    Camera camera = loaded_.camera;
    if (placed || pose.cameras.empty()) return camera;
    const Camera moved =
        chooseCamera(pose.cameras, loaded_.cameraIndex, loaded_.overrides, loaded_.scene.bounds);
    camera.position = moved.position;
    camera.forward = moved.forward;
    camera.up = moved.up;
    return camera;
  }

  const LoadedScene& loaded_;
  RenderOptions options_;
  std::shared_ptr<KeptDocument>& document_;
  double seconds_;
  std::vector<double> keys_;  ///< times of the animation's keys, rising
  Moments moments_;
};

/// Returns the camera's segments, as few as keep it on its way.
std::vector<CameraSegment> segmentsOfCamera(MomentReader& reader, const LoadedScene& loaded, double& off) {
  std::vector<CameraSegment> segments;
  for (uint32_t count = 1; count <= kMostSegments && reader.readEach(std::max(4u, 2 * count)); count *= 2) {
    std::vector<Camera> poses;
    for (uint32_t i = 0; i <= count; ++i) poses.push_back(reader.moments().at(double(i) / count).camera);
    segments = segmentsThrough(poses);
    off = cameraOff(reader.moments(), segments, loaded.scene, loaded.size);
    if (off <= kMostPixels) break;
  }
  return segments;
}

void warnIfOff(Scene& scene, const char* what, uint32_t segments, double off) {
  if (off > kMostPixels)
    scene.warnings.push_back(
        formatted("--shutter: %s in %u pieces, up to %.2g pixels off the way", what, segments, off));
}

/// The number of segments that keep surfaces on their way, and lamps as bright as they are.
uint32_t segmentsOfSurfaces(MomentReader& reader, LoadedScene& loaded, double& off) {
  Scene& scene = loaded.scene;
  const size_t most = std::clamp(kMostTriangles / std::max<size_t>(1, scene.triangles.size()), size_t(1),
                                 size_t(kMostSegments));
  uint32_t segments = 1;
  double dimmer = 0.0;
  for (;; segments *= 2) {
    off = surfacesOff(reader.moments(), segments, scene, loaded.camera, loaded.size);
    dimmer = lampsOff(reader.moments(), segments, scene);
    const bool enough = off <= kMostPixels && dimmer <= kMostOfLamp;
    if (enough || 2 * segments > most || !reader.readEach(4 * segments)) break;
  }
  warnIfOff(scene, "surfaces move straight", segments, off);
  if (dimmer > kMostOfLamp) {
    scene.warnings.push_back(
        formatted("--shutter: lamps turn in %u straight pieces, whose area is up to %.2g %% off", segments,
                  100.0 * dimmer));
  }
  return segments;
}

}  // namespace

double shutterSeconds(const RenderOptions& options) {
  return options.selection.animationTime ? options.camera.shutter / 360.0 / options.output.sequence.fps : 0.0;
}

void openShutter(LoadedScene& loaded, const RenderOptions& options, std::shared_ptr<KeptDocument>& document,
                 Statistics& stats) {
  Scene& scene = loaded.scene;
  MomentReader reader(loaded, options, document);
  const auto still = [&](const std::string& reason) { stats.skipped.push_back("shutter: " + reason); };
  if (!reader.readEach(4) || !reader.readKeys()) {
    scene.warnings.emplace_back(
        "--shutter: triangles come or go while it is open, so the picture shows one moment");
    return still("triangles come or go");
  }
  Moments& moments = reader.moments();
  loaded.motion = segmentsOfCamera(reader, loaded, stats.motion.cameraPixels);
  stats.motion.cameraSegments = uint32_t(loaded.motion.size());
  warnIfOff(scene, "the camera moves", stats.motion.cameraSegments, stats.motion.cameraPixels);
  scene.motion.camera = !loaded.motion.empty();
  const auto standsStill = [&](const auto& entry) { return isSame(entry.second.pose, moments.at(0.0).pose); };
  if (std::ranges::all_of(moments, standsStill)) {
    if (!scene.motion.camera) still("nothing moves while it is open");
    return;
  }
  const uint32_t segments = segmentsOfSurfaces(reader, loaded, stats.motion.pixels);
  stats.motion.segments = segments;
  std::vector<Pose> kept;
  for (uint32_t i = 0; i <= segments; ++i) kept.push_back(std::move(moments.at(double(i) / segments).pose));
  scene = movingScene(std::move(scene), kept);
}

}  // namespace fragtrace
