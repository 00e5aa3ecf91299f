// SPDX-License-Identifier: MIT
#include "cli/own_program.h"

#include <stdexcept>

#include "base/errors.h"
#include "base/plugin.h"

namespace fragtrace {

std::filesystem::path ownProgram(const std::string& name, const std::string& user) {
  try {
    return ownFile(name);
  } catch (const std::runtime_error& error) {
    throw RenderError(user + ": the program " + error.what() +
                      "; the package fragtrace holds it, and scripts/build makes it");
  }
}

}  // namespace fragtrace
