// SPDX-License-Identifier: MIT
#include "bench/command/results.h"

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>

#include "session/interrupt.h"

namespace fragtrace {

void addJsonOption(CLI::App& app, ResultFiles& files, const char* help) {
  app.add_option("--json", files.json, help)->type_name("FILE");
}

void checkResultFiles(const ResultFiles& files, std::span<const std::filesystem::path> inputs) {
  checkOutputs(std::array{NamedOutput{"--json", files.json}}, inputs);
}

void writeResults(const ResultFiles& files, const ResultTexts& texts) {
  countInterrupts();
  std::fputs(texts.table.c_str(), stdout);
  replaceText(files.json, texts.json);
}

}  // namespace fragtrace
