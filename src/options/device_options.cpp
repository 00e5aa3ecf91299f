// SPDX-License-Identifier: MIT
#include "options/device_options.h"

#include <CLI/CLI.hpp>

#include "options/choose.h"
#include "options/parse_render.h"

namespace fragtrace {

void addTracingOptions(CLI::App& app, RawRender& raw) {
  app.add_option("--traversal", raw.traversal, "how rays find triangles: " + joined(kTraversalNames))
      ->capture_default_str();
  app.add_option("--instancing", raw.instancing,
                 "whether copies of a mesh share its triangles: " + joined(kInstancingNames))
      ->capture_default_str();
  app.add_option("--rendering-backend", raw.backend,
                 "how the OpenGL context is created: " + joined(kBackendNames))
      ->capture_default_str();
  app.add_option("--buffer-reads", raw.reads, "how the shader reads the scene: " + joined(kBufferReadsNames))
      ->capture_default_str();
  app.add_option("--dispatch", raw.dispatch, "which shader stage runs the tracer: " + joined(kDispatchNames))
      ->capture_default_str();
  app.add_option(
         "--vector-width", raw.vectorWidth,
         "bits of the vectors that Mesa's software driver computes with; the picture is the same; 512 can be "
         "faster where the processor has AVX-512, but Mesa crashes on some scenes with it: " +
             joined(kVectorWidthNames))
      ->capture_default_str();
  app.add_option("--schedule", raw.schedule,
                 "how paths are scheduled: each lane of the device traces one pixel at a time (megakernel), "
                 "or the rays of many pixels are traced together (wavefront): " +
                     joined(kScheduleNames))
      ->capture_default_str();
}

void addDeviceOptions(CLI::App& app, RawRender& raw) {
  CLI::App render;
  RawRender unused;
  addRenderOptions(render, unused);
  const auto described = [&](const char* name) { return render.get_option(name)->get_description(); };
  app.add_option("--rendering-backend", raw.backend, described("--rendering-backend"))->capture_default_str();
  app.add_option("--buffer-reads", raw.reads, described("--buffer-reads"))->capture_default_str();
  app.add_option("--vector-width", raw.vectorWidth, described("--vector-width"))->capture_default_str();
  app.add_option("--shader-folder", raw.shaderFolder, described("--shader-folder"))->type_name("FOLDER");
  app.add_flag("--quiet", raw.options.output.quiet, described("--quiet"));
}

}  // namespace fragtrace
