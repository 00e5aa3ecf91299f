// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/rows.h"

#include <array>
#include <cmath>
#include <limits>

#include "base/errors.h"
#include "tests/instruments/rays/hit_check.h"
#include "tests/instruments/rays/ray_caster.h"
#include "tests/instruments/rays/ray_sets.h"
#include "tests/instruments/stress/likeness.h"
#include "tests/instruments/stress/random_sketch.h"
#include "tests/instruments/stress/tree_shapes.h"

namespace fragtrace {

namespace {

/// One colour a surface, without light: a pixel tells what its rays hit.
RenderOptions flatOptions(const StressSetting& setting, glm::ivec2 size, int spp) {
  RenderOptions options;
  options.stages = stagesUpTo(Stage::Flat);
  options.device.traversal = TraversalMethod::FrontToBack;
  options.camera.resolution = size;
  options.sampling.spp = spp;
  options.device.shaderFolder = setting.shaderFolder;
  return options;
}

/// Returns the first seed of a row of `scenes` scenes. Every kind of scene is among kSketchKinds that follow
/// on one another.
uint32_t firstSeed(const StressSetting& setting, Form form, uint32_t scenes) {
  return 1000 * (uint32_t(form) + 1) + setting.seed * scenes;
}

}  // namespace

StressOutcome drawForms(const StressSetting& setting, Form form) {
  const uint32_t scenes = setting.quick ? kSketchKinds : 84;
  StressOutcome outcome;
  const uint32_t first = firstSeed(setting, form, scenes);
  for (uint32_t seed = first; seed < first + scenes; ++seed) {
    const Likeness likeness = likenessOf(setting.context, seed, form, setting.schedule, setting.goOn);
    ++outcome.cases;
    if (likeness.wrong.empty()) continue;
    ++outcome.failures;
    outcome.worst = likenessLine(likeness);
  }
  return outcome;
}

StressOutcome hitForms(const StressSetting& setting, Form form) {
  const uint32_t scenes = setting.quick ? kSketchKinds : 84;
  StressOutcome outcome;
  size_t most = 0;
  const uint32_t first = firstSeed(setting, form, scenes);
  for (uint32_t seed = first; seed < first + scenes; ++seed) {
    const Likeness likeness = hitsOf(setting.context, seed, form, setting.goOn);
    outcome.cases += likeness.pixels;
    outcome.failures += likeness.otherHits;
    if (likeness.otherHits <= most) continue;
    most = likeness.otherHits;
    outcome.worst = likenessLine(likeness);
  }
  return outcome;
}

StressOutcome drawIdentical(const StressSetting& setting) {
  const RenderOptions options = flatOptions(setting, {8, 6}, 64);
  const auto drawn = [&](size_t count) {
    return SceneDrawing(setting.context, identicalTriangles(count), options).picture(setting.goOn);
  };
  const FilmPixels many = drawn(setting.quick ? 20000 : 1000000);
  const FilmPixels one = drawn(1);
  StressOutcome outcome;
  for (size_t i = 0; i < many.pixels.size(); ++i) {
    const FilmPixel& p = many.pixels[i];
    ++outcome.cases;
    outcome.failures += p.sum != one.pixels[i].sum || p.samples != one.pixels[i].samples || p.flags != 0;
  }
  return outcome;
}

StressOutcome castAtShrinking(const StressSetting& setting) {
  const glm::ivec2 size = setting.quick ? glm::ivec2(128) : glm::ivec2(1024);
  const Scene scene = shrinkingTriangles(setting.quick ? 20000 : 50000);
  const Bvh bvh = buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size()));
  const RenderOptions options = flatOptions(setting, size, 1);
  ShaderVariant variant = chooseVariant(options, traitsOf(scene, Surroundings::None), Surroundings::None,
                                        bvh.stackNeed, BufferReads::Auto);
  GpuScene packed = packScene(scene, bvh, {}, variant);
  variant.reads = chooseReads(BufferReads::Auto, setting.context.software, packed, readLimits()).reads;
  RayCaster caster(setting.context, std::move(packed), variant, size, setting.shaderFolder);
  const std::vector<Ray> rays = primaryRays(frameScene(scene.bounds), scene.space, size);
  caster.trace(RayCaster::RaySet(rays), false);
  setting.goOn();
  const std::vector<FoundHit> found = foundBy(caster, bvh);
  const ExactTracer tracer(scene, bvh);
  proveTree(tracer, scene.triangles.size(), rays);
  StressOutcome outcome;
  outcome.cases = rays.size();
  outcome.failures = countWrongNearest(rays, found, tracer.nearest(rays), glm::length(scene.bounds.extent()));
  return outcome;
}

StressOutcome drawNoNumbers(const StressSetting& setting) {
  const uint32_t scenes = setting.quick ? 16 : 400;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr std::array kBad{std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity,
                            std::numeric_limits<float>::max()};
  RenderOptions options;
  options.sampling.spp = 2;
  options.camera.resolution = glm::ivec2(16);
  options.device.traversal = TraversalMethod::FrontToBack;
  options.device.shaderFolder = setting.shaderFolder;
  StressOutcome outcome;
  for (uint32_t seed = setting.seed * scenes; seed < (setting.seed + 1) * scenes; ++seed) {
    Dice dice(seed);
    SceneSketch sketch = randomSketch(seed);
    SketchMesh& mesh = sketch.meshes[dice.below(sketch.meshes.size())];
    std::vector<glm::vec3>& attribute = mesh.normals.empty() || dice.coin() ? mesh.positions : mesh.normals;
    attribute[dice.below(attribute.size())][int(dice.below(3))] = kBad[dice.below(kBad.size())];
    ++outcome.cases;
    try {
      const FilmPixels film = SceneDrawing(setting.context, sceneOf(sketch), options).picture(setting.goOn);
      if (totalsOf(film).nonfinitePixels == 0) continue;
    } catch (const InputError&) {
      continue;
    }
    ++outcome.failures;
    outcome.worst = "seed " + std::to_string(seed);
  }
  return outcome;
}

StressOutcome addThirds(const StressSetting& setting) {
  RenderOptions options = flatOptions(setting, {2, 2}, setting.quick ? 1 << 20 : 1 << 24);
  options.light.backgroundColor = glm::vec3(1.0f / 3.0f);
  const FilmPixels film =
      SceneDrawing(setting.context, sceneWithoutTriangles(), options).picture(setting.goOn);
  StressOutcome outcome;
  for (const FilmPixel& p : film.pixels) {
    for (int c = 0; c < 3; ++c) {
      ++outcome.cases;
      outcome.failures +=
          !(std::abs(p.mean()[c] - 1.0 / 3.0) <= 1e-6) || p.samples != uint32_t(options.sampling.spp);
    }
  }
  return outcome;
}

}  // namespace fragtrace
