// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/sketch.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "image/files/whole_file.h"

namespace fragtrace {

namespace {

using nlohmann::json;

json numbers(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

json numbers(const glm::dmat4& m) {
  json list = json::array();
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) list.push_back(m[c][r]);
  }
  return list;
}

json materialJson(const SketchMaterial& m) {
  json material = {{"pbrMetallicRoughness",
                    {{"baseColorFactor", {m.color.x, m.color.y, m.color.z, m.alpha}},
                     {"metallicFactor", m.metallic},
                     {"roughnessFactor", m.roughness}}},
                   {"doubleSided", m.doubleSided}};
  if (m.alpha < 1.0) material["alphaMode"] = "BLEND";
  if (m.colorTexture >= 0) {
    const json transform = {{"scale", {m.textureScale.x, m.textureScale.y}}, {"rotation", m.textureTurn}};
    material["pbrMetallicRoughness"]["baseColorTexture"] = {
        {"index", m.colorTexture}, {"extensions", {{"KHR_texture_transform", transform}}}};
  }
  if (m.normalTexture >= 0) material["normalTexture"]["index"] = m.normalTexture;
  if (m.emission != glm::dvec3(0.0)) material["emissiveFactor"] = numbers(m.emission);
  json& extensions = material["extensions"] = json::object();
  if (m.transmission > 0.0)
    extensions["KHR_materials_transmission"] = {{"transmissionFactor", m.transmission}};
  if (m.thickness > 0.0) {
    extensions["KHR_materials_volume"] = {{"thicknessFactor", m.thickness}};
    if (m.attenuationDistance > 0.0) {
      extensions["KHR_materials_volume"]["attenuationDistance"] = m.attenuationDistance;
      extensions["KHR_materials_volume"]["attenuationColor"] = {0.4, 0.7, 0.9};
    }
  }
  return material;
}

class Writer {
 public:
  void write(const SceneSketch& sketch, const std::filesystem::path& folder) {
    root_["asset"]["version"] = "2.0";
    root_["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_transmission", "KHR_materials_volume",
                               "KHR_texture_transform", "KHR_implicit_shapes"};
    for (const SketchTexture& texture : sketch.textures) addTexture(texture, folder);
    for (const SketchMaterial& m : sketch.materials) root_["materials"].push_back(materialJson(m));
    for (const SketchMesh& mesh : sketch.meshes) addMesh(mesh);
    addNodes(sketch);
    root_["buffers"] = {{{"byteLength", bytes_.size()}, {"uri", "sketch.bin"}}};
    replaceFile(folder / "sketch.bin", bytes_);
    const std::string text = root_.dump();
    replaceFile(folder / "sketch.gltf", std::vector<uint8_t>(text.begin(), text.end()));
  }

 private:
  template <typename Element>
  size_t addAccessor(const std::vector<Element>& elements, const char* type, int componentType,
                     size_t count) {
    const size_t size = elements.size() * sizeof(Element);
    root_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}});
    const auto* first = reinterpret_cast<const uint8_t*>(elements.data());
    bytes_.insert(bytes_.end(), first, first + size);
    root_["accessors"].push_back({{"bufferView", root_["bufferViews"].size() - 1},
                                  {"componentType", componentType},
                                  {"count", count},
                                  {"type", type}});
    return root_["accessors"].size() - 1;
  }

  void addTexture(const SketchTexture& texture, const std::filesystem::path& folder) {
    const size_t index = root_["images"].size();
    const std::string name = std::to_string(index) + ".png";
    Image picture{texture.side, texture.side, {"R", "G", "B"}, {}, {}};
    for (const glm::u8vec3& texel : texture.texels) {
      for (int c = 0; c < 3; ++c) picture.values.push_back(float(texel[c]) / 255.0f);
    }
    writeImage(folder / name, picture);
    root_["images"].push_back({{"uri", name}});
    root_["samplers"].push_back({{"wrapS", texture.wrap}, {"wrapT", texture.wrap}});
    root_["textures"].push_back({{"source", index}, {"sampler", index}});
  }

  void addMesh(const SketchMesh& mesh) {
    constexpr int kFloat = 5126;
    constexpr int kUnsigned = 5125;
    json primitive = {{"material", mesh.material}};
    primitive["attributes"]["POSITION"] = addAccessor(mesh.positions, "VEC3", kFloat, mesh.positions.size());
    if (!mesh.normals.empty())
      primitive["attributes"]["NORMAL"] = addAccessor(mesh.normals, "VEC3", kFloat, mesh.normals.size());
    if (!mesh.tangents.empty())
      primitive["attributes"]["TANGENT"] = addAccessor(mesh.tangents, "VEC4", kFloat, mesh.tangents.size());
    if (!mesh.texcoords.empty())
      primitive["attributes"]["TEXCOORD_0"] =
          addAccessor(mesh.texcoords, "VEC2", kFloat, mesh.texcoords.size());
    primitive["indices"] = addAccessor(mesh.triangles, "SCALAR", kUnsigned, mesh.triangles.size() * 3);
    root_["meshes"].push_back({{"primitives", {primitive}}});
  }

  size_t addSphere(double radius) {
    json& shapes = root_["extensions"]["KHR_implicit_shapes"]["shapes"];
    shapes.push_back({{"type", "sphere"}, {"sphere", {{"radius", radius}}}});
    return shapes.size() - 1;
  }

  void addNodes(const SceneSketch& sketch) {
    json& nodes = root_["nodes"];
    nodes.push_back({{"matrix", numbers(sketch.root)}, {"children", json::array()}});
    const auto add = [&nodes](json node, size_t parent) {
      nodes[parent]["children"].push_back(nodes.size());
      nodes.push_back(std::move(node));
    };
    for (const SketchNode& from : sketch.nodes) {
      json node = {{"matrix", numbers(from.local)}};
      if (from.mesh >= 0) node["mesh"] = from.mesh;
      if (from.radius > 0.0)
        node["extras"] = {{"shape", addSphere(from.radius)}, {"material", from.sphereMaterial}};
      add(std::move(node), size_t(from.parent) + 1);
    }
    for (const SketchLight& light : sketch.lights) {
      json& lights = root_["extensions"]["KHR_lights_punctual"]["lights"];
      lights.push_back({{"type", "point"}, {"intensity", light.intensity}});
      add({{"translation", numbers(light.position)},
           {"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}},
          0);
    }
    root_["cameras"] = {{{"type", "perspective"},
                         {"perspective", {{"yfov", sketch.fovY}, {"znear", 0.01}, {"aspectRatio", 1.0}}}}};
    add({{"camera", 0}, {"matrix", numbers(sketch.camera)}}, 0);
    root_["scenes"] = {{{"nodes", {0}}}};
  }

  json root_ = json::object();
  std::vector<uint8_t> bytes_;
};

}  // namespace

glm::dmat4 lookingFrom(const glm::dvec3& from, const glm::dvec3& at) {
  const glm::dvec3 backward = glm::normalize(from - at);
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), backward));
  const glm::dvec3 up = glm::cross(backward, right);
  return {glm::dvec4(right, 0), glm::dvec4(up, 0), glm::dvec4(backward, 0), glm::dvec4(from, 1)};
}

void writeSketch(const SceneSketch& sketch, const std::filesystem::path& folder) {
  Writer().write(sketch, folder);
}

}  // namespace fragtrace
