// SPDX-License-Identifier: MIT
#include "gltf/assemble/nodes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numeric>

#include "base/errors.h"
#include "base/text.h"
#include "gltf/read/accessor.h"
#include "scene/camera.h"

namespace fragtrace {

namespace {

glm::dmat4 localTransform(const tinygltf::Node& node, const std::string& place,
                          const Diagnostics& diagnostics) {
  glm::dmat4 transform(1.0);
  if (!node.matrix.empty()) {
    for (int i = 0; i < 16; ++i) transform[i / 4][i % 4] = node.matrix.at(size_t(i));
    if (transform[0][3] != 0.0 || transform[1][3] != 0.0 || transform[2][3] != 0.0 ||
        transform[3][3] != 1.0) {
      diagnostics.lose(place + "/matrix", "is not affine: its last row is not 0, 0, 0, 1");
    }
    return transform;
  }
  if (!node.translation.empty()) {
    const auto& t = node.translation;
    transform = glm::translate(transform, glm::dvec3(t.at(0), t.at(1), t.at(2)));
  }
  if (!node.rotation.empty()) {
    const auto& r = node.rotation;
    const glm::dquat rotation(r.at(3), r.at(0), r.at(1), r.at(2));
    const double length = glm::length(rotation);
    // Exporters round to float, so that nearly every quaternion is off by a little.
    if (!(length > 0.0) || !std::isfinite(length))
      diagnostics.lose(place + "/rotation", "is not a unit quaternion");
    transform = transform * glm::mat4_cast(rotation / length);
  }
  if (!node.scale.empty()) {
    const auto& s = node.scale;
    transform = glm::scale(transform, glm::dvec3(s.at(0), s.at(1), s.at(2)));
  }
  return transform;
}

/// Returns, by node, true if it is in the scene; without scenes all are.
std::vector<bool> nodesOfScene(const tinygltf::Model& model) {
  if (model.scenes.empty()) return std::vector<bool>(model.nodes.size(), true);
  std::vector<bool> seen(model.nodes.size(), false);
  std::vector<int> waiting = model.scenes.at(size_t(std::max(model.defaultScene, 0))).nodes;
  while (!waiting.empty()) {
    const auto node = size_t(waiting.back());
    waiting.pop_back();
    if (seen.at(node)) continue;
    seen[node] = true;
    const std::vector<int>& children = model.nodes[node].children;
    waiting.insert(waiting.end(), children.begin(), children.end());
  }
  return seen;
}

/// Parent by node, -1 for roots. Throws unless the nodes of the scene form trees.
std::vector<int> parentsOf(const Document& document) {
  const auto& nodes = document.model.nodes;
  const std::vector<bool> isOfScene = nodesOfScene(document.model);
  std::vector<int> parents(nodes.size(), -1);
  for (size_t i = 0; i < nodes.size(); ++i) {
    for (size_t k = 0; isOfScene[i] && k < nodes[i].children.size(); ++k) {
      const int child = nodes[i].children[k];
      int& parent = parents.at(size_t(child));
      if (parent >= 0) {
        document.diagnostics.refuse(
            pointerTo("nodes", i, "children", k),
            "node " + std::to_string(child) + " is already a child of node " + std::to_string(parent));
      }
      parent = int(i);
    }
  }

  // Each node has at most one parent, so a walk upwards that comes back to a node of its own has found a
  // loop. A walk ends at a node of an earlier walk, so no step is repeated.
  std::vector<size_t> walkOf(nodes.size(), nodes.size());
  for (size_t start = 0; start < nodes.size(); ++start) {
    for (int node = int(start); node >= 0 && walkOf[size_t(node)] != start; node = parents[size_t(node)]) {
      if (walkOf[size_t(node)] < nodes.size()) break;
      walkOf[size_t(node)] = start;
      const int parent = parents[size_t(node)];
      if (parent >= 0 && walkOf[size_t(parent)] == start) {
        document.diagnostics.refuse(pointerTo("nodes", parent), "is in a loop: it is its own ancestor");
      }
    }
  }
  return parents;
}

std::vector<int> rootsOf(Document& document, const std::vector<int>& parents) {
  const auto& scenes = document.model.scenes;
  if (!scenes.empty()) {
    const size_t scene = size_t(std::max(document.model.defaultScene, 0));
    std::vector<int> roots;
    std::vector<bool> seen(parents.size(), false);
    std::vector<bool> isChild(parents.size(), false);  // of any node, in the scene or not
    for (const tinygltf::Node& node : document.model.nodes) {
      for (const int child : node.children) isChild.at(size_t(child)) = true;
    }
    for (const int root : scenes.at(scene).nodes) {
      const std::string place = pointerTo("scenes", scene, "nodes");
      if (parents.at(size_t(root)) >= 0) {
        document.diagnostics.refuse(place, "node " + std::to_string(root) + " is not a root node");
      }
      if (isChild[size_t(root)])
        document.diagnostics.warn(place, "node " + std::to_string(root) +
                                             " is not a root node, and stands without what is above it");
      if (seen[size_t(root)])
        document.diagnostics.warn(place,
                                  "names node " + std::to_string(root) + " twice, which is drawn once");
      else
        roots.push_back(root);
      seen[size_t(root)] = true;
    }
    return roots;
  }
  std::vector<int> roots;
  for (size_t i = 0; i < parents.size(); ++i) {
    if (parents[i] < 0) roots.push_back(int(i));
  }
  return roots;
}

bool hidesItself(const nlohmann::json& node) {
  return memberOf(extensionOf(node, "KHR_node_visibility"), "visible") == false;
}

/// Returns, by node, true if the user hides it.
std::vector<bool> chosenByUser(const Document& document, const std::vector<std::string>& toHide) {
  const auto& nodes = document.model.nodes;
  std::vector<bool> chosen(nodes.size(), false);
  std::vector<std::string> names;
  names.reserve(nodes.size());
  for (const tinygltf::Node& node : nodes) names.push_back(node.name);
  for (const std::string& wanted : toHide) {
    bool found = false;
    for (size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].name != wanted && pointerTo("nodes", i) != wanted) continue;
      chosen[i] = found = true;
    }
    if (found) continue;
    const auto index = numberOfAll<size_t>(wanted);
    const bool isIndex = index && *index < nodes.size();
    for (size_t i = 0; !isIndex && i < nodes.size(); ++i) {
      if (isSameButForCase(nodes[i].name, wanted)) chosen[i] = found = true;
    }
    if (found) continue;
    if (!isIndex)
      throw UsageError("--hide: " + inQuotes(wanted) + " is no node of the file, which has " +
                       listOfParts(names, wanted) + "; `fragtrace info --nodes` lists all");
    chosen[*index] = true;
  }
  return chosen;
}

