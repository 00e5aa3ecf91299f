// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace fragtrace {

/// The path of a file:// URI (RFC 8089), with its %XX decoded; nothing for another scheme, another host than
/// this, or a URI that is malformed.
std::optional<std::filesystem::path> fileOfUri(std::string_view uri);

}  // namespace fragtrace
