// SPDX-License-Identifier: MIT
#include "gl/driver_choice.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

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

}  // namespace fragtrace
