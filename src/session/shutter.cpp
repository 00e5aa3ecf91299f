// SPDX-License-Identifier: MIT
#include "session/shutter.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>

#include "base/text.h"
#include "scene/camera.h"
#include "scene/motion/moving_scene.h"
#include "scene/projection.h"
#include "scene/strokes.h"

namespace fragtrace {

namespace {

constexpr uint32_t kMostSegments = 32;
constexpr size_t kMostTriangles = size_t(1) << 26;  ///< of all segments
constexpr double kMostPixels = 0.5;

/// Poses by their time, 0 where the shutter opens and 1 where it closes.
using Poses = std::map<double, Pose>;

/// The distance between points of the picture in which a camera sees two points of the world, in pixels; 0
/// where it sees neither in the picture, or within a picture's size beside it.
class PixelMeasure {
 public:
  PixelMeasure(const Camera& camera, glm::ivec2 size)
      : projection_(projectionOf(camera, double(size.x) / size.y)), half_(0.5 * glm::dvec2(size)) {}

  double between(const glm::dvec3& a, const glm::dvec3& b) const {
    if (!isRectilinear(projection_.type)) return roundly(a, b);
    const glm::dvec3 p = projected(projection_, a);
    const glm::dvec3 q = projected(projection_, b);
    if (p.z <= 0.0 || q.z <= 0.0) return 0.0;
    const glm::dvec2 placeP = glm::dvec2(p) / p.z;
    const glm::dvec2 placeQ = glm::dvec2(q) / q.z;
    constexpr double kBeside = 3.0;
    const glm::dvec2 nearer = glm::min(glm::abs(placeP), glm::abs(placeQ));
    if (std::max(nearer.x, nearer.y) > kBeside) return 0.0;
    return glm::length((placeP - placeQ) * half_);
  }

 private:
  /// Of a panorama or a fisheye, as far from the poles as a pixel is as wide as high.
  double roundly(const glm::dvec3& a, const glm::dvec3& b) const {
    const glm::dvec3 p = glm::normalize(a - projection_.position);
    const glm::dvec3 q = glm::normalize(b - projection_.position);
    const double pixelsPerRadian = half_.y / glm::length(projection_.up);
    return pixelsPerRadian * std::atan2(glm::length(glm::cross(p, q)), glm::dot(p, q));
  }

  Projection projection_;
  glm::dvec2 half_;
};

/// The most pixels by which a vertex is off if it moves straight from a to b, when `middle` is where it is
/// halfway.
double pixelsOff(const Pose& a, const Pose& middle, const Pose& b, double part, const LocalSpace& space,
                 const PixelMeasure& measure) {
  double most = 0.0;
  const auto check = [&](const glm::vec3& from, const glm::vec3& there, const glm::vec3& to) {
    const glm::dvec3 straight = glm::mix(glm::dvec3(from), glm::dvec3(to), part);
    most = std::max(most, measure.between(space.worldOf(straight), space.worldOf(glm::dvec3(there))));
  };
  for (size_t i = 0; i < a.vertices.position.size(); ++i)
    check(a.vertices.position[i], middle.vertices.position[i], b.vertices.position[i]);
  for (size_t i = 0; i < a.spheres.size(); ++i)
    check(a.spheres[i].center, middle.spheres[i].center, b.spheres[i].center);
  return most;
}

/// Reads the poses of a scene.
class PoseReader {
 public:
  PoseReader(const LoadedScene& loaded, const RenderOptions& options, std::shared_ptr<KeptDocument>& document)
      : loaded_(loaded), options_(options), document_(document) {
    options_.camera.sceneOrigin = loaded.scene.space.origin;
  }

  /// Returns false if the pose at that time, 0..1, has other triangles than the scene.
  bool read(double time) {
    if (poses_.contains(time)) return true;
    const double seconds = shutterSeconds(options_);
    GltfOptions loading = gltfOptionsOf(options_);
    loading.selection.animationTime = *options_.selection.animationTime + (time - 0.5) * seconds;
    loading.readsVolume = false;
    Scene scene = loadGltf(options_.scene, loading, &document_);
    addStrokes(scene, loaded_.camera, loaded_.size, options_.camera.lineWidth);
    const bool sameCount = scene.triangles.size() == loaded_.scene.triangles.size();
    Pose pose = poseOf(std::move(scene), loaded_.scene.space);
    if (!sameCount || !matches(pose, loaded_.scene)) return false;
    poses_.emplace(time, std::move(pose));
    return true;
  }

