// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

namespace fragtrace {

/// One file of shaders/, embedded when the program was built.
struct EmbeddedShader {
  std::string_view name;
  std::string_view text;
};
const std::vector<EmbeddedShader>& embeddedShaders();

}  // namespace fragtrace
