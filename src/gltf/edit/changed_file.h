// SPDX-License-Identifier: MIT
// A scene's file with other numbers, for the next user of the model.
#pragma once

#include <filesystem>
#include <span>

#include "scene/selection.h"

namespace fragtrace {

/// Throws UsageError if one of these is no number of that .gltf or .glb, NotInFile if it lacks the place or
/// the material, InputError if the file cannot be read.
void checkChange(const std::filesystem::path& from, std::span<const SetNumber> set);

/// Returns true if one of the arrays at these JSON pointers of the file has a part that the user's word
/// names: by its name, its index or its own pointer. Throws InputError if the file cannot be read.
bool hasPart(const std::filesystem::path& file, std::span<const char* const> arrays,
             const std::string& wanted);

/// Writes the .gltf or .glb `from` to `to`, with these numbers in its JSON; all other bytes stay, except for
/// the lengths in a .glb and the spaces at the end of its JSON. Buffers and images are referred to as before:
/// a file that refers to others is only written into its own folder. `to` may be `from`. Throws InputError if
/// the file cannot be read, has no such number, or is not to be written under that name; RenderError if it
/// cannot be written.
void writeChanged(const std::filesystem::path& from, const std::filesystem::path& to,
                  std::span<const SetNumber> set);

}  // namespace fragtrace
