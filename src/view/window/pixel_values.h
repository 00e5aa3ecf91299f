// SPDX-License-Identifier: MIT
#pragma once

#include "view/window/overlay.h"

namespace fragtrace {

/// What the pixels hold, written into them where they are enlarged enough: linear red, green and blue.
void drawPixelValues(const ViewState& state, const ViewFacts& facts, const WindowLayout& layout);

}  // namespace fragtrace