/// A scale of 0, which may well be meant.
bool flattensAll(const glm::dmat4& matrix) { return glm::dmat3(matrix) == glm::dmat3(0.0); }

glm::dmat4 worldTransform(const tinygltf::Node& node, const glm::dmat4& parent, const std::string& place,
                          const Diagnostics& diagnostics) {
  const glm::dmat4 local = localTransform(node, place, diagnostics);
  const glm::dmat4 world = parent * local;
  if (!isMultiplicable(world)) diagnostics.lose(place, "its world transform overflows");
  if (flattensAll(world) && !flattensAll(parent) && !flattensAll(local))
    diagnostics.lose(place, "its world transform underflows");
  return world;
}

}  // namespace

bool isMultiplicable(const glm::dmat4& matrix) {
  constexpr double kLargest = 1e75;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (!(std::abs(matrix[c][r]) <= kLargest)) return false;
    }
  }
  return true;
}

std::vector<PlacedNode> placeNodes(Document& document, const SceneSelection& selection) {
  const std::vector<int> roots = rootsOf(document, parentsOf(document));
  const std::vector<bool> chosen = chosenByUser(document, selection.hiddenNodes);
  std::vector<PlacedNode> placed;
  std::vector<PlacedNode>
      waiting;  // the last one is next; all but index and depth is the parent's until then
  const auto await = [&waiting](const std::vector<int>& nodes, const PlacedNode& parent, int depth) {
    const auto first = std::ptrdiff_t(waiting.size());
    for (const int node : nodes)
      waiting.push_back({node, parent.world, parent.hidden, parent.hiddenInFile, depth});
    std::reverse(waiting.begin() + first, waiting.end());
  };
  await(roots, {.world = glm::dmat4(turnToY(selection.up))}, 0);
  while (!waiting.empty()) {
    PlacedNode node = waiting.back();
    waiting.pop_back();
    const tinygltf::Node& source = document.model.nodes.at(size_t(node.index));
    const std::string place = pointerTo("nodes", node.index);
    const auto world = document.diagnostics.keepRest(
        "the node", [&] { return worldTransform(source, node.world, place, document.diagnostics); });
    if (!world) continue;
    node.world = *world;
    node.hiddenInFile = node.hiddenInFile || hidesItself(jsonOf(document, "nodes", node.index));
    node.hidden = node.hidden || node.hiddenInFile || chosen[size_t(node.index)];
    placed.push_back(node);
    await(source.children, node, node.depth + 1);
  }
  return placed;
}

