// SPDX-License-Identifier: MIT
#include "base/plugin.h"

#include <dlfcn.h>

#include <cstdlib>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace fragtrace {

namespace {

/// The folders of our own libraries and programs: FRAGTRACE_LIBRARY_PATH, then that of the executable or
/// shared object that this code is part of.
std::vector<std::filesystem::path> ownFolders() {
  std::vector<std::filesystem::path> folders;
  if (const char* folder = std::getenv("FRAGTRACE_LIBRARY_PATH")) folders.emplace_back(folder);
  std::error_code error;
  const auto executable = std::filesystem::read_symlink("/proc/self/exe", error);
  // In Python the executable is the interpreter: the folder of our module counts.
  Dl_info own{};
  const bool known = dladdr(reinterpret_cast<const void*>(&ownFolders), &own) != 0 && own.dli_fname[0] == '/';
  const auto object = known ? std::filesystem::canonical(own.dli_fname, error) : executable;
  if (!object.empty()) folders.push_back(object.parent_path());
  return folders;
}

}  // namespace

std::filesystem::path ownFile(const std::string& name) {
  std::string places;
  for (const auto& folder : ownFolders()) {
    std::error_code error;
    if (std::filesystem::exists(folder / name, error)) return folder / name;
    places += (places.empty() ? "" : ", ") + folder.string();
  }
  throw std::runtime_error(name + " is not in " + places);
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
