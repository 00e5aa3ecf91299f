// SPDX-License-Identifier: MIT
#include "image/library.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

namespace fragtrace {
namespace {

constexpr const char* kLibraryName = "libfragtrace_imageio.so";

struct OpenedLibrary {
  const ImageLibrary* library = nullptr;
  std::string error;  ///< set when library is not
};

std::vector<std::filesystem::path> libraryFolders() {
  std::vector<std::filesystem::path> folders;
  if (const char* folder = std::getenv("FRAGTRACE_LIBRARY_PATH")) folders.emplace_back(folder);
  std::error_code error;
  const auto executable = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) folders.push_back(executable.parent_path());
  return folders;
}

OpenedLibrary openLibrary() {
  std::string reason = "not found";
  for (const auto& folder : libraryFolders()) {
    const auto path = folder / kLibraryName;
    std::error_code error;
    if (!std::filesystem::exists(path, error)) {
      reason = "not in " + folder.string();
      continue;
    }
    void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* entry = handle != nullptr ? dlsym(handle, kImageLibraryEntry) : nullptr;
    if (entry != nullptr) return {reinterpret_cast<ImageLibraryEntry>(entry)(), {}};
    reason = dlerror();
    break;
  }
  return {nullptr, std::string("the image library ") + kLibraryName + " cannot be opened (" + reason +
                       "); .pfm files need none"};
}

const OpenedLibrary& openLibraryOnce() {
  static const OpenedLibrary opened = openLibrary();
  return opened;
}

}  // namespace

const ImageLibrary& imageLibrary() {
  const OpenedLibrary& opened = openLibraryOnce();
  if (opened.library == nullptr) throw std::runtime_error(opened.error);
  return *opened.library;
}

void preloadImageLibrary() noexcept {
  try {
    openLibraryOnce();
  } catch (const std::exception&) {
    // Out of memory or the like: the function-local static stays unset, and the first use tries again.
  }
}

}  // namespace fragtrace
