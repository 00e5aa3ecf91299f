// SPDX-License-Identifier: MIT
#include "gltf/build/placed.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "gltf/build/nodes.h"
#include "gltf/read/document.h"

namespace fragtrace {

namespace {

/// The camera's axes without scale and shear; a node that flattens everything keeps the default view.
void orient(Camera& camera, const glm::dmat4& world) {
  const glm::dvec3 backward(world[2]);
  const glm::dvec3 upward(world[1]);
  if (glm::length(backward) > 0.0) camera.forward = -glm::normalize(backward);
  const glm::dvec3 across = upward - glm::dot(upward, camera.forward) * camera.forward;
  if (glm::length(across) > 0.0) {
    camera.up = glm::normalize(across);
  } else {
    const glm::dvec3 axis =
        std::abs(camera.forward.y) < std::abs(camera.forward.z) ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    camera.up = glm::normalize(axis - glm::dot(axis, camera.forward) * camera.forward);
  }
}

}  // namespace

std::optional<Camera> cameraAt(const Document& document, const PlacedNode& node) {
  const tinygltf::Node& source = document.model.nodes.at(size_t(node.index));
  if (source.camera < 0) return std::nullopt;
  const tinygltf::Camera& described = document.model.cameras.at(size_t(source.camera));
  const std::string place = pointerTo("cameras", source.camera);
  Camera camera;
  camera.name = !described.name.empty() ? described.name : nameOrPlace(source.name, "nodes", node.index);
  camera.position = glm::dvec3(node.world[3]);
  orient(camera, node.world);
  if (described.type == "perspective") {
    camera.fovY = described.perspective.yfov;
    camera.aspectRatio = described.perspective.aspectRatio;
    if (!(camera.fovY > 0.0 && camera.fovY < 3.141592653589793)) {
      document.diagnostics.lose(place + "/perspective/yfov", "is not between 0 and pi");
    }
    if (camera.aspectRatio < 0.0)
      document.diagnostics.lose(place + "/perspective/aspectRatio", "is negative");
    return camera;
  }
  // Negative magnifications are discouraged mirrors in the specification; only their size is taken.
  camera.type = CameraType::Orthographic;
  camera.halfHeight = std::abs(described.orthographic.ymag);
  camera.aspectRatio = std::abs(described.orthographic.xmag) / camera.halfHeight;
  if (!(camera.halfHeight > 0.0 && camera.aspectRatio > 0.0) || !std::isfinite(camera.aspectRatio)) {
    document.diagnostics.lose(place + "/orthographic", "xmag and ymag must not be 0");
  }
  return camera;
}

namespace {

constexpr float kRightAngle = 1.5707964f;

LightSource sourceOf(const tinygltf::Light& described) {
  LightSource source{.name = described.name, .intensity = described.intensity};
  if (described.type == "directional") source.type = LightType::Directional;
  if (described.type == "spot") source.type = LightType::Spot;
  for (int c = 0; c < 3 && !described.color.empty(); ++c) source.color[c] = described.color.at(size_t(c));
  return source;
}

}  // namespace

std::vector<LightSource> lightSources(const Document& document) {
  std::vector<LightSource> sources;
  for (const tinygltf::Light& described : document.model.lights) sources.push_back(sourceOf(described));
  return sources;
}

std::optional<Light> lightAt(Document& document, const PlacedNode& node, const LocalSpace& space) {
  const tinygltf::Node& source = document.model.nodes.at(size_t(node.index));
  const auto extension = source.extensions.find("KHR_lights_punctual");
  if (extension == source.extensions.end()) return std::nullopt;
  const int index = int(numberOf(extension->second, "light", -1));
  const tinygltf::Light& described = document.model.lights.at(size_t(index));
  const std::string place = pointerTo("extensions", "KHR_lights_punctual", "lights", index);

  Light light;
  if (described.type == "directional") {
    light.type = LightType::Directional;
  } else if (described.type == "spot") {
    light.type = LightType::Spot;
    light.innerConeAngle = float(described.spot.innerConeAngle);
    light.outerConeAngle = float(described.spot.outerConeAngle);
    // mendValues() has put the file's angles in order, but not those of --set and of animations.
    if (!(light.innerConeAngle >= 0.0f && light.innerConeAngle <= light.outerConeAngle) ||
        light.outerConeAngle > kRightAngle)
      document.diagnostics.lose(place + "/spot", "the cone angles do not fulfil 0 <= inner <= outer <= pi/2");
  }
  light.source = uint32_t(index);
  light.node = nameOrPlace(source.name, "nodes", node.index);
  light.place = pointerTo("nodes", node.index);
  LightSource bright = sourceOf(described);
  const double brightest = std::max({bright.color.r, bright.color.g, bright.color.b}) * bright.intensity;
  if (brightest > double(kBrightest)) {
    document.diagnostics.warn(place + "/intensity",
                              "times its colour is out of range, the nearest possible value is taken: 1e+20");
    bright.intensity *= double(kBrightest) / brightest;
  }
  light.intensity = intensityOf(bright, space);
  for (int c = 0; c < 3; ++c) {
    if (!std::isfinite(light.intensity[c]) || light.intensity[c] < 0.0f) {
      document.diagnostics.lose(place, "colour times intensity is negative or too large");
    }
  }
  // tinygltf says 0 where no range is given.
  if (described.range < 0.0) document.diagnostics.lose(place + "/range", "is negative");
  if (described.range > 0.0) light.range = float(described.range / space.unit);
  light.position = glm::vec3(space.localOf(glm::dvec3(node.world[3])));
  const glm::vec3& p = light.position;
  if (light.type != LightType::Directional && !std::isfinite(glm::dot(p, p))) {
    document.diagnostics.warn(pointerTo("nodes", node.index),
                              "its light is too far away for a scene of this size, and left out");
    return std::nullopt;
  }
  const glm::dvec3 backward(node.world[2]);
  if (glm::length(backward) > 0.0) light.direction = glm::vec3(-glm::normalize(backward));
  return light;
}

namespace {

constexpr const char* kName = "fragtrace_volume";
constexpr std::string_view kMembers[] = {"volume", "position",   "scale",   "density",
                                         "color",  "anisotropy", "emission"};

/// Reads one group of numbers of the volume.
class Numbers {
 public:
  Numbers(Diagnostics& diagnostics, std::string place, const tinygltf::Value& object)
      : diagnostics_(diagnostics), place_(std::move(place)), object_(object) {}

