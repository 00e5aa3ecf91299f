// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "gl/context.h"

namespace fragtrace {

/// Runs the job in the calling thread with that context current, whose functions are loaded already; nothing
/// stays bound there, since that would stay in memory, too. Throws as the job does, and RenderError.
void runIn(const OutsideContext& context, const std::function<void()>& job);

}  // namespace fragtrace
