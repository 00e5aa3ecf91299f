// SPDX-License-Identifier: MIT
// libFuzzer's target over the loader: any bytes are a scene whose indices are right, or an InputError. What
// has meshes that stand in it several times is loaded with copies and with instances, which must be the same
// scene.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "base/errors.h"
#include "bvh/bvh.h"
#include "gltf/gltf.h"
#include "image/image.h"

namespace fragtrace {

/// Pictures are decoded by another process (src/base/worker), which is not what this target tries.
TexelImage decodeTexels(std::span<const uint8_t>, const std::string&) { return {}; }

}  // namespace fragtrace

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
  const auto isFinite = [](const auto& v) { return std::isfinite(double(glm::dot(v, v))); };
  for (const fragtrace::Light& light : scene.lights)
    expect(isFinite(light.direction) &&
               (light.type == fragtrace::LightType::Directional || isFinite(light.position)),
           "a light that is nowhere");
  for (const fragtrace::Sphere& sphere : scene.spheres)
    expect(isFinite(sphere.center) && sphere.radius >= 0.0f && std::isfinite(sphere.radius),
           "a sphere that is nowhere");
  for (const fragtrace::Camera& camera : scene.cameras)
    expect(isFinite(camera.position) && isFinite(camera.forward) && isFinite(camera.up),
           "a camera that is nowhere");
  for (const fragtrace::Texture& texture : scene.textures)
    expect(texture.image < scene.images.size(), "an image past the end");
  const size_t vertices = scene.vertices.position.size();
  for (const size_t count : {scene.vertices.normal.size(), scene.vertices.tangent.size(),
                             scene.vertices.texcoord0.size(), scene.vertices.color.size()})
    expect(count == 0 || count == vertices, "attributes of another length");
}

/// Triangles that are drawn: those of shared meshes count for each instance.
uint64_t checkInstances(const fragtrace::Scene& scene) {
  uint64_t expected = flatTriangleCount(scene);
  for (const fragtrace::SharedMesh& mesh : scene.sharedMeshes) {
    expect(mesh.firstTriangle == expected && mesh.triangleCount > 0, "shared meshes that are not in a row");
    expected += mesh.triangleCount;
  }
  expect(expected == scene.triangles.size(), "triangles of no mesh");
  uint64_t drawn = flatTriangleCount(scene);
  for (const fragtrace::Instance& instance : scene.instances) {
    expect(instance.mesh < scene.sharedMeshes.size(), "a shared mesh past the end");
    drawn += scene.sharedMeshes[instance.mesh].triangleCount;
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 4; ++r) expect(std::isfinite(float(instance.toLocal[c][r])), "a matrix not finite");
    }
    expect(std::isfinite(1.0 / glm::determinant(glm::dmat3(instance.toLocal))),
           "a matrix without an inverse");
  }
  constexpr uint64_t kFew = 5000;
  if (!scene.instances.empty() && scene.triangles.size() + scene.instances.size() < kFew) {
    const fragtrace::Bvh bvh = buildSceneBvh(scene);
    expect(bvh.meshes.size() == scene.sharedMeshes.size(), "trees of other meshes");
    expect(bvh.depth <= fragtrace::kMaxTwoLevelDepth, "a tree too deep");
    for (const fragtrace::BvhNode& node : bvh.nodes) {
      for (const fragtrace::Bounds& box : node.bounds)
        expect(glm::all(glm::lessThanEqual(box.minimum, box.maximum)), "a box that is none");
    }
  }
  return drawn;
}

void checkRefusal(const std::filesystem::path& path, const std::string& message) {
  // If the standard library or the JSON library has thrown, a check of ours is missing.
  const size_t reason = path.string().size() + 2;
  for (const char* internal : {"vector", "map", "basic_string", "std::", "bad_", "[json", "invalid", "sto"})
    expect(message.size() < reason || message.compare(reason, std::strlen(internal), internal) != 0,
           message.c_str());
  expect(message.size() < 2000, "a very long message");
  expect(message.find('\n') == std::string::npos, "more than one line");
}

/// None where the file is refused.
std::optional<fragtrace::Scene> load(const std::filesystem::path& path, fragtrace::Instancing instancing) {
  fragtrace::GltfOptions options;
  options.limits.memoryBytes = uint64_t(64) << 20;
  options.selection.animationTime = 0.5;  // without an animation, that is a warning
  options.instancing = instancing;
  try {
    fragtrace::Scene scene = fragtrace::loadGltf(path, options);
    checkScene(scene);
    return scene;
  } catch (const fragtrace::InputError& error) {
    checkRefusal(path, error.what());
    return std::nullopt;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const std::filesystem::path path = scratchFile();
  std::FILE* file = std::fopen(path.c_str(), "wb");
  expect(file != nullptr && std::fwrite(data, 1, size, file) == size && std::fclose(file) == 0,
         "no scratch file");
  const auto flat = load(path, fragtrace::Instancing::Flatten);
  if (!flat || flat->origins.size() < 2) return 0;
  expect(flat->instances.empty(), "instances without being asked for");
  const auto shared = load(path, fragtrace::Instancing::Share);
  if (!shared) return 0;  // many instances of a few triangles take more memory than copies
  expect(checkInstances(*shared) == flat->triangles.size(), "instances that are not the copies");
  expect(flat->bounds.empty() == shared->bounds.empty(), "other bounds");
  return 0;
}
