// SPDX-License-Identifier: MIT
// Parts of a file that the user names: scenes, animations, material variants, cameras.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fragtrace {

/// Text from a file may hold line ends, commands to a terminal, or marks that turn the direction of writing.
/// Each of these becomes a question mark.
std::string withoutControls(std::string_view text);

/// Text from a file in quotes, shortened; control characters become question marks.
std::string inQuotes(std::string_view text);

/// Parts of a file by index and, where they have one, name: 0 "walk", 1, 2 "run". Of many, those whose names
/// are most like the wanted one.
std::string listOfParts(const std::vector<std::string>& names, std::string_view wanted = {});

/// Those of these names that are most like the wanted one: "bolt", "bolts".
std::string nearestInQuotes(std::vector<std::string> names, std::string_view wanted);

/// Returns true if the texts differ in the case of ASCII letters at most.
bool isSameButForCase(std::string_view a, std::string_view b);

/// The index of the part that the user named: by its name, else by its index, else by the only name that is
/// the same without regard to case; none if there is no such part.
std::optional<size_t> findPart(const std::string& wanted, const std::vector<std::string>& names);

/// Does the same, but throws UsageError, which begins with `option` and lists the names.
size_t indexOfPart(const char* option, const std::string& wanted, const std::vector<std::string>& names);

/// The word by which the user asks for all materials.
inline constexpr const char* kAllMaterials = "all";

/// The word by which the user asks for all animations at once.
inline constexpr const char* kAllAnimations = "all";

/// The indices of the animations that the user named: the first where none is named, all of them by
/// kAllAnimations, unless one is called so. None where the file has none and none is named. Throws
/// UsageError.
std::vector<size_t> chosenAnimations(const std::string& wanted, const std::vector<std::string>& names);

}  // namespace fragtrace
