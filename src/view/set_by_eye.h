// SPDX-License-Identifier: MIT
// Materials and lights with the numbers that the viewer's user sets.
#pragma once

#include <string>
#include <vector>

#include "view/view_state.h"

namespace fragtrace {

/// Returns true if both set the same place to the same, as floats.
bool isSame(const SetNumber& a, const SetNumber& b);

/// Sets the number in the list; if it is the file's, ends what was set there.
void setNumberIn(std::vector<SetNumber>& set, SetNumber number, const SetNumber& inFile);

/// Sets numbers of the scene's materials or lights. `inFile` are the file's at that place: they
/// end what was set there.
void setNumber(ViewState& state, SetNumber number, const SetNumber& inFile);

/// Names the light of the scene that is shown, and the units of its lamps, where the program decided them or
/// emission that is set could do so in the file that is saved.
void nameLight(RenderOptions& options, const ViewedScene& scene);

/// A material's values, a line each: those that the user sees first, and of the others those that are not the
/// defaults.
std::vector<std::string> materialLines(const Material& material);

/// The material at that index of the scene's, with the numbers that are set.
Material shownMaterial(const ViewState& state, size_t index);

/// Returns the lines that describe a picked surface. Values of its material are as they are set now.
std::vector<std::string> pickLines(const ViewState& state, const PickAnswer& answer);

}  // namespace fragtrace
