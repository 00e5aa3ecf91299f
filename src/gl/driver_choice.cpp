// SPDX-License-Identifier: MIT
#include "gl/driver_choice.h"

#include <algorithm>
#include <array>

namespace fragtrace {

Dispatch chooseDispatch(Dispatch wanted, const Context& context) {
  if (wanted != Dispatch::Auto) return wanted;
  static constexpr std::array<std::string_view, 9> kDataCentre{"A100", "A800", "H100",  "H800", "H200",
                                                               "H20",  "B200", "GH200", "GB200"};
  const bool fewRasterisers = std::ranges::any_of(
      kDataCentre, [&](std::string_view name) { return context.renderer.find(name) != std::string::npos; });
  return fewRasterisers && !context.software ? Dispatch::Compute : Dispatch::Fragment;
}

}  // namespace fragtrace
