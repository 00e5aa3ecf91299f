// SPDX-License-Identifier: MIT
#include "session/shutter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/errors.h"
#include "base/text.h"
#include "base/vectors.h"
#include "scene/camera.h"
#include "scene/fit.h"
#include "scene/parts.h"
#include "scene/strokes.h"
#include "session/environment.h"
#include "session/say.h"
#include "shader/layout.h"
#include "view/camera_controller.h"

namespace fragtrace {

namespace {

constexpr double kBeside = 1.1;  ///< points within this many times the picture's size still count

/// Places of points in a camera's picture, in pixels.
class PixelMeasure {
 public:
  PixelMeasure(const Camera& camera, glm::ivec2 size)
      : projection_(projectionOf(camera, double(size.x) / size.y)), half_(0.5 * glm::dvec2(size)) {}

  bool isRound() const { return !isRectilinear(projection_.type); }

  /// Negative where a point is beyond the plane: those of the picture's sides, and that of the camera.
  std::array<double, 5> sides(const glm::dvec3& point) const {
    const glm::dvec3 p = projected(projection_, point);
    const double w = kBeside * p.z;
    return {p.z - 1e-9, w - p.x, w + p.x, w - p.y, w + p.y};
  }

  bool sees(const glm::dvec3& point) const {
    if (isRound()) return true;
    return std::ranges::all_of(sides(point), [](double side) { return side >= 0.0; });
  }

  /// The distance between the place of `a` in this picture and that of `b` in another one.
  double between(const glm::dvec3& a, const PixelMeasure& other, const glm::dvec3& b) const {
    if (isRound()) {
      const glm::dvec3 p = along(a);
      const glm::dvec3 q = other.along(b);
      return half_.y / glm::length(projection_.up) *
             std::atan2(glm::length(glm::cross(p, q)), glm::dot(p, q));
    }
    const glm::dvec3 p = projected(projection_, a);
    const glm::dvec3 q = projected(other.projection_, b);
    if (p.z <= 0.0 || q.z <= 0.0) return 2.0 * glm::length(half_);
    return glm::length((glm::dvec2(p) / p.z - glm::dvec2(q) / q.z) * half_);
  }

 private:
  /// The direction to a point in the camera's own axes.
  glm::dvec3 along(const glm::dvec3& point) const {
    const glm::dvec3 view = glm::normalize(point - projection_.position);
    return {glm::dot(view, glm::normalize(projection_.right)), glm::dot(view, glm::normalize(projection_.up)),
            glm::dot(view, projection_.forward)};
  }

