// SPDX-License-Identifier: MIT
#include "bench/command/traversal_options.h"

#include <CLI/CLI.hpp>

#include "errors.h"
#include "options/device_options.h"
#include "options/numbers.h"

namespace fragtrace {

void addBenchTraversalOptions(CLI::App& app, RawBenchTraversal& raw) {
  BenchTraversalOptions& o = raw.options;
  app.add_option("file", raw.render.scene, "scene: a .gltf or .glb file")->type_name("FILE")->required();
  app.add_option("--resolution", raw.render.camera.resolution,
                 "WIDTH,HEIGHT of the grid of primary rays, one ray per pixel")
      ->delimiter(',')
      ->expected(2)
      ->check(wholeNumber(1, 4096));
  raw.render.camera.resolution = {1024, 1024};
  app.add_option("--rounds", o.rounds, "rounds of timing")
      ->check(wholeNumber(1, 10000))
      ->capture_default_str();
  app.add_option("--traversal", raw.render.traversal, "traversal to measure: auto, bvh, front-to-back")
      ->capture_default_str();
  CLI::Option* index = app.add_option("--camera-index", raw.render.camera.index,
                                      "index of the camera of the primary rays, from 0");
  app.add_option("--camera", raw.render.camera.name, "name or index of the camera of the primary rays")
      ->excludes(index);
  app.add_option("--seed", raw.render.options.sampling.seed, "seed of the diffuse and shadow rays")
      ->capture_default_str();
  app.add_option("--json", o.json, "write all measurements to this file, one JSON line per kind of ray")
      ->type_name("FILE");
  app.add_option("--rays", o.rays, "write triangles and rays to this file, for another tracer (bench/peers)")
      ->type_name("FILE");
  addDeviceOptions(app, raw.render);
}

BenchTraversalOptions finishBenchTraversal(const RawBenchTraversal& raw) {
  BenchTraversalOptions options = raw.options;
  RawRender render = raw.render;
  render.stage = "flat";
  render.noDefaultLight = true;
  render.instancing = "flatten";
  options.render = finishRender(render);
  if (options.render.device.traversal == TraversalMethod::Iterative)
    throw UsageError("--traversal: 'iterative' takes more than one draw; `bench scale` measures it");
  if (options.render.device.traversal == TraversalMethod::Literals)
    throw UsageError("--traversal: 'literals' has no tree; 'bench traversal' measures trees");
  return options;
}

}  // namespace fragtrace
