// SPDX-License-Identifier: MIT
#include "process/plugin.h"

#include <dlfcn.h>

#include <cstdlib>
#include <system_error>

namespace fragtrace {

std::vector<std::filesystem::path> ownFolders() {
  std::vector<std::filesystem::path> folders;
  if (const char* folder = std::getenv("FRAGTRACE_LIBRARY_PATH")) folders.emplace_back(folder);
  std::error_code error;
  const auto executable = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(executable.parent_path());
  return folders;
}

Plugin openPlugin(const char* library, const char* function) {
  Plugin plugin{nullptr, "not found", false};
  for (const auto& folder : ownFolders()) {
    const auto path = folder / library;
    std::error_code error;
    if (!std::filesystem::exists(path, error)) {
      plugin.error = "not in " + folder.string();
      continue;
    }
    void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* entry = handle != nullptr ? dlsym(handle, function) : nullptr;
    if (entry != nullptr) return {entry, {}, true};
    return {nullptr, dlerror(), true};
  }
  return plugin;
}

}  // namespace fragtrace
