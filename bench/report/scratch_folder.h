// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include "base/errors.h"

namespace fragtrace {

/// A folder for temporary files that goes with it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::error_code error;
    const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
    std::string name = (parent / "fragtrace-bench-XXXXXX").string();
    if (error || !::mkdtemp(name.data()))
      throw RenderError("no folder for temporary files can be made" + (error ? "" : " as " + name) +
                        "; TMPDIR names the folder that is to hold it");
    path_ = name;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace fragtrace
