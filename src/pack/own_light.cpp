// SPDX-License-Identifier: MIT
#include "pack/own_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/gtc/constants.hpp>
#include <glm/gtx/component_wise.hpp>

#include "base/parallel.h"
#include "base/vectors.h"
#include "bvh/exact_tracer.h"
#include "pack/textures/pack_textures.h"
#include "scene/camera.h"

namespace fragtrace {

namespace {

constexpr int kCellSide = 16;                   // cells of a row and of a column
constexpr std::array kPathsSoFar = {1, 4, 16};  // of a cell, after each round
constexpr int kPathSurfaces = 4;                // of a path
constexpr int kMostPanes = 16;                  // that a ray passes
constexpr size_t kMostLamps = 4;                // that one point asks
constexpr double kMeanTexel = 0.5;              // stands for a texture that is not decoded
constexpr float kNoLimit = std::numeric_limits<float>::max();

/// Random numbers by a counter (splitmix64), so that each path has its own, whatever thread traces it.
class PathRandom {
 public:
  explicit PathRandom(uint64_t path) : state_(path * 0x9e3779b97f4a7c15u) {}
  double next() {
    uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return double((z ^ z >> 31) >> 11) * 0x1p-53;
  }

 private:
  uint64_t state_;
};

/// Sums over the paths of a cell.
struct CellSum {
  SeenCell sum;
  int surfaces = 0;
  int metals = 0;
  int open = 0;
};

/// Light by its origin.
struct Gathered {
  double byLamps = 0.0, byEmission = 0.0;
};

/// A surface that a ray has met.
struct SurfacePoint {
  glm::dvec3 place{0.0};
  glm::dvec3 normal{0.0};  ///< towards the ray's origin
  bool front = true;
  uint32_t primitive = kMissIndex;
  uint32_t instance = kMissIndex;
  double reach = 0.0;      ///< the distance from the surface at which rays begin
  glm::dvec3 passed{1.0};  ///< the part of the light that the panes before it let through
};

/// A textured surface that emits: its picture, coarse.
struct EmissivePicture {
  const PackedPicture* picture = nullptr;
  TexturePlace place{};
  glm::vec3 mean{0.0f};  ///< radiance
};

class LightEstimator {
 public:
  explicit LightEstimator(const SeenScene& seen);
  /// Adds a path through that place of the view.
  void trace(const Projection& projection, const glm::dvec2& place, PathRandom& random, CellSum& cell) const;
  bool isDark() const { return scene_.lights.empty() && emitters_.empty(); }

 private:
  struct Emitter {
    double sum;  ///< of the powers up to here
    double pdf;  ///< per area, in local space
    uint32_t primitive;
  };
  const Material& materialOf(uint32_t primitive) const;
  std::optional<SurfacePoint> meet(const glm::dvec3& origin, const glm::dvec3& direction) const;
  /// The part of the light that gets from one point to another, 0 behind what is opaque.
  glm::dvec3 between(const SurfacePoint& from, const glm::dvec3& towards, double distance) const;
  glm::dvec3 emissionAt(uint32_t primitive, const glm::dvec3& place) const;
  glm::dvec3 albedoAt(const SurfacePoint& point) const;
  Gathered gather(const SurfacePoint& point, const glm::dvec3& throughput, PathRandom& random) const;
  double fromLamp(const Light& light, const SurfacePoint& point, const glm::dvec3& throughput) const;
  double fromEmitter(const SurfacePoint& point, const glm::dvec3& throughput, PathRandom& random) const;
  void addEmitter(uint32_t primitive, double area);

