// SPDX-License-Identifier: MIT
#include "gltf/build/added_lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/up_axis.h"

namespace fragtrace {

namespace {

using nlohmann::json;

/// The array, for one more element; one of a wrong type is left to the checks, and gets none.
json* arrayOf(json& object, const char* name) {
  if (!object.contains(name)) object[name] = json::array();
  return object[name].is_array() ? &object[name] : nullptr;
}

/// Appends the element, and returns its index.
size_t append(json& object, const char* name, json element) {
  json* array = arrayOf(object, name);
  if (array == nullptr) return 0;
  array->push_back(std::move(element));
  return array->size() - 1;
}

void useExtension(json& root, const char* name) {
  json* used = arrayOf(root, "extensionsUsed");
  if (used != nullptr && std::ranges::find(*used, json(name)) == used->end()) used->push_back(name);
}

/// The matrix of a node at a place of the space that is drawn, whose Z axis has this direction there.
json matrixOf(const glm::dvec3& place, const glm::dvec3& direction, const glm::dvec3& up) {
  const glm::dvec3 z = glm::normalize(direction);
  const glm::dvec3 upward = std::abs(z.y) < 0.999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
  const glm::dvec3 x = glm::normalize(glm::cross(upward, z));
  const glm::dmat3 toFile = glm::transpose(turnToY(up));
  json numbers = json::array();
  for (const glm::dvec3& axis : {x, glm::cross(z, x), z}) {
    const glm::dvec3 turned = toFile * axis;
    for (const double number : {turned.x, turned.y, turned.z, 0.0}) numbers.push_back(number);
  }
  const glm::dvec3 turned = toFile * place;
  for (const double number : {turned.x, turned.y, turned.z, 1.0}) numbers.push_back(number);
  return numbers;
}

/// The bytes of floats as a data URI.
std::string uriOf(std::span<const float> values) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<uint8_t> bytes(values.size_bytes());
  std::memcpy(bytes.data(), values.data(), bytes.size());
  std::string text = "data:application/octet-stream;base64,";
  for (size_t i = 0; i + 2 < bytes.size(); i += 3) {  // a multiple of three: triangles have nine floats
    const uint32_t word = uint32_t(bytes[i]) << 16 | uint32_t(bytes[i + 1]) << 8 | bytes[i + 2];
    for (const int shift : {18, 12, 6, 0}) text += kDigits[word >> shift & 63];
  }
  return text;
}

/// A material that is black but for the light that it sends, the same in all directions of one side.
json shining(const AddedLight& light, const std::string& name) {
  const double most = std::max({light.color.x, light.color.y, light.color.z});
  const double radiance = light.strength / (glm::pi<double>() * light.size.x * light.size.y);
  const glm::dvec3 color = light.color / most;
  return {{"name", name},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
          {"emissiveFactor", {color.x, color.y, color.z}},
          {"extensions",
           {{"KHR_materials_emissive_strength", {{"emissiveStrength", radiance * most}}},
            {"KHR_materials_specular", {{"specularFactor", 0}}}}}};
}

/// The mesh of an area.
size_t addArea(json& root, const AddedLight& light, const std::string& name) {
  const auto x = float(0.5 * light.size.x);
  const auto y = float(0.5 * light.size.y);
  const std::array<float, 18> corners{-x, -y, 0, x, -y, 0, x, y, 0, -x, -y, 0, x, y, 0, -x, y, 0};
  const size_t bytes = sizeof corners;
  const size_t buffer = append(root, "buffers", {{"byteLength", bytes}, {"uri", uriOf(corners)}});
  const size_t view = append(root, "bufferViews", {{"buffer", buffer}, {"byteLength", bytes}});
  const size_t positions = append(root, "accessors",
                                  {{"bufferView", view},
                                   {"componentType", 5126u},
                                   {"count", corners.size() / 3},
                                   {"type", "VEC3"},
                                   {"min", {-x, -y, 0}},
                                   {"max", {x, y, 0}}});
  const size_t material = append(root, "materials", shining(light, name));
  for (const char* used : {"KHR_materials_emissive_strength", "KHR_materials_specular"})
    useExtension(root, used);
  json primitive = {{"attributes", {{"POSITION", positions}}}, {"material", material}};
  return append(root, "meshes", {{"primitives", json::array({primitive})}});
}

/// The index of the light of a sun.
size_t addSun(json& root, const AddedLight& light, const std::string& name) {
  constexpr const char* kPunctual = "KHR_lights_punctual";
  useExtension(root, kPunctual);
  if (!root["extensions"].is_object()) root["extensions"] = json::object();
  json& punctual = root["extensions"][kPunctual];
  if (!punctual.is_object()) punctual = json::object();
  return append(punctual, "lights",
                {{"name", name},
                 {"type", "directional"},
                 {"color", {light.color.x, light.color.y, light.color.z}},
                 {"intensity", light.strength}});
}

json nodeOf(json& root, const AddedLight& light, const std::string& name, const glm::dvec3& up) {
  if (!light.isSun) {
    const glm::dvec3 faces = light.target ? *light.target - light.at : glm::dvec3(0, -1, 0);
    return {{"name", name}, {"mesh", addArea(root, light, name)}, {"matrix", matrixOf(light.at, faces, up)}};
  }
  const glm::dvec2 angles = glm::radians(light.from);
  const glm::dvec3 towards(std::cos(angles.y) * std::sin(angles.x), std::sin(angles.y),
                           std::cos(angles.y) * std::cos(angles.x));
  json node = {{"name", name}, {"matrix", matrixOf(glm::dvec3(0.0), towards, up)}};
  node["extensions"]["KHR_lights_punctual"]["light"] = addSun(root, light, name);
  return node;
}

}  // namespace

void addLights(json& root, std::span<const AddedLight> lights, const glm::dvec3& up) {
  for (size_t i = 0; i < lights.size(); ++i) {
    const std::string name = (lights[i].isSun ? "added sun " : "added area ") + std::to_string(i + 1);
    const size_t node = append(root, "nodes", nodeOf(root, lights[i], name, up));
    if (!root.contains("scenes")) continue;  // then all nodes are drawn
    for (json& scene : root["scenes"]) {
      if (scene.is_object()) append(scene, "nodes", node);
    }
  }
}

}  // namespace fragtrace