std::string nameOrPlace(const std::string& name, const char* array, int index) {
  return name.empty() ? pointerTo(array, index) : name;
}

// EXT_mesh_gpu_instancing: a node shows its mesh at translation * rotation * scale, all of them attributes.

namespace {

/// Orders transforms, by position first, since most differ in that.
bool standsBefore(const glm::dmat4& a, const glm::dmat4& b) {
  for (const int c : {3, 0, 1, 2}) {
    for (int r = 0; r < 3; ++r) {
      if (a[c][r] != b[c][r]) return a[c][r] < b[c][r];
    }
  }
  return false;
}

/// Leaves each place once, in the order in which they came, and returns how many there were besides. Rays
/// would have to pass all that coincide, one by one.
size_t dropRepeated(std::vector<glm::dmat4>& places) {
  const size_t count = places.size();
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<size_t> order(places.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    if (standsBefore(places[a], places[b])) return true;
    return !standsBefore(places[b], places[a]) && a < b;
  });
  std::vector<bool> isRepeated(places.size(), false);
  for (size_t i = 1; i < order.size(); ++i) isRepeated[order[i]] = places[order[i]] == places[order[i - 1]];
  size_t kept = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    if (!isRepeated[i]) places[kept++] = places[i];
  }
  places.resize(kept);
  return count - kept;
}

class InstanceReader {
 public:
  InstanceReader(Document& document, const PlacedNode& node, const nlohmann::json& attributes)
      : document_(document),
        node_(node),
        attributes_(attributes),
        place_(pointerTo("nodes", node.index, "extensions", "EXT_mesh_gpu_instancing", "attributes")) {}

  std::vector<glm::dmat4> read() {
    const auto translation = attribute<3>("TRANSLATION");
    const auto rotation = attribute<4>("ROTATION");
    const auto scale = attribute<3>("SCALE");
    warnOthers();
    if (!count_) return {node_.world};
    if (*count_ == 0) document_.diagnostics.warn(place_, "has no elements; the mesh is not drawn");
    takeMemory(document_, place_, *count_ * sizeof(glm::dmat4));
    std::vector<glm::dmat4> places;
    places.reserve(*count_);
    for (size_t i = 0; i < *count_; ++i) {
      glm::dmat4 place(1.0);
      if (!translation.empty()) place = glm::translate(place, glm::dvec3(translation[i]));
      if (!rotation.empty()) place = place * glm::mat4_cast(rotationOf(rotation[i]));
      if (!scale.empty()) place = glm::scale(place, glm::dvec3(scale[i]));
      place = node_.world * place;
      if (isMultiplicable(place)) places.push_back(place);
    }
    const size_t lost = *count_ - places.size();
    const std::string reason = "the world transform of an instance is not finite, or overflows";
    if (places.empty() && lost > 0) document_.diagnostics.lose(place_, reason);
    if (lost > 0) document_.diagnostics.warn(place_, reason + "; the instance is left out", lost);
    if (const size_t count = dropRepeated(places); count > 0)
      document_.diagnostics.warn(place_, "an instance that stands exactly where another one does is left out",
                                 count);
    return places;
  }

 private:
  std::string placeOf(const std::string& name) const { return place_ + pointerTo(name); }

  /// Empty when it is not given.
  template <glm::length_t components>
  std::vector<glm::vec<components, float>> attribute(const char* name) {
    if (!attributes_.contains(name)) return {};
    const int accessor = attributes_[name].get<int>();
    checkType(name, components, document_.model.accessors.at(size_t(accessor)));
    const size_t count = accessorCount(document_, accessor);
    if (count_ && *count_ != count) {
      document_.diagnostics.lose(placeOf(name), "has " + std::to_string(count) + " elements where " + first_ +
                                                    " has " + std::to_string(*count_));
    }
    if (!count_) first_ = name;
    count_ = count;
    takeMemory(document_, placeOf(name), count * sizeof(glm::vec<components, float>));
    return readVectors<components>(document_, accessor, placeOf(name), Integers::Fractions);
  }