  const Scene& scene_;
  ExactTracer tracer_;
  std::vector<EmissivePicture> pictures_;  ///< by material
  std::vector<PackedPicture> texels_;
  std::vector<Emitter> emitters_;
};

/// The part of the light that passes the surface straight on, 0: it is opaque.
glm::dvec3 straightThrough(const Material& m) {
  if (m.alphaMode != AlphaMode::Opaque && m.baseColorFactor.a < 0.5f)
    return glm::dvec3(1.0 - double(m.baseColorFactor.a));
  if (m.transmissionFactor < 0.5f) return glm::dvec3(0.0);
  return glm::dvec3(m.baseColorFactor) * double(m.transmissionFactor);
}

LightEstimator::LightEstimator(const SeenScene& seen)
    : scene_(seen.scene), tracer_(seen.scene, seen.bvh), pictures_(seen.scene.materials.size()) {
  constexpr int kSide = 128;  // pixels
  std::vector<double> areas(scene_.materials.size(), 0.0);
  const size_t triangles = scene_.triangles.size();
  for (const bool adds : {false, true}) {
    for (uint32_t i = 0; i < triangles + scene_.spheres.size(); ++i) {
      const Material& m = materialOf(i);
      if (!m.emissive() || (m.emissiveTexture.present() && !seen.readsTextures)) continue;
      const double radius = i < triangles ? 0.0 : double(scene_.spheres[i - triangles].radius);
      const double area = i < triangles ? areaOf(cornersOf<glm::dvec3>(scene_, scene_.triangles[i]))
                                        : 4.0 * glm::pi<double>() * radius * radius;
      if (adds)
        addEmitter(i, area);
      else
        areas[size_t(&m - scene_.materials.data())] += area;
    }
    if (adds) break;
    TraitSet traits;
    traits.set(size_t(slotTrait(layout::kSlotEmission)), seen.readsTextures);
    const TexturePlan plan = planTextures(scene_, traits, {.side = kSide});
    TexturePacker packer(scene_, plan);
    texels_ = packer.takePictures();
    for (size_t i = 0; i < areas.size(); ++i) {
      if (areas[i] <= 0.0) continue;
      const Material& m = scene_.materials[i];
      pictures_[i].mean = packer.meanRadiance(m);
      if (!m.emissiveTexture.present()) continue;
      const uint32_t image = scene_.textures[m.emissiveTexture.texture].image;
      const auto found = std::ranges::find(texels_, image, &PackedPicture::image);
      if (found == texels_.end()) continue;
      pictures_[i].picture = &*found;
      pictures_[i].place = plan.places[image];
    }
  }
}

void LightEstimator::addEmitter(uint32_t primitive, double area) {
  const size_t material = size_t(&materialOf(primitive) - scene_.materials.data());
  const double power = luminance(glm::dvec3(pictures_[material].mean)) * area;
  if (!(power > 0.0) || !(area > 1e-30)) return;
  emitters_.push_back({(emitters_.empty() ? 0.0 : emitters_.back().sum) + power, power / area, primitive});
}

const Material& LightEstimator::materialOf(uint32_t primitive) const {
  const size_t triangles = scene_.triangles.size();
  return scene_.materials[primitive < triangles ? scene_.triangles[primitive].material
                                                : scene_.spheres[primitive - triangles].material];
}

std::optional<SurfacePoint> LightEstimator::meet(const glm::dvec3& origin,
                                                 const glm::dvec3& direction) const {
  SurfacePoint point{.place = origin};
  for (int pane = 0; pane < kMostPanes; ++pane) {
    const ExactHit hit = tracer_.nearest({glm::vec3(point.place), glm::vec3(direction), kNoLimit});
    if (hit.primitive == kMissIndex) return std::nullopt;
    point.place = glm::dvec3(glm::vec3(point.place)) + hit.t * direction;
    point.primitive = hit.primitive;
    point.instance = hit.instance;
    point.normal = tracer_.normal(hit.primitive, point.place, hit.instance);
    point.front = glm::dot(point.normal, direction) < 0.0;
    if (!point.front) point.normal = -point.normal;
    const glm::dvec3 size = glm::abs(point.place);
    point.reach = 4.0 * tracer_.pointError(hit.primitive) + 1e-6 * std::max({size.x, size.y, size.z});
    const glm::dvec3 passes = straightThrough(materialOf(hit.primitive));
    if (passes == glm::dvec3(0.0)) return point;
    point.passed *= passes;
    point.place -= point.reach * point.normal;
  }
  return std::nullopt;
}

glm::dvec3 LightEstimator::between(const SurfacePoint& from, const glm::dvec3& towards,
                                   double distance) const {
  glm::dvec3 passed(1.0);
  glm::dvec3 place = from.place + from.reach * from.normal;
  double left = distance - from.reach;
  for (int pane = 0; pane < kMostPanes; ++pane) {
    const double limit = std::min(left * (1.0 - 1e-4), double(kNoLimit));
    const ExactHit hit = tracer_.nearest({glm::vec3(place), glm::vec3(towards), float(limit)});
    if (hit.primitive == kMissIndex) return passed;
    passed *= straightThrough(materialOf(hit.primitive));
    if (passed == glm::dvec3(0.0)) return passed;
    const double step = hit.t + from.reach + 1e-6 * hit.t;
    place += step * towards;
    left -= step;
    if (left <= 0.0) return passed;
  }
  return glm::dvec3(0.0);
}

/// The linear colour of the texel that the place of a texture lies in.
glm::vec3 coarseTexel(const EmissivePicture& emissive, const Texture& texture, const glm::vec2& uv) {
  const auto along = [](float x, int count, Wrap wrap) {
    if (wrap == Wrap::ClampToEdge) return std::clamp(int(std::floor(x * float(count))), 0, count - 1);
    const float turns = std::floor(x);
    float part = x - turns;
    if (wrap == Wrap::MirroredRepeat && std::fmod(std::abs(turns), 2.0f) == 1.0f) part = 1.0f - part;
    return std::clamp(int(part * float(count)), 0, count - 1);
  };
  const int x = along(uv.x, emissive.place.size.x, texture.wrapU);
  const int y = along(uv.y, emissive.place.size.y, texture.wrapV);
  const size_t texel = size_t(y) * size_t(emissive.place.size.x) + size_t(x);
  return glm::vec3(texelOf(*emissive.picture, emissive.place, texel, TransferCurve::Srgb));
}

glm::dvec3 LightEstimator::emissionAt(uint32_t primitive, const glm::dvec3& place) const {
  const Material& m = materialOf(primitive);
  const EmissivePicture& picture = pictures_[size_t(&m - scene_.materials.data())];
  const Vertices& vertices = scene_.vertices;
  const std::vector<glm::vec2>& uv =
      m.emissiveTexture.texcoord == 1 ? vertices.texcoord1 : vertices.texcoord0;
  if (picture.picture == nullptr || primitive >= scene_.triangles.size() || uv.empty())
    return glm::dvec3(picture.mean);
  const Triangle& t = scene_.triangles[primitive];
  const auto [a, b, c] = cornersOf<glm::dvec3>(scene_, t);
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double size = glm::dot(normal, normal);
  if (!(size > 0.0)) return glm::dvec3(picture.mean);
  const double v = glm::dot(glm::cross(place - a, c - a), normal) / size;
  const double w = glm::dot(glm::cross(b - a, place - a), normal) / size;
  const glm::vec2 at =
      float(1.0 - v - w) * uv[t.vertex.x] + float(v) * uv[t.vertex.y] + float(w) * uv[t.vertex.z];
  const glm::vec3 texel =
      coarseTexel(picture, scene_.textures[m.emissiveTexture.texture], m.emissiveTexture.transform.of(at));
  return glm::dvec3(m.emissiveFactor) * double(m.emissiveStrength) * glm::dvec3(texel);
}

glm::dvec3 LightEstimator::albedoAt(const SurfacePoint& point) const {
  const Material& m = materialOf(point.primitive);
  glm::dvec3 color(m.baseColorFactor);
  if (m.baseColorTexture.present()) color *= kMeanTexel;
  if (point.primitive < scene_.triangles.size() && !scene_.vertices.color.empty())
    color *= glm::dvec3(scene_.vertices.color[scene_.triangles[point.primitive].vertex.x]);
  return glm::clamp(color, 0.0, 1.0);
}

double LightEstimator::fromLamp(const Light& light, const SurfacePoint& point,
                                const glm::dvec3& throughput) const {
  glm::dvec3 towards = -glm::dvec3(light.direction);
  double distance = double(kNoLimit);
  double window = 1.0;
  if (light.type != LightType::Directional) {
    towards = glm::dvec3(light.position) - point.place;
    distance = glm::length(towards);
    if (!(distance > 0.0)) return 0.0;
    towards /= distance;
    const double ratio = distance / double(light.range);
    window = std::max(0.0, 1.0 - ratio * ratio * ratio * ratio) / (distance * distance);
  }
  if (light.type == LightType::Spot) {
    const double outer = std::cos(double(light.outerConeAngle));
    const double inner = std::max(std::cos(double(light.innerConeAngle)), outer + 1e-6);
    const double cosine = -glm::dot(towards, glm::dvec3(light.direction));
    const double falloff = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
    window *= falloff * falloff;
  }
  const double cosine = glm::dot(point.normal, towards);
  if (!(cosine * window > 0.0)) return 0.0;
  const glm::dvec3 passed = between(point, towards, distance);
  return luminance(throughput * passed * glm::dvec3(light.intensity)) * cosine * window / glm::pi<double>();
}

double LightEstimator::fromEmitter(const SurfacePoint& point, const glm::dvec3& throughput,
                                   PathRandom& random) const {
  const double all = emitters_.back().sum;
  const auto found = std::ranges::lower_bound(emitters_, random.next() * all, {}, &Emitter::sum);
  const Emitter& emitter = found == emitters_.end() ? emitters_.back() : *found;
  const double r = random.next();
  const double s = random.next();
  glm::dvec3 place;
  glm::dvec3 normal;
  if (emitter.primitive < scene_.triangles.size()) {
    const auto [a, b, c] = cornersOf<glm::dvec3>(scene_, scene_.triangles[emitter.primitive]);
    const double root = std::sqrt(r);
    place = a * (1.0 - root) + b * (root * (1.0 - s)) + c * (root * s);
    normal = glm::normalize(glm::cross(b - a, c - a));
  } else {
    const Sphere& sphere = scene_.spheres[emitter.primitive - scene_.triangles.size()];
    const double z = 1.0 - 2.0 * r;
    const double ring = std::sqrt(std::max(0.0, 1.0 - z * z));
    const double angle = 2.0 * glm::pi<double>() * s;
    normal = {ring * std::cos(angle), ring * std::sin(angle), z};
    place = glm::dvec3(sphere.center) + double(sphere.radius) * normal;
  }
  glm::dvec3 towards = place - point.place;
  const double distance = glm::length(towards);
  if (!(distance > 0.0)) return 0.0;
  towards /= distance;
  double leaves = -glm::dot(normal, towards);
  if (materialOf(emitter.primitive).doubleSided) leaves = std::abs(leaves);
  const double arrives = glm::dot(point.normal, towards);
  if (!(leaves > 0.0) || !(arrives > 0.0)) return 0.0;
  const glm::dvec3 light = emissionAt(emitter.primitive, place) * between(point, towards, distance);
  const double pdf = emitter.pdf / all;  // per area
  return luminance(throughput * light) * leaves * arrives / (distance * distance * pdf * glm::pi<double>());
}

Gathered LightEstimator::gather(const SurfacePoint& point, const glm::dvec3& throughput,
                                PathRandom& random) const {
  Gathered light;
  const size_t lamps = scene_.lights.size();
  const size_t asked = std::min(lamps, kMostLamps);
  for (size_t i = 0; i < asked; ++i) {
    const double place =
        asked == lamps ? double(i) : (double(i) + random.next()) * double(lamps) / double(asked);
    const size_t lamp = std::min(size_t(place), lamps - 1);
    light.byLamps += fromLamp(scene_.lights[lamp], point, throughput) * double(lamps) / double(asked);
  }
  if (!emitters_.empty()) light.byEmission = fromEmitter(point, throughput, random);
  return light;
}

/// A direction about the normal, by the cosine.
glm::dvec3 cosineDirection(const glm::dvec3& normal, PathRandom& random) {
  const double z = 1.0 - 2.0 * random.next();
  const double angle = 2.0 * glm::pi<double>() * random.next();
  const double ring = std::sqrt(std::max(0.0, 1.0 - z * z));
  const glm::dvec3 sum = normal + glm::dvec3(ring * std::cos(angle), ring * std::sin(angle), z);
  const double length = glm::length(sum);
  return length > 1e-9 ? sum / length : normal;
}

void LightEstimator::trace(const Projection& projection, const glm::dvec2& place, PathRandom& random,
                           CellSum& cell) const {
  const std::optional<Ray> ray = rayThrough(projection, scene_.space, place);
  if (!ray) return;
  glm::dvec3 origin(ray->origin);
  glm::dvec3 direction(ray->direction);
  glm::dvec3 throughput(1.0);
  for (int i = 0; i < kPathSurfaces; ++i) {
    std::optional<SurfacePoint> point = meet(origin, direction);
    if (!point) {
      if (i > 0) ++cell.open;
      return;
    }
    const Material& m = materialOf(point->primitive);
    throughput *= point->passed;
    const glm::dvec3 albedo = albedoAt(*point);
    if (i == 0) {
      ++cell.surfaces;
      if (m.metallicFactor > 0.5f && m.roughnessFactor < 0.5f && !m.metallicRoughnessTexture.present())
        ++cell.metals;
      const bool emits = m.emissive() && (point->front || m.doubleSided);
      const glm::dvec3 shown = m.unlit ? albedo
                               : emits ? emissionAt(point->primitive, point->place)
                                       : glm::dvec3(0.0);
      cell.sum.shown += luminance(throughput * shown);
    }
    if (m.unlit) return;
    throughput *= albedo;
    // The other side of a thin surface that lets light through is lit as this one is.
    if (m.diffuseTransmissionFactor > 0.0f && random.next() < double(m.diffuseTransmissionFactor))
      point->normal = -point->normal;
    const Gathered light = gather(*point, throughput, random);
    cell.sum.byLamps += light.byLamps;
    cell.sum.byEmission += light.byEmission;
    const double survival = std::min(1.0, glm::compMax(albedo));
    if (!(random.next() < survival)) return;
    throughput /= survival;
    origin = point->place + point->reach * point->normal;
    direction = cosineDirection(point->normal, random);
  }
}

SeenLight estimateOf(const std::vector<CellSum>& sums, int paths) {
  SeenLight seen;
  seen.paths = paths;
  double metals = 0.0;
  double open = 0.0;
  double surfaces = 0.0;
  for (const CellSum& cell : sums) {
    if (cell.surfaces == 0) continue;
    const double count = cell.surfaces;
    seen.cells.push_back({cell.sum.byLamps / count, cell.sum.byEmission / count, cell.sum.shown / count});
    metals += cell.metals;
    open += cell.open;
    surfaces += count;
  }
  if (surfaces == 0.0) return seen;
  seen.smoothMetal = metals / surfaces;
  seen.open = open / surfaces;
  return seen;
}

double cellLuminance(const SeenCell& cell, double lampScale) {
  return lampScale * cell.byLamps + cell.byEmission + cell.shown;
}

/// The logarithmic mean of values above 0.
struct LogMean {
  double sum = 0.0;
  double count = 0.0;

