// SPDX-License-Identifier: MIT
// Options that go on working under an older name.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace fragtrace {

/// The group of such options, which --help leaves out. Their description names the new spelling.
inline constexpr const char* kOldSpellings = "Old spellings";

/// A line for each that was given to the command, or to its --config so far.
std::vector<std::string> oldSpellingsOf(const CLI::App& command);

/// Prints those on stderr that are not among `said`, unless the command has --quiet.
void sayOldSpellings(const CLI::App& command, const std::vector<std::string>& said = {});

/// --help without that group, for a command and all that are added to it.
void hideOldSpellings(CLI::App& app);

}  // namespace fragtrace