  Projection projection_;
  glm::dvec2 half_;
};

/// A moment within its segment, and the poses between which that moves straight.
struct Between {
  const Pose& from;
  const Pose& there;
  const Pose& to;
  double part;
};

/// Calls `check` for each moment that lies within a segment.
template <typename Check>
void forEachWithin(const Moments& moments, uint32_t segments, const Check& check) {
  for (const auto& [time, moment] : moments) {
    const double place = time * segments;
    const double segment = std::min(std::floor(place), double(segments - 1));
    const double part = place - segment;
    if (part == 0.0 || part == 1.0) continue;
    check(Between{moments.at(segment / segments).pose, moment.pose,
                  moments.at((segment + 1.0) / segments).pose, part});
  }
}

/// A point of a triangle by the weights of its corners.
glm::dvec3 pointAt(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& weights) {
  return weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2];
}

/// Weights of the corners of the part of a triangle that is in the picture (Sutherland and Hodgman, Reentrant
/// Polygon Clipping, 1974).
std::vector<glm::dvec3> visiblePart(const std::array<glm::dvec3, 3>& corners, const PixelMeasure& measure) {
  std::vector<glm::dvec3> part{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  for (size_t side = 0; side < 5 && !part.empty(); ++side) {
    std::vector<glm::dvec3> inside;
    for (size_t i = 0; i < part.size(); ++i) {
      const glm::dvec3& a = part[i];
      const glm::dvec3& b = part[(i + 1) % part.size()];
      const double atA = measure.sides(pointAt(corners, a))[side];
      const double atB = measure.sides(pointAt(corners, b))[side];
      if (atA >= 0.0) inside.push_back(a);
      if ((atA >= 0.0) != (atB >= 0.0)) inside.push_back(glm::mix(a, b, atA / (atA - atB)));
    }
    part = std::move(inside);
  }
  return part;
}

double surfacesOffAt(const Between& b, const Scene& scene, const PixelMeasure& measure) {
  const auto straight = [&](size_t i) {
    return scene.space.worldOf(
        glm::mix(glm::dvec3(b.from.vertices.position[i]), glm::dvec3(b.to.vertices.position[i]), b.part));
  };
  const auto there = [&](size_t i) { return scene.space.worldOf(glm::dvec3(b.there.vertices.position[i])); };
  double most = 0.0;
  std::vector<bool> seen(b.there.vertices.position.size());
  for (size_t i = 0; i < seen.size(); ++i) {
    seen[i] = measure.sees(there(i));
    if (seen[i]) most = std::max(most, measure.between(there(i), measure, straight(i)));
  }
  for (size_t i = 0; i < b.there.spheres.size(); ++i) {
    const auto place = [&](const glm::dvec3& center) { return scene.space.worldOf(center); };
    const glm::dvec3 center =
        glm::mix(glm::dvec3(b.from.spheres[i].center), glm::dvec3(b.to.spheres[i].center), b.part);
    const glm::dvec3 right = place(glm::dvec3(b.there.spheres[i].center));
    if (measure.sees(right)) most = std::max(most, measure.between(right, measure, place(center)));
  }
  if (measure.isRound()) return most;
  for (const Triangle& t : scene.triangles) {
    const glm::uvec3& v = t.vertex;
    if (seen[v.x] && seen[v.y] && seen[v.z]) continue;
    const std::array<glm::dvec3, 3> corners{there(v.x), there(v.y), there(v.z)};
    const std::array<glm::dvec3, 3> ours{straight(v.x), straight(v.y), straight(v.z)};
    for (const glm::dvec3& weights : visiblePart(corners, measure))
      most = std::max(most, measure.between(pointAt(corners, weights), measure, pointAt(ours, weights)));
  }
  return most;
}

/// Pixels by which the most distant point that the camera sees is off its way at any of these moments, if
/// surfaces move in `segments` straight segments; the moments between which they move are among them. Points
/// of triangles that reach beyond the picture count where they are in it. `camera` is that of the picture.
double surfacesOff(const Moments& moments, uint32_t segments, const Scene& scene, const Camera& camera,
                   glm::ivec2 size) {
  const PixelMeasure measure(camera, size);
  double most = 0.0;
  forEachWithin(moments, segments,
                [&](const Between& b) { most = std::max(most, surfacesOffAt(b, scene, measure)); });
  return most;
}

/// The largest part of its area that an emissive triangle loses, or gains, since it moves straight.
double lampsOff(const Moments& moments, uint32_t segments, const Scene& scene) {
  double most = 0.0;
  forEachWithin(moments, segments, [&](const Between& b) {
    for (const Triangle& t : scene.triangles) {
      if (!scene.materials[t.material].emissive()) continue;
      std::array<glm::dvec3, 3> right;
      std::array<glm::dvec3, 3> ours;
      for (int i = 0; i < 3; ++i) {
        const uint32_t v = t.vertex[i];
        right[size_t(i)] = b.there.vertices.position[v];
        ours[size_t(i)] =
            glm::mix(glm::dvec3(b.from.vertices.position[v]), glm::dvec3(b.to.vertices.position[v]), b.part);
      }
      const double area = areaOf(right);
      if (area > 0.0) most = std::max(most, std::abs(areaOf(ours) / area - 1.0));
    }
  });
  return most;
}

/// Pixels by which a camera that moves in such segments shows something in another place than at any of these
/// moments: vertices of the scene, or what is far away.
double cameraOff(const Moments& moments, std::span<const CameraSegment> segments, const Scene& scene,
                 glm::ivec2 size) {
  constexpr size_t kMostPoints = 2000;
  constexpr double kFar = 1e6;
  double most = 0.0;
  for (const auto& [time, moment] : moments) {
    const Camera ours = segments.empty() ? moments.begin()->second.camera : cameraAt(segments, time);
    const PixelMeasure right(moment.camera, size);
    const PixelMeasure measure(ours, size);
    const auto check = [&](const glm::dvec3& point) {
      if (right.sees(point)) most = std::max(most, right.between(point, measure, point));
    };
    // Points far away show turns of the camera. Points at the distance of the scene show its other motion.
    const double focal = glm::distance(moment.camera.position, focalPointOf(moment.camera, scene.bounds));
    for (const double distance : {focal, kFar * focal}) {
      check(moment.camera.position + distance * moment.camera.forward);
      check(moment.camera.position + distance * (moment.camera.forward + 0.2 * moment.camera.up));
    }
    const std::vector<glm::vec3>& vertices = moment.pose.vertices.position;
    const size_t step = vertices.size() / kMostPoints + 1;
    for (size_t i = 0; i < vertices.size(); i += step) check(scene.space.worldOf(glm::dvec3(vertices[i])));
  }
  return most;
}

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
  if (options.output.sequence.turntable > 0) return options;
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
                               overrides, filled.bounds, framedAspect(options.camera));
  const glm::ivec2 size = chooseSize(camera, options);
  if (overrides.fit) camera = fitCamera(camera, filled.points, overrides, size);
  const glm::dvec2 fade = shadowFadeOf(options, overrides, camera, filled.points.scene, size);
  if (fade != glm::dvec2(0.0)) options.light.shadowFade = fade;
  options.camera.overrides = asPlaced(camera, filled.bounds);
  return options;
}

CameraOverrides asPlaced(const Camera& camera, const BoundsDouble& bounds) {
  CameraOverrides all = overridesOf(poseOf(camera, bounds));
  all.viewUp = camera.up;
  return all;
}

}  // namespace fragtrace
