// SPDX-License-Identifier: MIT
// `fragtrace bench traversal`: rays per second of each kind, nothing shaded.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include "base/errors.h"
#include "base/summary.h"
#include "bench/command/commands.h"
#include "bench/command/configurations.h"
#include "bench/command/results.h"
#include "bench/report/traversal_report.h"
#include "gl/driver_choice.h"
#include "image/files/whole_file.h"
#include "options/library/option_facts.h"
#include "options/numbers.h"
#include "pack/literals.h"
#include "session/say.h"
#include "session/setup.h"
#include "tests/instruments/rays/hit_check.h"
#include "tests/instruments/rays/plain_scene.h"
#include "tests/instruments/rays/ray_caster.h"
#include "tests/instruments/rays/ray_sets.h"

namespace fragtrace {

namespace {

/// The options as parsed, and values that follow from them.
struct TraversalOptions {
  RawRender raw;
  RenderOptions render;  ///< scene, camera, traversal, device
  int rounds = 7;
  bool plain = false;          ///< the plain tracer takes the rays, too
  std::filesystem::path rays;  ///< triangles and rays for another tracer
  ResultFiles files;
};

void declareTraversal(CLI::App& app, TraversalOptions& o) {
  addOption(app, "file", o.raw)->required();
  addOption(app, "--resolution", o.raw, "WIDTH,HEIGHT of the grid of primary rays, one ray per pixel")
      ->check(wholeNumber(1, 4096));
  o.raw.options.camera.resolution = glm::ivec2(1024, 1024);
  app.add_option("--rounds", o.rounds, "rounds of timing")
      ->check(wholeNumber(1, 10000))
      ->capture_default_str();
  app.add_flag("--plain", o.plain,
               "also trace the rays by a plain compute shader: a binary tree of boxes in floats, to compare "
               "with on the same device");
  addOption(app, "--traversal", o.raw, "traversal to measure: auto, bvh, front-to-back")
      ->check(withChoices(std::array{"auto", "bvh", "front-to-back"}));
  addOption(app, "--camera-index", o.raw, "index of the camera of the primary rays, from 0");
  addOption(app, "--camera", o.raw, "name or index of the camera of the primary rays");
  addOption(app, "--seed", o.raw, "seed of the diffuse and shadow rays");
  addJsonOption(app, o.files, "write all measurements to this file, one JSON line per kind of ray");
  app.add_option("--rays", o.rays, "write triangles and rays to this file, for another tracer (bench/peers)")
      ->type_name("FILE");
  addOption(app, "--dispatch", o.raw);
  addOption(app, "--tune", o.raw);
  addDeviceOptions(app, o.raw);
}

/// Throws UsageError.
void settleTraversal(const CLI::App&, TraversalOptions& o) {
  o.raw.stage = "flat";
  o.raw.noDefaultLight = true;
  o.raw.options.device.instancing = Instancing::Flatten;
  o.render = finishRender(o.raw);
  if (o.render.device.traversal == TraversalMethod::Iterative)
    throw UsageError("--traversal: 'iterative' takes more than one draw; `bench frame` measures it");
  if (o.render.device.traversal == TraversalMethod::Literals)
    throw UsageError("--traversal: 'literals' has no tree; 'bench traversal' measures trees");
}

void checkFiles(const TraversalOptions& options, const std::vector<std::filesystem::path>& inputs) {
  checkOutputs(std::vector<NamedOutput>{{"--json", options.files.json}, {"--rays", options.rays}}, inputs);
}

struct MeasuredSet {
  RayKind kind;
  std::vector<Ray> rays;
  std::vector<FoundHit> found;
  size_t count = 0;             ///< number of valid rays
  std::vector<double> ms;       ///< one per round
  size_t wrong = 0;             ///< rays whose hit is not that of double precision
  std::vector<double> plainMs;  ///< the same by the plain tracer
  size_t plainWrong = 0;
  size_t provedByAll =
      0;  ///< rays on which double precision by the tree is itself held against all primitives

