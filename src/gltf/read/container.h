// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gltf/read/diagnostics.h"
#include "image/files/whole_file.h"

namespace fragtrace {

// Resolves a glTF URI: bytes in the URI itself, or a file next to the scene.

/// The places to which a file's URIs may lead.
struct FileAccess {
  std::filesystem::path folder;  ///< the start of relative URIs
  bool allowExternal = false;    ///< allows files out of the folder
  ReadProgress progress{};       ///< reports every file
};

bool isDataUri(std::string_view uri);

/// The file that a relative URI names. Backslashes, escaped or not, are slashes where no file of that name
/// exists.
std::filesystem::path pathOfUri(const FileAccess& access, std::string_view uri);

/// Returns a message about an odd URI with an obvious reading, which says that reading; empty: it is not odd.
std::string oddityOf(const FileAccess& access, std::string_view uri);

/// Returns true if it is a relative URI, within the folder, to a file that is not there.
bool isMissing(const FileAccess& access, std::string_view uri);

/// The names of files, as many as a message has room for.
std::string listed(const std::vector<std::string>& names);

/// The other ones of these URIs that are missing, as the end of a message about one; empty: none.
std::string alsoMissing(const FileAccess& access, const std::vector<std::string>& uris, std::string_view one);

/// The bytes, at most what is left of `memory`, that a data URI holds or that a relative URI names. Throws
/// std::runtime_error with the reason: no such file, not a regular file, broken base64; AtStake for what lies
/// out of the folder or has a scheme, and for memory.
std::vector<uint8_t> readUri(const FileAccess& access, std::string_view uri, const MemoryBudget& memory);

// The two containers of glTF: plain JSON, and the binary .glb.

struct Container {
  std::string json;
  std::vector<uint8_t> binary;  ///< the BIN chunk of a .glb
  bool hasBinary = false;
};

/// Reads the file and splits it. Its content decides which container it is, not its name. Throws InputError
/// if the file is missing, truncated, neither, or larger than the limit in bytes.
/// The lengths of the chunks of a regular .glb are checked before more than its beginning is read.
Container readContainer(const std::filesystem::path& path, uint64_t memoryLimit, Diagnostics& diagnostics,
                        const ReadProgress& progress = {});

}  // namespace fragtrace