  /// Refuses types that the extension does not allow. All attributes may be floats, and rotations also
  /// signed integers.
  void checkType(const char* name, int components, const tinygltf::Accessor& accessor) const {
    const int type = accessor.componentType;
    const bool isSigned = type == TINYGLTF_COMPONENT_TYPE_BYTE || type == TINYGLTF_COMPONENT_TYPE_SHORT;
    const bool isAllowed = type == TINYGLTF_COMPONENT_TYPE_FLOAT || (components == 4 && isSigned);
    if (!isAllowed)
      document_.diagnostics.lose(placeOf(name), components == 4
                                                    ? "is neither of floats nor of signed bytes or shorts"
                                                    : "is not of floats");
  }

  glm::dquat rotationOf(const glm::vec4& r) {
    const glm::dquat rotation(double(r.w), double(r.x), double(r.y), double(r.z));
    const double length = glm::length(rotation);
    if (length != 0.0) return rotation / length;
    document_.diagnostics.warn(placeOf("ROTATION"), "a quaternion of zeros is read as no rotation");
    return {1.0, 0.0, 0.0, 0.0};
  }

  void warnOthers() {
    for (const auto& [name, accessor] : attributes_.items()) {
      const bool isKnown = name == "TRANSLATION" || name == "ROTATION" || name == "SCALE";
      if (!isKnown && !name.starts_with('_'))
        document_.diagnostics.warn(placeOf(name), "is no attribute of instances, and ignored");
    }
  }

  Document& document_;
  const PlacedNode& node_;
  const nlohmann::json& attributes_;
  std::string place_;
  std::optional<size_t> count_;
  std::string first_;  ///< the attribute that the count is of
};

}  // namespace

std::vector<glm::dmat4> placesOfMesh(Document& document, const PlacedNode& node) {
  const nlohmann::json& attributes =
      memberOf(extensionOf(jsonOf(document, "nodes", node.index), "EXT_mesh_gpu_instancing"), "attributes");
  if (!attributes.is_object()) return {node.world};
  if (document.model.nodes.at(size_t(node.index)).skin >= 0) {
    document.diagnostics.warn(pointerTo("nodes", node.index, "extensions", "EXT_mesh_gpu_instancing"),
                              "is ignored: joints place the mesh");
    return {node.world};
  }
  return InstanceReader(document, node, attributes).read();
}

// Nodes that place something other than a mesh.

