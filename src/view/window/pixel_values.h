// SPDX-License-Identifier: MIT
#pragma once

#include "view/window/overlay.h"

namespace fragtrace {

/// What is shown at a place, linear: of a side, or how far it is from the other; none where it is not known.
std::optional<glm::dvec3> shownValue(const ViewFacts& facts, size_t side, bool difference,
                                     const glm::dvec2& place);

/// Which pixels of a side's picture, of that size, somebody looks at.
PixelArea wantedArea(const ViewState& state, const ViewFacts& facts, size_t side, glm::ivec2 whole);

/// Returns true if pixels are enlarged enough for values in them.
bool showsPixelValues(const ViewState& state);

/// What the pixels hold, written into them where they are enlarged enough: linear red, green and blue.
void drawPixelValues(const ViewState& state, const ViewFacts& facts, const WindowLayout& layout);

}  // namespace fragtrace
