// SPDX-License-Identifier: MIT
#include "image/library.h"

#include <stdexcept>
#include <string>

#include "plugin.h"

namespace fragtrace {
namespace {

constexpr const char* kLibraryName = "libfragtrace_imageio.so";

struct OpenedLibrary {
  const ImageLibrary* library = nullptr;
  std::string error;  ///< set when library is not
};

OpenedLibrary openLibrary() {
  const Plugin plugin = openPlugin(kLibraryName, kImageLibraryEntry);
  if (plugin.entry != nullptr) return {reinterpret_cast<ImageLibraryEntry>(plugin.entry)(), {}};
  return {nullptr, std::string("the image library ") + kLibraryName + " cannot be opened (" + plugin.error +
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
