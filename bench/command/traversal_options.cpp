// SPDX-License-Identifier: MIT
#include "bench/command/traversal_options.h"

#include <CLI/CLI.hpp>

#include "errors.h"
#include "options/numbers.h"

namespace fragtrace {

void addBenchTraversalOptions(CLI::App& app, RawBenchTraversal& raw) {
  BenchTraversalOptions& o = raw.options;
  addOption(app, "file", raw.render)->required();
  addOption(app, "--resolution", raw.render, "WIDTH,HEIGHT of the grid of primary rays, one ray per pixel")
      ->check(wholeNumber(1, 4096));
  raw.render.options.camera.resolution = glm::ivec2(1024, 1024);
  app.add_option("--rounds", o.rounds, "rounds of timing")
      ->check(wholeNumber(1, 10000))
      ->capture_default_str();
  addOption(app, "--traversal", raw.render, "traversal to measure: auto, bvh, front-to-back");
  addOption(app, "--camera-index", raw.render, "index of the camera of the primary rays, from 0");
  addOption(app, "--camera", raw.render, "name or index of the camera of the primary rays");
  addOption(app, "--seed", raw.render, "seed of the diffuse and shadow rays");
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
  render.options.device.instancing = Instancing::Flatten;
  options.render = finishRender(render);
  if (options.render.device.traversal == TraversalMethod::Iterative)
    throw UsageError("--traversal: 'iterative' takes more than one draw; `bench scale` measures it");
  if (options.render.device.traversal == TraversalMethod::Literals)
    throw UsageError("--traversal: 'literals' has no tree; 'bench traversal' measures trees");
  return options;
}

}  // namespace fragtrace
