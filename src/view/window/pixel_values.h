// SPDX-License-Identifier: MIT
#pragma once

#include "view/window/overlay.h"

namespace fragtrace {

/// The linear value at a place: of a side, or its difference from the other; none if it is not known.
std::optional<glm::dvec3> shownValue(const ViewFacts& facts, size_t side, bool difference,
                                     const glm::dvec2& place);

/// The pixels of a side's picture, of that size, that somebody looks at.
PixelArea wantedArea(const ViewState& state, const ViewFacts& facts, size_t side, glm::ivec2 whole);

/// Returns true if pixels are enlarged enough for values in them.
bool showsPixelValues(const ViewState& state);

/// Writes the linear red, green and blue of the pixels into them, if they are enlarged enough.
void drawPixelValues(const ViewState& state, const ViewFacts& facts, const WindowLayout& layout);

}  // namespace fragtrace
