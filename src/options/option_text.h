// SPDX-License-Identifier: MIT
// Options as text that a shell takes, and such text as words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace fragtrace {

/// The fewest digits, from 15 on, that the command line reads as the same number.
std::string exactText(double value);

/// The word, in quotes where a POSIX shell would not take it as it stands.
std::string quoted(const std::string& word);

/// Appends the option and its value, quoted.
void appendOption(std::string& text, const char* option, const std::string& value);

/// The words that a POSIX shell makes of a text by quotes, backslashes and continued lines; it expands
/// nothing. Throws UsageError for a quote without its end.
std::vector<std::string> splitWords(const std::string& text);

/// Numbers such as "-.5,0,1" look like short options to the library; a zero before the point settles it. And
/// --resolution, the word `before` it, may be written as 640x480.
std::string withNumberSettled(std::string argument, std::string_view before);

/// The same of all words of a command.
std::vector<std::string> withNumbersSettled(std::vector<std::string> words);

/// Says an error of the option library in the words of this program's messages.
std::string plainText(const CLI::ParseError& error);

/// Gives a command its words, in their order. Throws UsageError, which names words that it does not know in
/// that order.
void parseWords(CLI::App& app, std::vector<std::string> words);

}  // namespace fragtrace
