// SPDX-License-Identifier: MIT
#include "gl/driver_choice.h"

#include <algorithm>
#include <array>

namespace fragtrace {

ReadChoice chooseReads(BufferReads wanted, bool software, const GpuScene& scene, const ReadLimits& limits) {
  using enum BufferReads;
  if (wanted != Auto) return {wanted, {}};
  const std::array<BufferReads, 3> order =
      software ? std::array{Image, Texel, Ssbo} : std::array{Ssbo, Texel, Image};
  const std::string reason = whyNotRead(scene, order[0], limits);
  if (reason.empty()) return {order[0], {}};
  for (const BufferReads reads : {order[1], order[2]}) {
    if (whyNotRead(scene, reads, limits).empty()) return {reads, reason};
  }
  return {order[0], {}};
}

Dispatch chooseDispatch(Dispatch wanted, const Context& context) {
  if (wanted != Dispatch::Auto) return wanted;
  static constexpr std::array<std::string_view, 9> kDataCentre{"A100", "A800", "H100",  "H800", "H200",
                                                               "H20",  "B200", "GH200", "GB200"};
  const bool fewRasterisers = std::ranges::any_of(
      kDataCentre, [&](std::string_view name) { return context.renderer.find(name) != std::string::npos; });
  return fewRasterisers && !context.software ? Dispatch::Compute : Dispatch::Fragment;
}

}  // namespace fragtrace
