// SPDX-License-Identifier: MIT
// load_rounds SCENE...: loads, uploads and drops scenes in turn, with a program, 1,000 rounds in one process.
// Memory may grow by 5 MiB from the 50th on, and every object that was made on the device must be gone.
#include <malloc.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <memory>

#include "bvh/bvh.h"
#include "gl/context.h"
#include "gl/program.h"
#include "gltf/gltf.h"
#include "pack/gpu_scene.h"
#include "render/film.h"
#include "render/renderer.h"
#include "shader/variant.h"

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
  const ShaderVariant variant = chooseVariant({}, traitsOf(scene, surroundings.kind), surroundings.kind,
                                              bvh.stackNeed, BufferReads::Image);
  const Renderer renderer(context, packScene(scene, bvh, surroundings, variant), BufferReads::Image);
  const Film film({64, 64});
  const GlProgram program =
      buildProgram("#version 450 core\nvoid main() {}\n", "#version 450 core\nvoid main() {}\n");
}

struct ObjectKind {
  const char* name;
  GLboolean (*lives)(GLuint);
};

const std::array<ObjectKind, 7> kObjectKinds{{
    {"buffers", [](GLuint name) { return glIsBuffer(name); }},
    {"textures", [](GLuint name) { return glIsTexture(name); }},
    {"framebuffers", [](GLuint name) { return glIsFramebuffer(name); }},
    {"vertex arrays", [](GLuint name) { return glIsVertexArray(name); }},
    {"queries", [](GLuint name) { return glIsQuery(name); }},
    {"shaders", [](GLuint name) { return glIsShader(name); }},
    {"programs", [](GLuint name) { return glIsProgram(name); }},
}};

/// Returns the number of living objects of each kind. Drivers may or may not give a name twice, so all names
/// that the rounds can have got are tried.
std::array<int, kObjectKinds.size()> livingObjects() {
  constexpr GLuint kNames = 100 * kRounds;
  std::array<int, kObjectKinds.size()> living{};
  for (size_t kind = 0; kind < kObjectKinds.size(); ++kind) {
    for (GLuint name = 1; name <= kNames; ++name) living[kind] += kObjectKinds[kind].lives(name) == GL_TRUE;
  }
  return living;
}

int run(std::span<char*> scenes) {
  const auto context = makeContext(DeviceOptions{});
  const auto atFirst = livingObjects();
  double before = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    loadAndDrop(*context, scenes[size_t(round) % scenes.size()]);
    if (round == kWarmUp) before = residentMebibytes();
  }
  const double growth = residentMebibytes() - before;
  std::printf("%d rounds: memory grew by %.2f MiB from round %d on\n", kRounds, growth, kWarmUp);
  const auto atLast = livingObjects();
  for (size_t kind = 0; kind < kObjectKinds.size(); ++kind) {
    if (atLast[kind] == atFirst[kind]) continue;
    std::printf("%d %s were left on the device\n", atLast[kind] - atFirst[kind], kObjectKinds[kind].name);
    return 1;
  }
  return growth > kMostGrowth ? 1 : 0;
}

}  // namespace
}  // namespace fragtrace

int main(int argc, char** argv) { return fragtrace::run({argv + 1, size_t(argc - 1)}); }
