// SPDX-License-Identifier: MIT
// Files read and replaced as a whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace fragtrace {

/// All bytes of a file. Throws InputError naming the path and the system's reason.
std::vector<uint8_t> readWholeFile(const std::filesystem::path& path);

/// Makes the file hold exactly these bytes: they are written to .NAME.part beside it, which is then renamed,
/// so that anybody sees the old file or the new one. On failure the old file is untouched and the part
/// removed. Throws RenderError naming the path and the system's reason.
void replaceFile(const std::filesystem::path& path, std::span<const uint8_t> bytes);

/// Throws what replaceFile would when the folder is missing or closed to us: to be asked before long work.
void checkReplaceable(const std::filesystem::path& path);

}  // namespace fragtrace
