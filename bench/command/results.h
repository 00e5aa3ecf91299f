// SPDX-License-Identifier: MIT
// The files that a benchmark writes next to its table.
#pragma once

#include <filesystem>
#include <string>

#include "session/outputs.h"

namespace CLI {
class App;
}

namespace fragtrace {

struct ResultFiles {
  std::filesystem::path json;
};

/// `help` says what is in the file.
void addJsonOption(CLI::App& app, ResultFiles& files, const char* help);

/// Must be called before long work, like checkOutputs of session/outputs.h.
void checkResultFiles(const ResultFiles& files, std::span<const std::filesystem::path> inputs);

struct ResultTexts {
  std::string table;  ///< the table for standard output
  std::string json;
};
/// Prints and writes what was measured. Interrupts no longer stop the program, so that it is written whole.
void writeResults(const ResultFiles& files, const ResultTexts& texts);

}  // namespace fragtrace
