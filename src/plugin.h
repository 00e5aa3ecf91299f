// SPDX-License-Identifier: MIT
// Shared objects of our own, opened when they are first needed, so that runs that do not need them pay
// nothing for the libraries that they bring.
#pragma once

#include <string>

namespace fragtrace {

struct Plugin {
  void* entry = nullptr;
  std::string error;  ///< why there is no entry
};

/// Opens the library, which is looked for in the folder FRAGTRACE_LIBRARY_PATH, then beside the executable,
/// and finds the function of that name. It stays open.
Plugin openPlugin(const char* library, const char* function);

}  // namespace fragtrace
