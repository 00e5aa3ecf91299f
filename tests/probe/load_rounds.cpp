// SPDX-License-Identifier: MIT
// load_rounds SCENE...: loads, uploads and drops scenes in turn, 1,000 rounds in one process. Memory may grow
// by 5 MiB from the 50th on, and what was made on the device must be gone.
#include <malloc.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <memory>

#include "bvh/bvh.h"
#include "gl/context.h"
#include "gltf/gltf.h"
#include "pack/gpu_scene.h"
#include "render/film.h"
#include "render/renderer.h"
#include "stage/variant.h"

namespace fragtrace {
namespace {

constexpr int kRounds = 1000;
constexpr int kWarmUp = 50;
constexpr double kMostGrowth = 5.0;  // MiB

double residentMebibytes() {
  malloc_trim(0);
  long pages = 0;
  std::ifstream("/proc/self/statm") >> pages >> pages;
  return double(pages) * double(::sysconf(_SC_PAGESIZE)) / (1 << 20);
}

void loadAndDrop(const Context& context, const std::filesystem::path& path) {
  const Scene scene = loadGltf(path);
  const Bvh bvh = buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size()));
  const Environment surroundings;
  const ShaderVariant variant =
      chooseVariant({}, traitsOf(scene, surroundings.kind), surroundings.kind, bvh.depth, BufferReads::Image);
  const Renderer renderer(context, packScene(scene, bvh, surroundings, variant), BufferReads::Image);
  const Film film({64, 64});
}

/// The driver gives the lowest free names, so that a leaked object moves the next one's.
std::array<GLuint, 3> nextNames() {
  std::array<GLuint, 3> names{};
  glGenBuffers(1, &names[0]);
  glGenTextures(1, &names[1]);
  glGenFramebuffers(1, &names[2]);
  glDeleteBuffers(1, &names[0]);
  glDeleteTextures(1, &names[1]);
  glDeleteFramebuffers(1, &names[2]);
  return names;
}

int run(std::span<char*> scenes) {
  const auto context = makeContext(Backend::Auto);
  const auto names = nextNames();
  double before = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    loadAndDrop(*context, scenes[size_t(round) % scenes.size()]);
    if (round == kWarmUp) before = residentMebibytes();
  }
  const double growth = residentMebibytes() - before;
  std::printf("%d rounds: memory grew by %.2f MiB from round %d on\n", kRounds, growth, kWarmUp);
  if (growth > kMostGrowth) return 1;
  if (nextNames() == names) return 0;
  std::printf("objects were left on the device\n");
  return 1;
}

}  // namespace
}  // namespace fragtrace

int main(int argc, char** argv) { return fragtrace::run({argv + 1, size_t(argc - 1)}); }
