// SPDX-License-Identifier: MIT
#include "gl/driver_choice.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "base/parallel.h"
#include "shader/layout.h"

namespace fragtrace {

namespace {

bool isOfDataCentre(const Context& context) {
  static constexpr std::array<std::string_view, 9> kDataCentre{"A100", "A800", "H100",  "H800", "H200",
                                                               "H20",  "B200", "GH200", "GB200"};
  return std::ranges::any_of(
      kDataCentre, [&](std::string_view name) { return context.renderer.find(name) != std::string::npos; });
}

}  // namespace

Dispatch chooseDispatch(Dispatch wanted, const Context& context, bool literals) {
  if (wanted != Dispatch::Auto) return wanted;
  if (context.software) return literals ? Dispatch::Compute : Dispatch::Fragment;
  return isOfDataCentre(context) ? Dispatch::Compute : Dispatch::Fragment;
}

std::string whyDispatch(Dispatch wanted, const Context& context, const ShaderVariant& drawn) {
  if (wanted != Dispatch::Auto) return "--dispatch";
  if (drawn.wavefront) return "the wavefront needs it";
  if (context.software) return "measured to be the faster one on software";
  return isOfDataCentre(context) ? "measured to be the faster one on an H200"
                                 : "neither is measured on GPUs of this kind";
}

bool mayHaveGpu() {
  std::error_code error;
  // The first belongs to Linux's own drivers, the second to NVIDIA's, and the third to a Windows that runs
  // Linux.
  return std::ranges::any_of(std::array{"/dev/dri", "/dev/nvidiactl", "/dev/dxg"},
                             [&](const char* path) { return std::filesystem::exists(path, error); });
}

bool isForGpu(Tune wanted, const Context& context) {
  return wanted == Tune::Auto ? !context.software : wanted == Tune::Gpu;
}

bool keepsCompiled(const Context& context) {
  if (!context.software) return true;
  // The texts that Mesa takes for a yes.
  static constexpr std::array<std::string_view, 4> kYes{"1", "true", "y", "yes"};
  return std::ranges::none_of(
      std::array{"MESA_SHADER_CACHE_DISABLE", "MESA_GLSL_CACHE_DISABLE"}, [](const char* name) {
        const char* value = std::getenv(name);
        return value && std::ranges::find(kYes, std::string_view(value)) != kYes.end();
      });
}

void setVectorWidth(VectorWidth width) {
  if (width == VectorWidth::Auto) return;
  ::setenv("LP_NATIVE_VECTOR_WIDTH", std::string(kVectorWidthNames[size_t(width)]).c_str(), 1);
}

void limitDriverThreads() {
  const uint32_t count = processorCount();
  if (count < std::thread::hardware_concurrency())
    ::setenv("LP_NUM_THREADS", std::to_string(count).c_str(), 0);
}

int vectorWidthOf(const std::string& renderer) {
  const size_t end = renderer.find(" bits)");
  const size_t begin = end == std::string::npos ? end : renderer.rfind(' ', end - 1);
  return begin == std::string::npos ? 0 : std::atoi(renderer.c_str() + begin);
}

bool preferQuickCompilation(double paths) {
  // Measured: 0.1 to 1.4 s were saved, and a path took 0.2 to 1.2 us longer.
  constexpr double kMostPaths = 262144.0;
  constexpr const char* kMesaSetting = "GALLIVM_PERF";
  if (paths > kMostPaths || std::getenv(kMesaSetting) != nullptr) return false;
  return ::setenv(kMesaSetting, "nopt", 0) == 0;
}

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

/// On llvmpipe the wavefront takes 0.3 to 1.3 s longer to compile. It gains where paths are long in a large
/// tree (docs/measurements/traversal.md), so that it is even after a quarter of a million paths in the room
/// with the ball.
constexpr double kFewPaths = 2e6;
/// Rays of so few steps hardly wait for each other: many-lights, of 274 nodes, takes equally long with both.
constexpr size_t kSmallTree = 512;
/// Paths in solids that scatter are long, and end at very different lengths: the wavefront takes 0.4 (a dense
/// cloud) to 0.9 (milk in glass) of the time, however small the tree is. Solids of glass take 0.65 to 0.9 in
/// large trees, and do not compile for longer.
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
  if (!work.software) return "a GPU, where the megakernel is faster";
  const bool longPaths = has(variant.traits, Trait::Scattering);
  if (!longPaths && work.nodes < kSmallTree) return "a small tree";
  // Alpha and solids of glass make rays of very different lengths, also where lamps or surroundings end them.
  const bool thin = has(variant.traits, Trait::ThinGlass);
  const bool uneven = longPaths || (has(variant.traits, Trait::Alpha) && !thin);
  const bool glass = has(variant.traits, Trait::Transmission) && !thin;
  if (!uneven && has(variant.traits, Trait::LightTree)) return "lamps are chosen by a tree";
  if (!uneven && !glass && has(variant.traits, Trait::Environment)) return "paths end in the surroundings";
  return work.paths < (longPaths || glass ? kFewLongPaths : kFewPaths) ? "few paths" : "";
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
