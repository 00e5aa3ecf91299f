// SPDX-License-Identifier: MIT
// The text of --add-light: "area at=0,2,1 to=0,0,0 size=1,0.5 power=50 color=1,0.9,0.8", "sun from=30,45".
#pragma once

#include <string>

#include "scene/selection.h"

namespace fragtrace {

/// Throws UsageError.
AddedLight addedLightIn(const std::string& text);

/// The text that is read as this light.
std::string textOf(const AddedLight& light);

}  // namespace fragtrace
