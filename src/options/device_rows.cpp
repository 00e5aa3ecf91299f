// SPDX-License-Identifier: MIT
#include "options/option_row.h"
#include "options/row_makers.h"

namespace fragtrace {

std::vector<OptionRow> deviceRows() {
  constexpr OptionTraits kLoading{.effect = Effect::Method, .renewal = Renewal::Scene};
  constexpr OptionTraits kProgram{.effect = Effect::Method, .renewal = Renewal::Program};
  return {
      choice("--traversal", "how rays find triangles", FRAGTRACE_MEMBER(device.traversal), kTraversalNames,
             kLoading),
      choice("--instancing", "whether copies of a mesh share its triangles",
             FRAGTRACE_MEMBER(device.instancing), kInstancingNames, kLoading),
      choice("--rendering-backend", "how the OpenGL context is created", FRAGTRACE_MEMBER(device.backend),
             kBackendNames, {.effect = Effect::Method, .renewal = Renewal::Program, .kept = true}),
      choice("--buffer-reads", "how the shader reads the scene", FRAGTRACE_MEMBER(device.bufferReads),
             kBufferReadsNames, kProgram),
      choice("--texture-reads", "how the shader reads textures: as words of buffers, or from array textures",
             FRAGTRACE_MEMBER(device.textureReads), kTextureReadsNames, kLoading),
      choice("--dispatch", "which shader stage runs the tracer", FRAGTRACE_MEMBER(device.dispatch),
             kDispatchNames, kProgram),
      choice("--tune", "which kind of driver the shaders' text suits; the picture is the same",
             FRAGTRACE_MEMBER(device.tune), kTuneNames, kProgram),
      choice("--vector-width",
             "bits of the vectors that Mesa's software driver computes with; the picture is the same; 512 "
             "can be faster where the processor has AVX-512, but Mesa crashes on some scenes with it",
             FRAGTRACE_MEMBER(device.vectorWidth), kVectorWidthNames, {.effect = Effect::Method}),
      choice(
          "--schedule",
          "how paths are scheduled: each lane of the device traces one pixel at a time (megakernel), or the "
          "rays of many pixels are traced together (wavefront)",
          FRAGTRACE_MEMBER(device.schedule), kScheduleNames, kProgram),
      word("--shader-folder", "read the shaders from this folder instead of the built-in ones",
           FRAGTRACE_MEMBER(device.shaderFolder),
           {.effect = Effect::Method, .renewal = Renewal::Program, .kept = true}, "FOLDER"),
  };
}

}  // namespace fragtrace
