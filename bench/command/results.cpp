// SPDX-License-Identifier: MIT
#include "bench/command/results.h"

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>

#include "base/errors.h"
#include "session/interrupt.h"

namespace fragtrace {

void addJsonOption(CLI::App& app, ResultFiles& files, const char* help) {
  app.add_option("--json", files.json, help)->type_name("FILE");
}

void addChartOption(CLI::App& app, ResultFiles& files, const char* help) {
  app.add_option("--chart", files.chart, help)->type_name("FILE");
}

void checkChart(const ResultFiles& files) {
  if (!files.chart.empty() && files.chart.extension() != ".svg")
    throw UsageError("--chart: '" + files.chart.string() + "' does not end in .svg");
}

void checkResultFiles(const ResultFiles& files, std::span<const std::filesystem::path> inputs) {
  const std::array<NamedOutput, 3> outputs{
      {{"--json", files.json}, {"--csv", files.csv}, {"--chart", files.chart}}};
  checkOutputs(outputs, inputs);
}

void writeResults(const ResultFiles& files, const ResultTexts& texts) {
  countInterrupts();
  std::fputs(texts.table.c_str(), stdout);
  replaceText(files.json, texts.json);
  replaceText(files.csv, texts.csv);
  replaceText(files.chart, texts.chart);
}

}  // namespace fragtrace