namespace {

using nlohmann::json;

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

constexpr float kRightAngle = 1.5707964f;

const json& lightsOf(const Document& document) {
  return memberOf(extensionOf(*document.root, "KHR_lights_punctual"), "lights");
}

LightSource sourceOf(const json& described) {
  LightSource source{.name = described.value("name", std::string()),
                     .intensity = numberOf(described, "intensity", 1.0)};
  if (described["type"] == "directional") source.type = LightType::Directional;
  if (described["type"] == "spot") source.type = LightType::Spot;
  const std::vector<double> color = numbersOf(described, "color", {1.0, 1.0, 1.0});
  source.color = {color.at(0), color.at(1), color.at(2)};
  return source;
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

std::vector<LightSource> lightSources(const Document& document) {
  std::vector<LightSource> sources;
  for (const json& described : lightsOf(document)) sources.push_back(sourceOf(described));
  return sources;
}

std::optional<Light> lightAt(Document& document, const PlacedNode& node, const LocalSpace& space) {
  const json& source = jsonOf(document, "nodes", node.index);
  const json& extension = extensionOf(source, "KHR_lights_punctual");
  if (!extension.is_object()) return std::nullopt;
  const int index = extension["light"].get<int>();
  const json& described = lightsOf(document).at(size_t(index));
  const std::string place = pointerTo("extensions", "KHR_lights_punctual", "lights", index);

  Light light;
  LightSource bright = sourceOf(described);
  light.type = bright.type;
  if (light.type == LightType::Spot) {
    light.innerConeAngle = float(numberOf(memberOf(described, "spot"), "innerConeAngle", 0.0));
    light.outerConeAngle = float(numberOf(memberOf(described, "spot"), "outerConeAngle", 0.0));
    // mendValues() has put the file's angles in order, but not those of --set and of animations.
    if (!(light.innerConeAngle >= 0.0f && light.innerConeAngle <= light.outerConeAngle) ||
        light.outerConeAngle > kRightAngle)
      document.diagnostics.lose(place + "/spot", "the cone angles do not fulfil 0 <= inner <= outer <= pi/2");
  }
  light.source = uint32_t(index);
  light.place = pointerTo("nodes", node.index);
  light.node = nameOrPlace(source.value("name", std::string()), "nodes", node.index);
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
  const double range = numberOf(described, "range", 0.0);
  if (range < 0.0) document.diagnostics.lose(place + "/range", "is negative");
  if (range > 0.0) light.range = float(range / space.unit);
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

std::optional<Volume> volumeAt(Document& document, const PlacedNode& node) {
  const json& object = memberOf(memberOf(jsonOf(document, "nodes", node.index), "extras"), kName);
  if (!object.is_object()) return std::nullopt;
  const std::string place = pointerTo("nodes", node.index, "extras", kName);
  const auto checked = [&](const char* name, double value, double least, double most) {
    if (!(value >= least && value <= most))
      document.diagnostics.refuse(place + "/" + name,
                                  "is not in the range " + shortText(least) + " to " + shortText(most));
    return value;
  };
  const auto number = [&](const char* name, double least, double most) -> std::optional<double> {
    if (!object.contains(name)) return std::nullopt;
    return checked(name, numberOf(object, name, 0.0), least, most);
  };
  const auto vector = [&](const char* name, double least, double most) -> std::optional<glm::dvec3> {
    if (!object.contains(name)) return std::nullopt;
    glm::dvec3 result;
    for (int i = 0; i < 3; ++i) result[i] = checked(name, object[name][size_t(i)], least, most);
    return result;
  };
  for (const auto& [key, member] : object.items()) {
    if (std::ranges::find(kMembers, key) == std::end(kMembers))
      document.diagnostics.warn(pointerTo("nodes", node.index, "extras", kName, key),
                                "is no member of a volume and is ignored");
  }
  Volume volume;
  volume.source = volumeFile(object["volume"].get<std::string>());
  if (volume.source.file.empty()) document.diagnostics.refuse(place + "/volume", "names no file");
  volume.source.position = vector("position", -kFarthest, kFarthest);
  volume.source.scale = number("scale", kLeastVolumeScale, kMostVolumeScale);
  volume.source.density = number("density", 0.0, kMostVolumeFactor);
  if (const auto color = vector("color", 0.0, 1.0)) volume.source.color = glm::vec3(*color);
  volume.source.anisotropy = number("anisotropy", -kMostAnisotropy, kMostAnisotropy);
  volume.source.emission = number("emission", 0.0, kMostVolumeFactor);
  volume.toWorld = node.world;
  const std::string uri = volume.source.file.string();
  volume.file = document.diagnostics.attempt(place + "/volume",
                                             [&] { return readUri(document.access, uri, document.memory); });
  takeMemory(document, place + "/volume", volume.file.size());
  volume.source.file = isDataUri(uri) ? std::filesystem::path(place) : pathOfUri(document.access, uri);
  return volume;
}

std::optional<PlacedSphere> sphereAt(Document& document, const PlacedNode& node) {
  const json& source = jsonOf(document, "nodes", node.index);
  const json& shapes = memberOf(extensionOf(*document.root, "KHR_implicit_shapes"), "shapes");
  const json& chosen = memberOf(memberOf(source, "extras"), "shape");
  if (!shapes.is_array() || !chosen.is_number_integer()) return std::nullopt;

  const std::string place = pointerTo("nodes", node.index);
  const auto checked = [&](const json& index, const char* member, size_t count, const char* what) {
    if (!index.is_number_unsigned() || index.get<size_t>() >= count)
      document.diagnostics.refuse(place + "/extras/" + member, "index " + index.dump() + " is past the " +
                                                                   std::to_string(count) + " " + what);
    return index.get<size_t>();
  };
  const size_t index = checked(chosen, "shape", shapes.size(), "shapes");
  document.diagnostics.need(pointerTo("extensions", "KHR_implicit_shapes", "shapes", index));
  const json& shape = shapes[index];
  const auto& type = shape["type"].get_ref<const std::string&>();
  if (type != "sphere") {
    document.diagnostics.warn(place + "/extras/shape", "a shape of type " + inQuotes(type) + " is left out");
    return std::nullopt;
  }

  PlacedSphere sphere;
  sphere.node = nameOrPlace(source.value("name", std::string()), "nodes", node.index);
  sphere.nodeIndex = uint32_t(node.index);
  const size_t materialCount = memberOf(*document.root, "materials").size();
  const json& material = memberOf(source["extras"], "material");
  sphere.material =
      uint32_t(material.is_number_integer() ? checked(material, "material", materialCount, "materials")
                                            : materialCount);

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
