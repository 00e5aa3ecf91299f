// SPDX-License-Identifier: MIT
#include "session/environment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/gtc/constants.hpp>
#include <glm/gtx/rotate_vector.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "base/vectors.h"
#include "bvh/bvh.h"
#include "options/option_row.h"
#include "pack/pack_environment.h"
#include "scene/camera.h"
#include "scene/creases.h"
#include "scene/sky/map_filter.h"
#include "scene/sky/sky.h"
#include "scene/strokes.h"
#include "scene/studio.h"
#include "session/say.h"
#include "session/setup.h"

namespace fragtrace {

namespace {

/// Decides by the camera from which the file is seen without any option of it.
FileLight decideByFirstView(const Scene& scene, const Bvh& tree, const RenderOptions& options) {
  constexpr double kUsual = 1280.0 / 720.0;
  const CameraOverrides overrides = settledOverrides({}, scene);
  Camera camera = chooseCamera(scene.cameras, std::nullopt, overrides, scene.bounds);
  const double aspect = camera.aspectRatio > 0.0 ? camera.aspectRatio : kUsual;
  if (overrides.fit) {
    camera = fitted(camera, pointsToFit(scene, {}, {}, overrides).scene, aspect);
  }
  return decideLight({scene, tree}, camera, aspect, {options.light.lampUnits, hasMap(options)});
}

/// Returns true if the scene is the file's as it stands, with all that it shows.
bool isAsFile(const SceneSelection& selection) {
  return selection.hiddenNodes.empty() && selection.set.empty() && selection.lights.empty() &&
         !selection.animationTime && selection.animation.empty();
}

/// Returns true if nothing of the file could shine, whatever its pose.
bool staysDark(const RenderOptions& options, const Scene& scene) {
  if (isAsFile(options.selection)) return !mayShine(scene);
  return scene.lightSources.empty() && std::ranges::none_of(scene.materials, &Material::emissive);
}

/// Returns true if the options name a light.
bool isLitByUser(const RenderOptions& options) {
  return hasMap(options) || !options.selection.lights.empty();
}

/// Returns true if a light that the options name, or none, stands for that of a file without one.
bool isChosen(const RenderOptions& options) {
  return isLitByUser(options) || options.light.defaultLight == DefaultLight::None;
}

std::string percent(double share) { return std::to_string(std::lround(100.0 * share)) + " %"; }

/// Says what the user lights the scene by, with the file's lamps.
std::string lightOfUser(const RenderOptions& options, const FileLight& light) {
  std::vector<std::string> lights;
  if (options.light.studio) lights.emplace_back("the built-in studio");
  if (options.light.sky.on) lights.emplace_back("the sky");
  if (!options.light.hdriFile.empty()) lights.push_back("the environment " + options.light.hdriFile.string());
  if (!options.selection.lights.empty()) lights.emplace_back("--add-light");
  if (light.byLamps && options.selection.lights.empty()) lights.emplace_back("the file's own lamps");
  return joined(lights, " and ") + (lights.size() > 1 ? " light it" : " lights it");
}

/// Says who lights the scene by default, or which part of it its own light leaves out; what else lights it,
/// too, if that is asked for.
void sayWhoLights(const RenderOptions& options, const FileLight& light, bool always) {
  constexpr double kNoticed = 0.5;
  constexpr double kMuchMetal = 0.1;
  if (const std::string reason = defaultLightReason(options, light); !reason.empty()) {
    const bool studio = options.light.defaultLight == DefaultLight::Studio;
    say(options,
        reason + (studio ? ": the built-in studio lights it (--default-light)"
                         : ": a white environment that the camera does not see lights it (--default-light)"));
    return;
  }
  if (isLitByUser(options)) {
    if (always) say(options, lightOfUser(options, light));
    return;
  }
  if (light.own == OwnLight::None) {
    if (always) say(options, "nothing lights it (--default-light none)");
    return;
  }
  const std::string who =
      light.byLamps ? "the file's own lamps light it" : "the file's own emission lights it";
  if (light.dark > kNoticed)
    say(options, who + (light.byLamps ? ", and leave " : ", and leaves ") + percent(light.dark) +
                     " of what is seen dark (--studio adds light)");
  else if (light.byLamps && light.smoothMetal > kMuchMetal)
    say(options, who + ", and its smooth metal has nothing to reflect but them (--studio adds surroundings)");
  else if (always)
    say(options, who);
}

}  // namespace

FileLight fileLightOf(const RenderOptions& options, const Scene& scene, const Bvh* tree,
                      std::shared_ptr<KeptDocument>* document) {
  if (staysDark(options, scene)) return {.own = OwnLight::None};
  if (hasMap(options) && scene.lightSources.empty()) return {};  // nothing hangs on its emission
  if (isAsFile(options.selection)) {
    if (tree != nullptr && !tree->nodes.empty()) return decideByFirstView(scene, *tree, options);
    return decideByFirstView(scene, buildSceneBvh(scene), options);
  }
  RenderOptions plain;
  plain.scene = options.scene;
  plain.selection = options.selection;
  takePose(plain, {});
  plain.selection.lights.clear();
  plain.limits = options.limits;
  plain.limits.strict = false;
  const Scene standing = loadGltf(plain.scene, gltfOptionsOf(plain), document);
  return decideByFirstView(standing, buildSceneBvh(standing), options);
}

void setLampScale(Scene& scene, double lampScale) {
  scene.lampScale = lampScale;
  if (lampScale == 1.0) return;
  for (Light& light : scene.lights) {
    if (!scene.lightSources[light.source].added) light.intensity *= float(lampScale);
  }
}

OwnLight countedLight(const RenderOptions& options, const FileLight& light) {
  return isChosen(options) ? OwnLight::Enough : light.own;
}

double exposureOf(const RenderOptions& options, const FileLight& light) {
  const double exposure = exposureFor(light.mean);
  const bool alone = !isLitByUser(options) && countedLight(options, light) == OwnLight::Enough;
  return alone || exposure < 0.0 ? exposure : 0.0;
}

RenderOptions exposed(RenderOptions options, const FileLight& light) {
  const double exposure = exposureOf(options, light);
  if (!options.output.exposure && exposure != 0.0) options.output.exposure = exposure;
  return options;
}

std::string defaultLightReason(const RenderOptions& options, const FileLight& light) {
  switch (countedLight(options, light)) {
    case OwnLight::None:
      return "no light in the scene";
    case OwnLight::Dim:
      return "the scene's emission leaves " + percent(light.dark) + " of what is seen dark";
    default:
      return "";
  }
}

void sayLight(const RenderOptions& options, const FileLight& light, bool always) {
  if (has(options.stages, Stage::Phong)) sayWhoLights(options, light, always || options.output.verbose);
  if (light.lampScale != 1.0 && options.light.lampUnits == LampUnits::Auto)
    say(options,
        formatted("as written, the file's lamps make what is seen %.0f times as bright as middle grey: they "
                  "are divided by %.0f, as watts taken for lumens (--lamp-units photometric does not)",
                  light.asWritten / kMiddleGrey, kLumensPerWatt));
  const double exposure = exposureOf(options, light);
  if (exposure == 0.0 || options.output.exposure) return;
  const double ratio = light.mean / kMiddleGrey;
  say(options,
      formatted("what is seen is %.3g times as %s as middle grey: .png, .jpg and window have an exposure of "
                "%.1f (--exposure 0 has none)",
                ratio > 1.0 ? ratio : 1.0 / ratio, ratio > 1.0 ? "bright" : "dark", exposure));
}

namespace {

/// Numbers of values that were no light.
struct NoLight {
  size_t negative = 0, infinite = 0, noNumber = 0;
};

/// Values below 0, which filters leave, and values that are no number become 0. Infinite ones become what the
/// formats of 16 bits hold at most.
NoLight settleRadiance(Image& image) {
  constexpr float kBrightest = 65504.0f;
  NoLight found;
  for (float& value : image.values) {
    if (std::isfinite(value) && value >= 0.0f) continue;
    const bool isInfinite = value > 0.0f;
    ++(isInfinite ? found.infinite : std::isnan(value) ? found.noNumber : found.negative);
    value = isInfinite ? kBrightest : 0.0f;
  }
  return found;
}

void warn(const RenderOptions& options, const std::string& what, std::vector<std::string>& warnings) {
  warnings.push_back(options.light.hdriFile.string() + what);
  say(options, "warning: " + warnings.back());
}

}  // namespace

std::string whyDark(const SkyOptions& sky) {
  return sunOf(sky).elevation < 0.0
             ? "the sun is below the horizon: the sky gives little light, or none (--exposure)"
             : "";
}

Environment skyOf(const RenderOptions& options, std::vector<std::string>& warnings) {
  constexpr double kNight = -18.0;  // degrees
  const SkyOptions& sky = options.light.sky;
  const double elevation = sunOf(sky).elevation;
  if (elevation < kNight) {
    warnings.emplace_back("--sky: the sun is " + std::to_string(std::lround(-elevation)) +
                          " degrees below the horizon: it is night");
    say(options, "warning: " + warnings.back());
  } else if (const std::string dark = whyDark(sky); !dark.empty()) {
    say(options, dark);
  }
  SkyMap map = makeSky(sky.turbidity, sky.groundAlbedo, elevation);
  Environment environment{Surroundings::Map, std::move(map.image), {}, map.sun};
  if (options.light.backgroundBlur > 0.0)
    environment.backdrop = blurredMap(withDisc(environment.image, map.sun), options.light.backgroundBlur);
  return environment;
}

LinearImage readMap(const RenderOptions& options) {
  LinearImage image = readLinearImage(options.light.hdriFile, options.limits.memoryBytes);
  image.image = wholeOf(std::move(image.image));
  return image;
}

Environment makeEnvironment(const RenderOptions& options, std::future<LinearImage>& map, OwnLight light,
                            std::vector<std::string>& warnings) {
  Environment environment;
  if (map.valid()) {
    LinearImage read = map.get();
    environment.kind = Surroundings::Map;
    sayNotes(options, options.light.hdriFile, read.image);
    if (read.image.channelCount() < 3) throw InputError(options.light.hdriFile.string() + ": has no colour");
    environment.image = std::move(read.image);
    Image& image = environment.image;
    const NoLight found = settleRadiance(image);
    const auto warnOf = [&](size_t count, const char* what) {
      if (count > 0) warn(options, ": " + countText(count, "value") + what, warnings);
    };
    warnOf(found.negative, " below 0, which is no light, taken as 0");
    warnOf(found.infinite, " without bound, taken as 65504");
    warnOf(found.noNumber,
           found.noNumber == 1 ? " that is no number, taken as 0" : " that are no numbers, taken as 0");
    if (read.wasEncoded)
      warn(options, ": holds no light above 1, so no sun and no lamp; an .hdr, .exr or .pfm does", warnings);
    // Mirror balls and faces of cubes are square; there is one reading of an environment here.
    if (image.width == image.height && image.width > 1)
      warn(options, ": is square, and drawn as latitude and longitude: 360 degrees wide, 180 high", warnings);
    environment.mapSun = sunOfMap(image);
    if (options.light.backgroundBlur > 0.0)
      environment.backdrop = blurredMap(image, options.light.backgroundBlur);
  } else if (options.light.sky.on) {
    environment = skyOf(options, warnings);
  } else if (options.light.studio ||
             (light != OwnLight::Enough && options.light.defaultLight == DefaultLight::Studio)) {
    environment = {Surroundings::Map, studioLight(options.light.studioLook),
                   studioBackdrop(options.light.studioLook)};
  } else if (light != OwnLight::Enough && options.light.defaultLight == DefaultLight::White) {
    environment.kind = Surroundings::DefaultLight;
    environment.image = {1, 1, {"R", "G", "B"}, {1.0f, 1.0f, 1.0f}, {}};
  }
  return environment;
}

namespace {

constexpr int kRows = 32;  // rows of the coarse map

void appendEnvironment(const Environment& environment, const RenderOptions& options,
                       std::vector<PlaneLight>& lights) {
  if (environment.kind == Surroundings::None) return;
  Image withSun;
  const MapRows map = resized(wholeMap(environment, withSun), kRows);
  const double rotation = glm::radians(environmentTurn(options.light));
  const double side = glm::pi<double>() / kRows;  // height of a texel, radians
  for (int y = 0; y < kRows / 2; ++y) {           // the upper half
    const double polar = side * (y + 0.5);
    for (int x = 0; x < map.width; ++x) {
      const double around = side * (x + 0.5) - glm::pi<double>();
      const glm::dvec3 from(std::sin(polar) * std::cos(around), std::cos(polar),
                            std::sin(polar) * std::sin(around));
      const MapRows::Row& row = map.rows[size_t(y)];
      const glm::dvec3 radiance(row[0][size_t(x)], row[1][size_t(x)], row[2][size_t(x)]);
      const double solidAngle = side * side * std::sin(polar);
      lights.push_back({glm::rotateY(from, rotation), false,
                        luminance(radiance) * options.light.hdriIntensity * solidAngle * from.y});
    }
  }
}

constexpr double kReach = 200.0;  ///< half of the side, in diagonals of the scene
constexpr double kGap = 1e-4;  ///< below the scene, in diagonals: faces that lie on it have a side to light

Material materialOf(const GroundOptions& ground, const std::vector<Material>& others) {
  Material material;
  material.name = "ground";
  for (const Material& other : others) material.number = std::max(material.number, other.number + 1);
  material.baseColorFactor = glm::vec4(ground.color, 1.0f);
  material.metallicFactor = 0.0f;
  material.roughnessFactor = float(ground.roughness);
  return material;
}

/// Appends a vertex without attributes.
uint32_t addVertex(Vertices& vertices, const glm::dvec3& place) {
  const auto append = [](auto& attribute, const auto& value) {
    if (!attribute.empty()) attribute.push_back(value);
  };
  append(vertices.normal, glm::vec3(0.0f));
  append(vertices.tangent, glm::vec4(0.0f));
  append(vertices.texcoord0, glm::vec2(0.0f));
  append(vertices.texcoord1, glm::vec2(0.0f));
  append(vertices.color, glm::vec4(1.0f));
  vertices.position.emplace_back(place);
  return uint32_t(vertices.position.size() - 1);
}

}  // namespace

std::vector<PlaneLight> caughtLights(const Scene& scene, const Environment& environment,
                                     const RenderOptions& options, double height) {
  std::vector<PlaneLight> lights;
  appendEnvironment(environment, options, lights);
  glm::dvec3 middle = scene.bounds.empty() ? glm::dvec3(0.0) : scene.bounds.center();
  middle.y = height;
  for (const Light& light : scene.lights) {
    const double strength = luminance(glm::dvec3(light.intensity));
    if (light.type == LightType::Directional) {
      const glm::dvec3 from = -glm::dvec3(light.direction);
      lights.push_back({from, false, strength * std::max(from.y, 0.0)});
      continue;
    }
    const glm::dvec3 place = scene.space.worldOf(glm::dvec3(light.position));
    const glm::dvec3 towards = (place - middle) / scene.space.unit;
    const double distance = glm::length(towards);
    if (distance > 0.0)
      lights.push_back({place, true, strength * std::max(towards.y, 0.0) / (distance * distance * distance)});
  }
  return lights;
}

void addGround(Scene& scene, const RenderOptions& options, const BoundsDouble& bounds) {
  if (!options.light.ground || bounds.empty()) return;
  const double size = glm::length(bounds.extent());
  glm::dvec3 middle = bounds.center();
  middle.y = bounds.minimum.y - kGap * size;
  const auto material = uint32_t(scene.materials.size());
  scene.materials.push_back(materialOf(*options.light.ground, scene.materials));
  std::array<uint32_t, 4> corners{};
  constexpr std::array<glm::dvec2, 4> kCorners{{{-1, 1}, {1, 1}, {1, -1}, {-1, -1}}};
  for (size_t i = 0; i < 4; ++i) {
    const glm::dvec3 place = middle + kReach * size * glm::dvec3(kCorners[i].x, 0.0, kCorners[i].y);
    corners[i] = addVertex(scene.vertices, scene.space.localOf(place));
  }
  const uint32_t first = flatTriangleCount(scene);
  uint32_t node = 0;
  for (const SceneNode& other : scene.nodes) node = std::max(node, other.index + 1);
  insertFlatTriangles(scene,
                      {{{corners[0], corners[1], corners[2]}, material, true},
                       {{corners[0], corners[2], corners[3]}, material, true}},
                      {{"ground", "ground", first, 2, node}});
  if (scene.strokes.empty()) settleCreases(scene);  // else addStrokes() does it
}

}  // namespace fragtrace
