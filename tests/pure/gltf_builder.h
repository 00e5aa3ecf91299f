// SPDX-License-Identifier: MIT
// Small glTF files, built by the tests that load them.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/errors.h"
#include "gltf/gltf.h"

namespace fragtrace::gltf_test {

using nlohmann::json;

/// A PNG of one bluish pixel.
inline const std::string kPixelUri =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNoaPgPAAODAgAApfuJAAAAAElFTkSuQmCC";

/// A folder that goes with the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("fragtrace-gltf-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string base64(const std::string& bytes) {
  static const char* const kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kAlphabet[bits >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

/// glTF component types by C++ type.
template <typename Component>
constexpr int componentTypeOf() {
  if constexpr (std::is_same_v<Component, int8_t>) return 5120;
  if constexpr (std::is_same_v<Component, uint8_t>) return 5121;
  if constexpr (std::is_same_v<Component, int16_t>) return 5122;
  if constexpr (std::is_same_v<Component, uint16_t>) return 5123;
  if constexpr (std::is_same_v<Component, uint32_t>) return 5125;
  return 5126;
}

/// A document with one buffer; `root` may be changed in any way before it is written.
class GltfBuilder {
 public:
  json root = {{"asset", {{"version", "2.0"}}}};

  template <typename Component>
  int addView(const std::vector<Component>& values) {
    buffer_.resize((buffer_.size() + 3) / 4 * 4);
    const size_t size = values.size() * sizeof(Component);
    root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", size}});
    buffer_.append(reinterpret_cast<const char*>(values.data()), size);
    return int(root["bufferViews"].size()) - 1;
  }

  template <typename Component>
  int addAccessor(const std::string& type, const std::vector<Component>& values, bool normalized = false) {
    const size_t components = type == "SCALAR" ? 1 : size_t(type[3] - '0');
    root["accessors"].push_back({{"bufferView", addView(values)},
                                 {"componentType", componentTypeOf<Component>()},
                                 {"count", values.size() / components},
                                 {"type", type}});
    if (normalized) root["accessors"].back()["normalized"] = true;
    return int(root["accessors"].size()) - 1;
  }

  /// A mesh of one primitive and a node that shows it; returns the primitive.
  json& addMesh(const json& attributes) {
    root["meshes"].push_back({{"primitives", {{{"attributes", attributes}}}}});
    root["nodes"].push_back({{"mesh", root["meshes"].size() - 1}});
    return root["meshes"].back()["primitives"][0];
  }

  /// The triangle (0,0,0), (1,0,0), (0,1,0), front towards +z.
  json& addTriangle() {
    return addMesh({{"POSITION", addAccessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0})}});
  }

  json& node(size_t index) { return root["nodes"][index]; }

  /// Makes the buffer part of the document, so that it may be changed.
  void embedBuffer() {
    root["buffers"] = {
        {{"byteLength", buffer_.size()}, {"uri", "data:application/octet-stream;base64," + base64(buffer_)}}};
  }

  /// The document, with the buffer embedded unless the test has described one.
  std::string text() const {
    GltfBuilder whole = *this;
    if (!buffer_.empty() && !root.contains("buffers")) whole.embedBuffer();
    return whole.root.dump();
  }

  std::string glb() {
    root["buffers"] = {{{"byteLength", buffer_.size()}}};
    std::string document = root.dump();
    document.resize((document.size() + 3) / 4 * 4, ' ');
    std::string binary = buffer_;
    binary.resize((binary.size() + 3) / 4 * 4);
    const auto word = [](size_t value) {
      const auto bits = uint32_t(value);
      return std::string{char(bits), char(bits >> 8), char(bits >> 16), char(bits >> 24)};
    };
    return "glTF" + word(2) + word(28 + document.size() + binary.size()) + word(document.size()) + "JSON" +
           document + word(binary.size()) + std::string("BIN\0", 4) + binary;
  }

  const std::string& buffer() const { return buffer_; }

 private:
  std::string buffer_;
};

inline Scene load(GltfBuilder& builder, const GltfOptions& options = {}) {
  const TemporaryFolder folder;
  return loadGltf(folder.write("test.gltf", builder.text()), options);
}

/// The message of the InputError that loading ends in, from the file's name on; empty if it is loaded.
inline std::string refusalOf(const std::filesystem::path& path) {
  try {
    loadGltf(path);
  } catch (const InputError& error) {
    const std::string message = error.what();
    const std::string folder = path.parent_path().string() + "/";
    return message.starts_with(folder) ? message.substr(folder.size()) : message;
  }
  return "";
}

/// The same, or the first warning where the file is loaded.
inline std::string faultOf(const std::filesystem::path& path, const GltfOptions& options = {}) {
  std::string message;
  try {
    const Scene scene = loadGltf(path, options);
    if (!scene.warnings.empty()) message = scene.warnings[0];
  } catch (const InputError& error) {
    message = error.what();
  }
  const std::string folder = path.parent_path().string() + "/";
  return message.starts_with(folder) ? message.substr(folder.size()) : message;
}

inline std::string faultOf(GltfBuilder& builder, const GltfOptions& options = {}) {
  const TemporaryFolder folder;
  return faultOf(folder.write("test.gltf", builder.text()), options);
}

inline std::string refusalOf(GltfBuilder& builder) {
  const TemporaryFolder folder;
  return refusalOf(folder.write("test.gltf", builder.text()));
}

inline glm::vec3 cornerOf(const Scene& scene, size_t triangle, int corner) {
  return scene.vertices.position.at(scene.triangles.at(triangle).vertex[corner]);
}

/// World position, from the local one.
inline glm::dvec3 worldCornerOf(const Scene& scene, size_t triangle, int corner) {
  return glm::dvec3(cornerOf(scene, triangle, corner)) * scene.space.unit + scene.space.origin;
}

/// Returns a normal on the front side. It is not a unit vector.
inline glm::vec3 frontOf(const Scene& scene, size_t triangle) {
  const glm::vec3 a = cornerOf(scene, triangle, 0);
  return glm::cross(cornerOf(scene, triangle, 1) - a, cornerOf(scene, triangle, 2) - a);
}

inline bool isNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-6) {
  return glm::distance(a, b) <= tolerance;
}

inline bool isNear(const glm::vec3& a, const glm::dvec3& b, double tolerance = 1e-6) {
  return isNear(glm::dvec3(a), b, tolerance);
}

inline bool anyWarningHas(const Scene& scene, const std::string& text) {
  for (const std::string& warning : scene.warnings) {
    if (warning.find(text) != std::string::npos) return true;
  }
  return false;
}

}  // namespace fragtrace::gltf_test