  std::string name() const { return std::string(kRayKindNames[size_t(kind)]); }
  bool anyHit() const { return kind == RayKind::Shadow; }
};

std::vector<MeasuredSet> makeSets(const LoadedScene& loaded, const ExactTracer& tracer, uint32_t seed) {
  std::vector<MeasuredSet> sets(3);
  const std::vector<Ray> primary = primaryRays(loaded.camera, loaded.scene.space, loaded.size);
  const std::vector<ExactHit> hits = tracer.nearest(primary);
  sets[1].rays = diffuseRays(tracer, primary, hits, seed);
  sets[2].rays = shadowRays(tracer, loaded.scene, primary, hits, seed + 1);
  sets[0].rays = primary;
  for (size_t i = 0; i < sets.size(); ++i) {
    sets[i].kind = RayKind(i);
    sets[i].count = countRays(sets[i].rays);
  }
  return sets;
}

/// Returns how many rays have found something else than in double precision. Throws RenderError where these
/// are too many.
size_t wrongOf(const MeasuredSet& set, std::span<const FoundHit> found, std::span<const ExactHit> exact,
               const Scene& scene) {
  const double size = glm::length(scene.bounds.extent()) / scene.space.unit;
  const size_t wrong =
      set.anyHit() ? countWrongAny(set.rays, found, exact) : countWrongNearest(set.rays, found, exact, size);
  if (wrong > wrongRaysAllowed(set.count)) {
    throw RenderError(std::to_string(wrong) + " of " + std::to_string(set.count) + " " + set.name() +
                      " rays hit something else than in double precision");
  }
  return wrong;
}

/// The line that is written of a kind of rays, behind what all have in common.
Json lineOf(Json line, const MeasuredSet& set) {
  line["kind"] = set.name();
  line["rays"] = set.count;
  line["hits"] =
      std::ranges::count_if(set.found, [](const FoundHit& h) { return h.primitive != kMissIndex; });
  line["ms"] = set.ms;
  line["median_ms"] = summarize(set.ms).median;
  line["mrays_per_s"] = megaRaysPerSecond(set.count, set.ms);
  line["wrong"] = set.wrong;
  line["wrong_allowed"] = wrongRaysAllowed(set.count);
  line["proved_by_all"] = set.provedByAll;
  if (set.plainMs.empty()) return line;
  line["plain_ms"] = set.plainMs;
  line["plain_median_ms"] = summarize(set.plainMs).median;
  line["plain_wrong"] = set.plainWrong;
  return line;
}

/// Little-endian: "FTRAYS1", 0; numbers of triangles and of rays a set, 32 bits each; nine floats per
/// triangle; for each kind origin, limit, direction and the distance found (for shadow rays 0; -1: nothing)
/// of each ray.
void writeRays(const std::filesystem::path& path, const Scene& scene, const std::vector<MeasuredSet>& sets) {
  std::vector<uint8_t> bytes{'F', 'T', 'R', 'A', 'Y', 'S', '1', 0};
  const auto append = [&](const auto& value) {
    const size_t at = bytes.size();
    bytes.resize(at + sizeof value);
    std::memcpy(bytes.data() + at, &value, sizeof value);
  };
  append(uint32_t(scene.triangles.size()));
  append(uint32_t(sets.front().rays.size()));
  for (const Triangle& t : scene.triangles) append(cornersOf(scene, t));
  for (const MeasuredSet& set : sets) {
    for (size_t i = 0; i < set.rays.size(); ++i) {
      const bool hit = set.found[i].primitive != kMissIndex;
      append(glm::vec4(set.rays[i].origin, set.rays[i].limit));
      append(glm::vec4(set.rays[i].direction, !hit ? -1.0f : (set.anyHit() ? 0.0f : set.found[i].t)));
    }
  }
  replaceFile(path, bytes);
}

/// Chooses compute on GPUs: only a part of a data-centre GPU rasterises.
Dispatch dispatchOf(const DeviceOptions& device, const Context& context) {
  if (device.dispatch != Dispatch::Auto) return device.dispatch;
  return context.software ? Dispatch::Fragment : Dispatch::Compute;
}

/// The plain tracer with a tree of its own, without triangles next to it.
struct PlainTracer {
  Bvh bvh;
  RayCaster caster;

  PlainTracer(const Context& context, const LoadedScene& loaded, ShaderVariant variant,
              const std::filesystem::path& shaderFolder)
      : bvh(buildBvh(primitiveBounds(loaded.scene), uint32_t(loaded.scene.triangles.size()))),
        caster(context, plainScene(loaded.scene, bvh), inCompute(std::move(variant)), loaded.size,
               shaderFolder, "plain") {}

