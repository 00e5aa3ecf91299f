// SPDX-License-Identifier: MIT
#include "gl/schedule.h"

#include "shader/layout.h"

namespace fragtrace {

namespace {

/// An image unit of a scene buffer that the variant does not read; -1: there is none.
int freeImageUnit(const ShaderVariant& variant) {
  if (variant.reads != BufferReads::Image) return -1;
  const auto unit = [](uint32_t binding) { return int(layout::kSceneImageBase + binding); };
  if (!has(variant.traits, Trait::VertexColors)) return unit(layout::kColorsBinding);
  if (!has(variant.traits, Trait::Tangents)) return unit(layout::kTangentsBinding);
  if (!has(variant.traits, Trait::PunctualLights)) return unit(layout::kLightsBinding);
  return -1;
}

/// On llvmpipe the wavefront takes 0.2 to 0.35 s longer to compile and saves 0.1 to 1.4 us of a processor a
/// path: that is even at a quarter of a million paths in the room with the ball, at two million in Suzanne.
constexpr double kFewPaths = 1e6;

/// Why the megakernel draws; empty when the wavefront does.
std::string whyMegakernel(const ShaderVariant& variant, const RenderOptions& options, bool software,
                          double paths) {
  if (options.schedule == Schedule::Megakernel) return "--schedule";
  if (variant.traversal != TraversalMethod::FrontToBack) return "the tree is not walked front to back";
  if (!has(variant.stages, Stage::Gi)) return "a stage before global illumination";
  if (variant.feature != Feature::None) return "a layer of first hits";
  if (options.dispatch == Dispatch::Fragment) return "--dispatch fragment";
  if (options.schedule == Schedule::Wavefront) return "";
  if (!software) return "a GPU: not measured";
  return paths < kFewPaths ? "few paths" : "";
}

}  // namespace

std::string chooseSchedule(ShaderVariant& variant, const RenderOptions& options, bool software,
                           double paths) {
  std::string why = whyMegakernel(variant, options, software, paths);
  variant.wavefront = why.empty();
  if (variant.wavefront) {
    variant.dispatch = Dispatch::Compute;
    variant.waveUnit = freeImageUnit(variant);
  }
  return why;
}

}  // namespace fragtrace
