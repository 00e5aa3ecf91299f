// SPDX-License-Identifier: MIT
// The two containers of glTF: plain JSON, and the binary .glb.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gltf/read/diagnostics.h"
#include "image/files/whole_file.h"

namespace fragtrace {

struct Container {
  std::string json;
  std::vector<uint8_t> binary;  ///< the BIN chunk of a .glb
  bool hasBinary = false;
  bool isGlb = false;
};

/// Reads the file and splits it. Its content decides which container it is, not its name. Throws InputError
/// if the file is missing, truncated, neither, or larger than the limit in bytes.
/// The lengths of the chunks of a regular .glb are checked before more than its beginning is read.
Container readContainer(const std::filesystem::path& path, uint64_t memoryLimit, Diagnostics& diagnostics,
                        const ReadProgress& progress = {});

}  // namespace fragtrace
