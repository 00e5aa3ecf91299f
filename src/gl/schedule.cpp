// SPDX-License-Identifier: MIT
#include "gl/schedule.h"

#include "shader/layout.h"

namespace fragtrace {

namespace {

/// An image unit of a scene buffer that the variant does not read; -1 if there is none.
int freeImageUnit(const ShaderVariant& variant) {
  if (variant.reads != BufferReads::Image) return -1;
  const auto unit = [](uint32_t binding) { return int(layout::kSceneImageBase + binding); };
  if (!has(variant.traits, Trait::VertexColors)) return unit(layout::kColorsBinding);
  if (!has(variant.traits, Trait::Tangents)) return unit(layout::kTangentsBinding);
  if (!has(variant.traits, Trait::PunctualLights)) return unit(layout::kLightsBinding);
  return -1;
}

/// On llvmpipe the wavefront takes 0.25 to 0.45 s longer to compile, and saves 0.1 to 1.4 us of processor
/// time per path. That is even at a quarter of a million paths in the room with the ball, and at two million
/// in Suzanne.
constexpr double kFewPaths = 2e6;
/// Rays of so few steps hardly wait for each other: many-lights, of 274 nodes, takes equally long with both.
constexpr size_t kSmallTree = 512;
/// Paths in solids that scatter are long, and end at very different lengths: the wavefront takes 0.4 (a dense
/// cloud) to 0.9 (milk in glass) of the time, however small the tree is.
constexpr double kFewLongPaths = 2e5;

/// The reason why the megakernel draws; empty if the wavefront does.
std::string whyMegakernel(const ShaderVariant& variant, const RenderOptions& options,
                          const ScheduleWork& work) {
  if (options.device.schedule == Schedule::Megakernel) return "--schedule";
  if (variant.aov != Aov::None) return "a layer";
  if (variant.countsVisits) return "the heat map";
  if (!has(variant.stages, Stage::Gi)) return "a stage before global illumination";
  if (variant.shadowCatcher) return "--shadow-catcher";
  if (variant.transparentGlass) return "--transparent-glass";
  if (variant.traversal == TraversalMethod::Literals) return "the scene is shader text";
  if (variant.traversal != TraversalMethod::FrontToBack) return "the tree is not walked front to back";
  if (has(variant.traits, Trait::MovingSurfaces)) return "surfaces move: its rays have no time";
  if (options.device.dispatch == Dispatch::Fragment) return "--dispatch fragment";
  if (options.device.schedule == Schedule::Wavefront) return "";
  if (!work.software) return "a GPU: the wavefront has too few lanes for it";
  const bool longPaths = has(variant.traits, Trait::Scattering);
  if (!longPaths && work.nodes < kSmallTree) return "a small tree";
  return work.paths < (longPaths ? kFewLongPaths : kFewPaths) ? "few paths" : "";
}

}  // namespace

std::string chooseSchedule(ShaderVariant& variant, const RenderOptions& options, const ScheduleWork& work) {
  std::string why = whyMegakernel(variant, options, work);
  variant.wavefront = why.empty();
  if (variant.wavefront) {
    variant.dispatch = Dispatch::Compute;
    variant.waveUnit = freeImageUnit(variant);
  }
  return why;
}

}  // namespace fragtrace
