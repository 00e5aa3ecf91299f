// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace fragtrace {

/// The steps of a picture of the viewer, in their order.
enum class Pass : size_t { Trace, Guides, Film, Past, Filter, Show };
inline constexpr std::array kPassNames{"trace", "guides", "film", "past", "filter", "show"};

/// Milliseconds of each.
struct PassTimes {
  std::array<double, kPassNames.size()> wall{};  ///< meaningful where each pass was waited for
  std::array<double, kPassNames.size()> cpu{};   ///< processor time of the tracing thread
};

}  // namespace fragtrace
