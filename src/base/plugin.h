// SPDX-License-Identifier: MIT
// Shared objects of our own. They are opened when they are first needed, so that other runs pay nothing for
// their libraries.
#pragma once

#include <filesystem>
#include <string>

namespace fragtrace {

/// Searches these folders in order for the file. Throws std::runtime_error that names them.
std::filesystem::path ownFile(const std::string& name);

struct Plugin {
  void* entry = nullptr;
  std::string error;   ///< why there is no entry
  bool found = false;  ///< the file is there: without an entry, a library that it needs is not
};

/// Opens the library, which is in one of these folders, and finds the function of that name. It stays open.
Plugin openPlugin(const char* library, const char* function);

}  // namespace fragtrace
