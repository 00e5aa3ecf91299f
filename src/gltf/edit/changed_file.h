// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "scene/parts.h"

namespace fragtrace {

// Numbers and words set in the text of a JSON document, of which all other bytes stay.

/// The text with these values at their places; members are inserted where they are missing, and so are the
/// objects that hold them; an extension of a material that is new is listed among those that are used. A
/// number stays as it is written where it is the same as a float. The text must be JSON. Throws
/// std::runtime_error if a place is below something that is no object and has no such element.
std::string withNumbers(std::string text, std::span<const SetNumber> set);

// A scene's file with other numbers, for the next user of the model.

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
