// SPDX-License-Identifier: MIT
#include "cli/own_program.h"

#include <system_error>

#include "errors.h"
#include "process/plugin.h"

namespace fragtrace {

std::filesystem::path ownProgram(const std::string& name, const std::string& user) {
  std::string places;
  for (const std::filesystem::path& folder : ownFolders()) {
    std::error_code error;
    if (std::filesystem::exists(folder / name, error)) return folder / name;
    places += (places.empty() ? "" : ", ") + folder.string();
  }
  throw RenderError(user + " needs the program " + name + ", which is not in " + places +
                    "; the package fragtrace holds it, and scripts/build makes it");
}

}  // namespace fragtrace
