// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace fragtrace {

/// The path of a program that ownFile() (base/plugin.h) finds. Throws RenderError where it is missing:
/// `user` is the command that needs it.
std::filesystem::path ownProgram(const std::string& name, const std::string& user);

}  // namespace fragtrace