  static ShaderVariant inCompute(ShaderVariant variant) {
    variant.dispatch = Dispatch::Compute;
    return variant;
  }
};

/// Warms up, which is where the driver compiles, and checks what is found.
std::vector<RayCaster::RaySet> uploadAndCheck(std::vector<MeasuredSet>& sets, RayCaster& caster,
                                              PlainTracer* plain, const LoadedScene& loaded,
                                              const ExactTracer& tracer) {
  const Scene& scene = loaded.scene;
  std::vector<RayCaster::RaySet> uploaded;
  for (MeasuredSet& set : sets) {
    uploaded.emplace_back(set.rays);
    caster.trace(uploaded.back(), set.anyHit());
    set.found = foundBy(caster, loaded.bvh);
    const std::vector<ExactHit> exact = tracer.nearest(set.rays);
    set.wrong = wrongOf(set, set.found, exact, scene);
    set.provedByAll = proveTree(tracer, scene.triangles.size() + scene.spheres.size(), set.rays);
    if (plain == nullptr) continue;
    plain->caster.trace(uploaded.back(), set.anyHit());
    set.plainWrong = wrongOf(set, foundBy(plain->caster, plain->bvh), exact, scene);
  }
  return uploaded;
}

std::vector<Json> measure(const TraversalOptions& options, const Context& context) {
  Statistics stats;
  LoadedScene loaded = loadScene(options.render, stats);
  checkFiles(options, inputsOf(loaded.scene));
  const Scene& scene = loaded.scene;
  if (!options.rays.empty() && !scene.spheres.empty())
    throw InputError(options.render.scene.string() + ": has spheres, which --rays does not write");
  if (options.plain && !scene.spheres.empty())
    throw InputError(options.render.scene.string() + ": has spheres, which --plain does not trace");
  ShaderVariant variant = chooseVariant(options.render, traitsOf(scene, Surroundings::None),
                                        Surroundings::None, loaded.bvh.stackNeed, BufferReads::Auto);
  if (loaded.bvh.besideTree > 0) variant.literals = largeFirst(scene, loaded.bvh, variant);
  GpuScene packed = packScene(scene, loaded.bvh, {}, variant);
  variant.dispatch = dispatchOf(options.render.device, context);
  variant.gpu = isForGpu(options.render.device.tune, context);
  variant.reads =
      chooseReads(options.render.device.bufferReads, context.software, packed, readLimits()).reads;

  const auto triangles = double(scene.triangles.size());
  const double bytesPerTriangle = triangles > 0.0 ? double(packed.geometryBytes()) / triangles : 0.0;
  RayCaster caster(context, std::move(packed), variant, loaded.size, options.render.device.shaderFolder);

  std::optional<PlainTracer> plain;
  if (options.plain) plain.emplace(context, loaded, variant, options.render.device.shaderFolder);

  const ExactTracer tracer(scene, loaded.bvh);
  std::vector<MeasuredSet> sets = makeSets(loaded, tracer, options.render.sampling.seed);
  const std::vector<RayCaster::RaySet> uploaded =
      uploadAndCheck(sets, caster, plain ? &*plain : nullptr, loaded, tracer);

  // Step: measure in turn.
  ProgressBar bar("measuring", options.render.output.quiet);
  for (int round = 0; round < options.rounds; ++round) {
    for (size_t i = 0; i < sets.size(); ++i) {
      sets[i].ms.push_back(caster.trace(uploaded[i], sets[i].anyHit()));
      if (plain) sets[i].plainMs.push_back(plain->caster.trace(uploaded[i], sets[i].anyHit()));
    }
    bar.show(double(round + 1) / options.rounds);
  }
  bar.clear();
  if (!options.rays.empty()) writeRays(options.rays, scene, sets);
  const Json head = {{"schema", 1},
                     {"bench", "traversal"},
                     {"scene", options.render.scene.filename().string()},
                     {"triangles", scene.triangles.size()},
                     {"spheres", scene.spheres.size()},
                     {"width", loaded.size.x},
                     {"height", loaded.size.y},
                     {"gl_renderer", context.renderer},
                     {"variant", variantName(variant)},
                     {"clock", caster.clockName()},
                     {"sah_cost", stats.bvh.sahCost},
                     {"gpu_bytes_per_triangle", bytesPerTriangle}};
  std::vector<Json> lines;
  lines.reserve(sets.size());
  for (const MeasuredSet& set : sets) lines.push_back(lineOf(head, set));
  return lines;
}

int runTraversal(const TraversalOptions& options) {
  checkFiles(options, inputsOf(options.render));
  const auto context = contextOf(options.render);
  const std::vector<Json> lines = measure(options, *context);
  std::string json;
  for (const Json& line : lines) json += jsonLine(line);
  writeResults(options.files, {traversalTable(lines), json});
  return 0;
}

}  // namespace

RunCommand addBenchTraversal(CLI::App& app) {
  return commandOf(app, declareTraversal, settleTraversal, runTraversal);
}

}  // namespace fragtrace
