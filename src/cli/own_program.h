// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace fragtrace {

/// Where the program of that name lies, in one of ownFolders() (process/plugin.h). Throws RenderError, which
/// says what needs it, where it is missing, and what brings it.
std::filesystem::path ownProgram(const std::string& name, const std::string& user);

}  // namespace fragtrace