  std::optional<double> number(const char* name, double least, double most) const {
    if (!memberOf(object_, name).IsNumber()) return std::nullopt;
    return checked(name, numberOf(object_, name, 0.0), least, most);
  }

  std::optional<glm::dvec3> vector(const char* name, double least, double most) const {
    const std::vector<double> values = numbersOf(object_, name, {});
    if (values.empty()) return std::nullopt;
    glm::dvec3 result;
    for (int axis = 0; axis < 3; ++axis) result[axis] = checked(name, values.at(size_t(axis)), least, most);
    return result;
  }

 private:
  double checked(const char* name, double value, double least, double most) const {
    if (!(value >= least && value <= most))
      diagnostics_.refuse(place_ + "/" + name,
                          "is not in the range " + shortText(least) + " to " + shortText(most));
    return value;
  }

  Diagnostics& diagnostics_;
  std::string place_;
  const tinygltf::Value& object_;
};

}  // namespace

std::optional<Volume> volumeAt(Document& document, const PlacedNode& node) {
  const tinygltf::Node& source = document.model.nodes.at(size_t(node.index));
  const tinygltf::Value& object = memberOf(source.extras, kName);
  if (!object.IsObject()) return std::nullopt;
  const std::string place = pointerTo("nodes", node.index, "extras", kName);
  const Numbers numbers(document.diagnostics, place, object);
  const tinygltf::Value& named = memberOf(object, "volume");
  for (const std::string& key : object.Keys()) {
    if (std::ranges::find(kMembers, key) == std::end(kMembers))
      document.diagnostics.warn(pointerTo("nodes", node.index, "extras", kName, key),
                                "is no member of a volume and is ignored");
  }
  Volume volume;
  volume.source = volumeFile(named.IsString() ? named.Get<std::string>() : "");
  if (volume.source.file.empty()) document.diagnostics.refuse(place + "/volume", "names no file");
  volume.source.position = numbers.vector("position", -kFarthest, kFarthest);
  volume.source.scale = numbers.number("scale", kLeastVolumeScale, kMostVolumeScale);
  volume.source.density = numbers.number("density", 0.0, kMostVolumeFactor);
  if (const auto color = numbers.vector("color", 0.0, 1.0)) volume.source.color = glm::vec3(*color);
  volume.source.anisotropy = numbers.number("anisotropy", -kMostAnisotropy, kMostAnisotropy);
  volume.source.emission = numbers.number("emission", 0.0, kMostVolumeFactor);
  volume.toWorld = node.world;
  const std::string uri = volume.source.file.string();
  volume.file = document.diagnostics.attempt(place + "/volume",
                                             [&] { return readUri(document.access, uri, document.memory); });
  takeMemory(document, place + "/volume", volume.file.size());
  volume.source.file = isDataUri(uri) ? std::filesystem::path(place) : pathOfUri(document.access, uri);
  return volume;
}

namespace {

/// Columns may be this far from perpendicular and from the same length: TRS in single precision stays well
/// below.
constexpr double kUniformScaleTolerance = 1e-4;

bool isUniform(const glm::dmat3& axes, double scale) {
  for (int c = 0; c < 3; ++c) {
    if (std::abs(glm::length(axes[c]) - scale) > kUniformScaleTolerance * scale) return false;
    if (std::abs(glm::dot(axes[c], axes[(c + 1) % 3])) > kUniformScaleTolerance * scale * scale) return false;
  }
  return true;
}

}  // namespace

std::optional<PlacedSphere> sphereAt(Document& document, const PlacedNode& node) {
  const tinygltf::Node& source = document.model.nodes.at(size_t(node.index));
  const auto extension = document.model.extensions.find("KHR_implicit_shapes");
  const tinygltf::Value& chosen = memberOf(source.extras, "shape");
  if (extension == document.model.extensions.end() || !chosen.IsInt()) return std::nullopt;

  const std::string place = pointerTo("nodes", node.index);
  const tinygltf::Value& shapes = memberOf(extension->second, "shapes");
  const int index = chosen.GetNumberAsInt();
  if (index < 0 || size_t(index) >= shapes.ArrayLen()) {
    document.diagnostics.refuse(place + "/extras/shape", "index " + std::to_string(index) + " is past the " +
                                                             std::to_string(shapes.ArrayLen()) + " shapes");
  }
  document.diagnostics.need(pointerTo("extensions", "KHR_implicit_shapes", "shapes", index));
  const tinygltf::Value& shape = shapes.Get(index);
  const std::string& type = memberOf(shape, "type").Get<std::string>();
  if (type != "sphere") {
    document.diagnostics.warn(place + "/extras/shape", "a shape of type " + inQuotes(type) + " is left out");
    return std::nullopt;
  }

  PlacedSphere sphere;
  sphere.node = nameOrPlace(source.name, "nodes", node.index);
  sphere.nodeIndex = uint32_t(node.index);
  const size_t materialCount = document.model.materials.size();
  const tinygltf::Value& material = memberOf(source.extras, "material");
  if (material.IsInt() &&
      (material.GetNumberAsInt() < 0 || size_t(material.GetNumberAsInt()) >= materialCount)) {
    document.diagnostics.refuse(place + "/extras/material",
                                "index " + std::to_string(material.GetNumberAsInt()) + " is past the " +
                                    std::to_string(materialCount) + " materials");
  }
  sphere.material = uint32_t(material.IsInt() ? size_t(material.GetNumberAsInt()) : materialCount);

  glm::dmat3 axes(node.world);
  const double scale = glm::length(axes[0]);
  if (!isUniform(axes, scale)) document.diagnostics.lose(place, "scales a sphere unevenly");
  const double radius = numberOf(memberOf(shape, "sphere"), "radius", 0.5);  // the extension's default
  sphere.radius = radius * scale;
  if (!(sphere.radius >= kSmallest)) document.diagnostics.lose(place, "its sphere has no radius above 0");
  sphere.center = glm::dvec3(node.world[3]);
  if (!(glm::length(sphere.center) + sphere.radius <= kFarthest))
    document.diagnostics.lose(place, "its sphere reaches farther than 1e30 m from the origin");
  if (glm::determinant(axes) < 0.0) {
    document.diagnostics.warn(place, "a mirrored sphere shows its textures unmirrored");
    axes = -axes;
  }
  sphere.rotation = glm::normalize(glm::quat_cast(axes * (1.0 / scale)));
  return sphere;
}

}  // namespace fragtrace