  void add(double value) {
    if (!(value > 0.0)) return;
    sum += std::log(value);
    ++count;
  }
  double mean() const { return count > 0.0 ? std::exp(sum / count) : 0.0; }
};

/// Returns true if more paths would hardly change what is decided by the estimate.
bool isClear(const SeenLight& seen) {
  constexpr double kMargin = 2.0;
  constexpr int kEnough = 1024;  // paths that do not miss light by chance
  const double dark = seen.darkShare(1.0, kMiddleGrey * kTooDark);
  if (seen.paths >= kEnough && dark > 0.95) return true;
  const double mean = seen.meanLuminance(1.0) / kMiddleGrey;
  const double byLamps = seen.meanOfLampLit(1.0) / kMiddleGrey;
  return mean > kMargin * kTooDark && std::max(mean, byLamps) * kMargin < kTooBright && dark < 0.25;
}

/// Emission leaves a scene dark where more than this share of what is seen is darker than that part of middle
/// grey.
constexpr double kMostlyDark = 0.75;
constexpr double kDim = 1.0 / 8.0;

/// A lamp of intensity 0 is none.
bool isOn(const Light& light) { return glm::compMax(light.intensity) > 0.0f; }

/// The mean luminance that tells whether lamps are too bright: of what they light, or, where surroundings of
/// the user's choice light the scene, too, of all.
double meanForLamps(const SeenLight& seen, const LampReading& reading, double lampScale) {
  return reading.besideSurroundings ? seen.meanBesideSurroundings(lampScale) : seen.meanOfLampLit(lampScale);
}

/// Returns true if lamps are read as radiometric: as written, it is far too bright, and nearer to middle grey
/// divided, as it always is under surroundings of the user's.
bool areRadiometric(const SeenLight& seen, const LampReading& reading) {
  if (reading.units != LampUnits::Auto) return reading.units == LampUnits::Radiometric;
  const double asWritten = meanForLamps(seen, reading, 1.0) / kMiddleGrey;
  const double divided = meanForLamps(seen, reading, 1.0 / kLumensPerWatt) / kMiddleGrey;
  return asWritten > kTooBright && divided > 0.0 && std::abs(std::log(divided)) < std::log(asWritten);
}

}  // namespace

double SeenLight::meanLuminance(double lampScale) const {
  constexpr double kFew = 0.05;
  LogMean visible;
  LogMean lit;
  for (const SeenCell& cell : cells) {
    const double light = cellLuminance(cell, lampScale);
    lit.add(light);
    if (light >= kMiddleGrey * kTooDark) visible.add(light);
  }
  return visible.count >= kFew * double(cells.size()) ? visible.mean() : lit.mean();
}

double SeenLight::meanOfLampLit(double lampScale) const {
  LogMean lit;
  for (const SeenCell& cell : cells)
    if (cell.byLamps > cell.byEmission + cell.shown) lit.add(cellLuminance(cell, lampScale));
  return lit.mean();
}

double SeenLight::meanBesideSurroundings(double lampScale) const {
  LogMean lit;
  for (const SeenCell& cell : cells) lit.add(cellLuminance(cell, lampScale) + kMiddleGrey);
  return lit.mean();
}

double SeenLight::darkShare(double lampScale, double luminance) const {
  constexpr double kNearlyAll = 0.9;
  double others = 0.0;
  double dark = 0.0;
  for (const SeenCell& cell : cells) {
    if (cell.shown >= luminance) continue;
    ++others;
    if (cellLuminance(cell, lampScale) < luminance) ++dark;
  }
  const auto all = double(cells.size());
  if (cells.empty() || all - others >= kNearlyAll * all) return 0.0;
  return dark / others;
}

SeenLight seenLight(const SeenScene& seen, const Camera& camera, double aspectRatio) {
  const LightEstimator estimator(seen);
  const Projection projection = projectionOf(camera, aspectRatio);
  std::vector<CellSum> cells(size_t(kCellSide) * kCellSide);
  int done = 0;
  SeenLight result;
  for (const int paths : kPathsSoFar) {
    forEachIndex(cells.size(), [&](size_t i) {
      const size_t row = i / kCellSide;
      const size_t column = i % kCellSide;
      for (int k = done; k < paths; ++k) {
        PathRandom random(uint64_t(k) * cells.size() + i);
        const double x = double(column) + random.next();
        const double y = double(row) + random.next();
        estimator.trace(projection, glm::dvec2(x, y) / (0.5 * kCellSide) - 1.0, random, cells[i]);
      }
    });
    done = paths;
    result = estimateOf(cells, paths * int(cells.size()));
    if (isClear(result) || estimator.isDark()) break;
  }
  return result;
}

bool mayShine(const Scene& scene) {
  const auto emits = [&](const auto& primitive) { return scene.materials[primitive.material].emissive(); };
  return std::ranges::any_of(scene.lights, isOn) || std::ranges::any_of(scene.triangles, emits) ||
         std::ranges::any_of(scene.spheres, emits);
}

FileLight decideLight(const SeenScene& first, const Camera& camera, double aspectRatio,
                      const LampReading& reading) {
  FileLight light;
  if (!mayShine(first.scene)) {
    light.own = OwnLight::None;
    return light;
  }
  light.byLamps = std::ranges::any_of(first.scene.lights, isOn);
  SeenScene seen = first;
  seen.readsTextures = !light.byLamps;
  const SeenLight estimate = seenLight(seen, camera, aspectRatio);
  if (light.byLamps && areRadiometric(estimate, reading)) light.lampScale = 1.0 / kLumensPerWatt;
  light.asWritten = meanForLamps(estimate, reading, 1.0);
  light.mean = reading.besideSurroundings ? estimate.meanBesideSurroundings(light.lampScale)
                                          : estimate.meanLuminance(light.lampScale);
  const double asShown = light.byLamps ? std::exp2(exposureFor(light.mean)) : 1.0;
  light.dark = estimate.darkShare(light.lampScale, kMiddleGrey * (light.byLamps ? kTooDark / asShown : kDim));
  light.smoothMetal = estimate.smoothMetal;
  if (!light.byLamps && light.dark > kMostlyDark) light.own = OwnLight::Dim;
  return light;
}

double exposureFor(double mean) {
  constexpr double kAsGoodAsNone = 0x1p-20;  // what is left of light by way of many bounces
  const double ratio = mean / kMiddleGrey;
  if (!(ratio > kAsGoodAsNone) || (ratio <= kTooBright && ratio >= kTooDark)) return 0.0;
  return std::round(-10.0 * std::log2(ratio)) / 10.0;
}

}  // namespace fragtrace