  bool readAll(uint32_t count) {
    for (uint32_t i = 0; i <= count; ++i) {
      if (!read(double(i) / count)) return false;
    }
    return true;
  }

  Poses& poses() { return poses_; }

 private:
  const LoadedScene& loaded_;
  RenderOptions options_;
  std::shared_ptr<KeptDocument>& document_;
  Poses poses_;
};

/// The most pixels by which a vertex leaves its way at any time that was read, if it moves in so many
/// segments.
double pixelsOff(const Poses& poses, uint32_t segments, const LocalSpace& space,
                 const PixelMeasure& measure) {
  double most = 0.0;
  for (const auto& [time, pose] : poses) {
    const double place = time * segments;
    const double segment = std::min(std::floor(place), double(segments - 1));
    const double part = place - segment;
    if (part == 0.0 || part == 1.0) continue;
    most = std::max(most, pixelsOff(poses.at(segment / segments), pose, poses.at((segment + 1.0) / segments),
                                    part, space, measure));
  }
  return most;
}

/// The motion of a camera of the file.
CameraMotion motionOfCamera(const LoadedScene& loaded, const Pose& first, const Pose& last) {
  if (loaded.overrides.fit || loaded.overrides.orbit || first.cameras.empty()) return {};
  const auto chosen = [&](const Pose& pose) {
    return chooseCamera(pose.cameras, loaded.cameraIndex, loaded.overrides, loaded.scene.bounds);
  };
  return motionBetween(chosen(first), chosen(last));
}

}  // namespace

double shutterSeconds(const RenderOptions& options) {
  return options.selection.animationTime ? options.camera.shutter / 360.0 / options.output.sequence.fps : 0.0;
}

void openShutter(LoadedScene& loaded, const RenderOptions& options, std::shared_ptr<KeptDocument>& document,
                 Statistics& stats) {
  Scene& scene = loaded.scene;
  PoseReader reader(loaded, options, document);
  const auto still = [&](const std::string& reason) { stats.skipped.push_back("shutter: " + reason); };
  // Quarters, so that a motion to and fro is seen.
  if (!reader.readAll(4)) {
    scene.warnings.emplace_back(
        "--shutter: triangles come or go while it is open, so the picture shows one moment");
    return still("triangles come or go");
  }
  Poses& poses = reader.poses();
  const Pose& first = poses.at(0.0);
  loaded.motion = motionOfCamera(loaded, first, poses.at(1.0));
  scene.motion.camera = !loaded.motion.isNone();
  const auto standsStill = [&](const auto& entry) { return isSame(entry.second, first); };
  if (std::ranges::all_of(poses, standsStill)) {
    if (!scene.motion.camera) still("nothing moves while it is open");
    return;
  }
  const PixelMeasure measure(loaded.camera, loaded.size);
  uint32_t segments = 1;
  double off = pixelsOff(poses, segments, scene.space, measure);
  const size_t most = std::clamp(kMostTriangles / std::max<size_t>(1, scene.triangles.size()), size_t(1),
                                 size_t(kMostSegments));
  while (off > kMostPixels && 2 * segments <= most && reader.readAll(std::max(4u, 4 * segments))) {
    segments *= 2;
    off = pixelsOff(poses, segments, scene.space, measure);
  }
  if (off > kMostPixels) {
    scene.warnings.push_back(
        formatted("--shutter: surfaces move in %u straight pieces, up to %.2g pixels off "
                  "their way",
                  segments, off));
  }
  std::vector<Pose> kept;
  for (uint32_t i = 0; i <= segments; ++i) kept.push_back(std::move(poses.at(double(i) / segments)));
  stats.motionSegments = segments;
  stats.motionPixels = off;
  scene = movingScene(std::move(scene), kept);
}

}  // namespace fragtrace
