// SPDX-License-Identifier: MIT
// libFuzzer's target over the loader: any bytes are a scene whose indices are right, or an InputError.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>

#include "errors.h"
#include "gltf/gltf.h"

namespace {

/// In an empty folder, so that no URI leads anywhere; in memory, where there is such a place.
std::filesystem::path scratchFile() {
  std::string folder = std::filesystem::is_directory("/dev/shm") ? "/dev/shm/fragtrace-fuzz-XXXXXX"
                                                                 : "/tmp/fragtrace-fuzz-XXXXXX";
  if (::mkdtemp(folder.data()) == nullptr) std::abort();
  static const std::string kept = folder;
  std::atexit([] {
    std::error_code ignored;
    std::filesystem::remove_all(kept, ignored);
  });
  return std::filesystem::path(folder) / "scene.gltf";
}

void expect(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "fuzz: %s\n", what);
  std::abort();
}

void checkScene(const fragtrace::Scene& scene) {
  for (const fragtrace::Triangle& triangle : scene.triangles) {
    expect(triangle.material < scene.materials.size(), "a material past the end");
    for (int c = 0; c < 3; ++c)
      expect(triangle.vertex[c] < scene.vertices.position.size(), "a vertex past the end");
  }
  for (const glm::vec3& p : scene.vertices.position)
    expect(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "a position that is not finite");
  for (const fragtrace::Texture& texture : scene.textures)
    expect(texture.image < scene.images.size(), "an image past the end");
  const size_t vertices = scene.vertices.position.size();
  for (const size_t count : {scene.vertices.normal.size(), scene.vertices.tangent.size(),
                             scene.vertices.texcoord0.size(), scene.vertices.color.size()})
    expect(count == 0 || count == vertices, "attributes of another length");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const std::filesystem::path path = scratchFile();
  std::FILE* file = std::fopen(path.c_str(), "wb");
  expect(file != nullptr && std::fwrite(data, 1, size, file) == size && std::fclose(file) == 0,
         "no scratch file");
  fragtrace::GltfOptions options;
  options.limits.memoryBytes = uint64_t(64) << 20;
  options.selection.animationTime = 0.5;  // where there is no animation, that is a warning
  try {
    checkScene(fragtrace::loadGltf(path, options));
  } catch (const fragtrace::InputError& error) {
    // What the standard library or the JSON library throws is a check of ours that is missing.
    const std::string message = error.what();
    const size_t reason = path.string().size() + 2;
    for (const char* internal : {"vector", "map", "basic_string", "std::", "bad_", "[json", "invalid", "sto"})
      expect(message.size() < reason || message.compare(reason, std::strlen(internal), internal) != 0,
             message.c_str());
    expect(message.size() < 2000, "a very long message");
    expect(message.find('\n') == std::string::npos, "more than one line");
  }
  return 0;
}
