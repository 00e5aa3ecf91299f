// SPDX-License-Identifier: MIT
// Numbers of the file that the viewer's user has set.
#include <algorithm>

#include "view/view_state.h"

namespace fragtrace {

void setNumber(ViewState& state, SetNumber number, const SetNumber& inFile) {
  std::vector<SetNumber> set = state.sides[0].selection.set;
  std::erase_if(set, [&](const SetNumber& one) { return one.pointer == number.pointer; });
  const auto sameFloat = [](double a, double b) { return float(a) == float(b); };
  if (!std::ranges::equal(number.values, inFile.values, sameFloat)) set.push_back(std::move(number));
  for (RenderOptions& side : state.sides) side.selection.set = set;
  state.scene->options.selection = state.sides[0].selection;
}

}  // namespace fragtrace
