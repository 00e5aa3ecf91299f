// SPDX-License-Identifier: MIT
// Words of a command line given to the option library, and its errors in the words of this program.
#pragma once

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

#include <string>
#include <string_view>
#include <vector>

namespace fragtrace {

/// Numbers such as "-.5,0,1" look like short options to the library; a zero before the point settles it. And
/// --resolution, the word `before` it, may be written as 640x480.
std::string withNumberSettled(std::string argument, std::string_view before);

/// The option of the command that an unknown one ("--widht") most likely stands for; empty if none is near.
std::string optionMeant(const std::string& unknown, const CLI::App& command);

/// Says an error of the option library about a command, or about one that it groups.
std::string plainText(const CLI::ParseError& error, const CLI::App& app);

/// Gives a command its words, in their order, with numbers settled. Throws UsageError, which says where to
/// find `more`, and names the word that is not known with the one that was meant; without `more`, as for a
/// pasted text, it lists all such words in that order. Throws CLI::Success for --help and --version.
void parseWords(CLI::App& app, std::vector<std::string> words, const char* more = "");

/// The option that an unknown one probably means: what other programs call it, the same beginning, or similar
/// letters; empty if none is near. Names have their dashes, and the form of a value may follow.
std::string suggestedOption(const std::string& unknown, const std::vector<std::string>& known);

}  // namespace fragtrace
