// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace fragtrace {

/// Why GLFW must not try Wayland; empty where it may. GLFW 3.4 crashes on a compositor without a seat, and
/// the library of Wayland prints messages of its own where there is no compositor.
std::string whyNoWayland();

}  // namespace fragtrace
