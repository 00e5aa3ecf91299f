// SPDX-License-Identifier: MIT
// What a glTF URI stands for: bytes in the URI itself, or a file beside the scene.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fragtrace {

/// Reads a whole file; false with a reason such as "cannot be opened: No such file or directory".
bool readFile(const std::filesystem::path& path, std::vector<uint8_t>& bytes, std::string& reason);

/// "%20" to " ", byte by byte, so that UTF-8 stays UTF-8; what is no valid escape is kept as it is.
std::string percentDecoded(std::string_view text);

bool isDataUri(std::string_view uri);

/// The file that a relative URI names.
std::filesystem::path pathOfUri(const std::filesystem::path& folder, std::string_view uri);

/// The bytes that a data URI holds or that a relative URI names; false with a reason.
bool readUri(const std::filesystem::path& folder, std::string_view uri, std::vector<uint8_t>& bytes,
             std::string& reason);

}  // namespace fragtrace
