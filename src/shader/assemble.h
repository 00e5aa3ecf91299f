// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "shader/variant.h"

namespace fragtrace {

/// One file of shaders/, embedded when the program was built.
struct EmbeddedShader {
  std::string_view name;
  std::string_view text;
};
const std::vector<EmbeddedShader>& embeddedShaders();

/// The origin of shader text, and the abilities of the driver.
struct ShaderSource {
  std::filesystem::path folder;  ///< read from disk when not empty, else the embedded text
  bool namedLines = false;       ///< #line takes file names (GL_ARB_shading_language_include)
};

/// The whole text of an entry (trace.frag, ...): version, the variant's constants, and the file with its
/// includes put in once each. Throws RenderError naming an include that is missing, InputError when
/// the folder lacks it.
std::string assembleShader(const ShaderSource& source, const std::string& entry,
                           const ShaderVariant& variant);

/// Removes branches that the constants at the top of a shader never take, functions that nothing calls, and
/// comments. Lines keep their numbers. Drivers process all of a text: a program of which half is dead takes
/// them a fifth longer to compile. Text that this function does not understand stays as it is.
std::string liveText(const std::string& text);

/// The same for people: comments stay, lines do not keep their numbers.
std::string readableText(const std::string& text);

/// assembleShader()'s text for people. It compiles to the same program.
std::string readableShader(ShaderSource source, const std::string& entry, const ShaderVariant& variant);

}  // namespace fragtrace
