// SPDX-License-Identifier: MIT
#include "bench/stress/scene_drawing.h"

#include <unistd.h>

#include <fstream>

#include "errors.h"
#include "gl/schedule.h"
#include "gltf/gltf.h"
#include "pack/pack_tree.h"

namespace fragtrace {

namespace {

/// A file that goes with the scope.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text) {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("fragtrace-" + std::to_string(::getpid()) + "-" + std::to_string(count++) + ".gltf");
    std::ofstream file(path_, std::ios::binary);
    if (!(file << text).flush()) throw RenderError("cannot write " + path_.string());
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

Scene sceneOf(const SceneSketch& sketch) { return loadGltf(TemporaryFile(gltfText(sketch)).path()); }

Environment environmentOf(const SceneSketch& sketch) {
  return sketch.sky.width > 0 ? Environment{Surroundings::Map, sketch.sky} : Environment{};
}

SceneDrawing::SceneDrawing(const Context& context, const Scene& scene, const RenderOptions& options,
                           const Environment& environment, double environmentTurn)
    : options_(options) {
  const TraitSet present = traitsOf(scene, environment.kind);
  const bool iterative = options.device.traversal == TraversalMethod::Iterative;
  const Bvh bvh =
      iterative ? listLeaves(scene) : buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size()));
  picture_ = chooseVariant(options, present, environment.kind, bvh.depth, options.device.bufferReads);
  depth_ = chooseFeatureVariant(options, present, environment.kind, bvh.depth, options.device.bufferReads,
                                Feature::Depth);
  ShaderVariant everything = picture_;
  everything.traits |= depth_.traits;
  GpuScene packed = packScene(scene, bvh, environment, everything);
  picture_.reads = chooseReads(options.device.bufferReads, context.software, packed, readLimits()).reads;
  depth_.reads = picture_.reads;
  chooseSchedule(picture_, options, {});
  renderer_ =
      std::make_unique<Renderer>(context, std::move(packed), picture_.reads, options.device.shaderFolder);
  view_.camera = scene.cameras.empty() ? frameScene(scene.bounds) : scene.cameras.front();
  view_.space = scene.space;
  view_.background = options.light.backgroundColor.value_or(glm::vec3(0.0f));
  view_.showEnvironment = environment.kind == Surroundings::Map;
  view_.hdriRotation = environmentTurn;
  view_.bounces = options.sampling.bounces;
}

FilmPixels SceneDrawing::draw(const ShaderVariant& variant, int samples, uint32_t seed, const GoOn& goOn) {
  Film film(options_.camera.resolution.value_or(glm::ivec2(64)));
  view_.seed = seed;
  renderer_->compile(variant, film, view_);
  RenderTimes times;
  renderer_->addSamples(film, view_, 0, samples, times, [&](double) {
    goOn();
    return true;
  });
  return film.read();
}

FilmPixels SceneDrawing::picture(const GoOn& goOn) {
  return draw(picture_, options_.sampling.spp, options_.sampling.seed, goOn);
}

FilmPixels SceneDrawing::depth(const GoOn& goOn) { return draw(depth_, 1, 0, goOn); }

}  // namespace fragtrace
