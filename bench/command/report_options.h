// SPDX-License-Identifier: MIT
// The options of `bench report`.
#pragma once

#include <string>
#include <vector>

#include "bench/command/configurations.h"
#include "bench/command/timed_setting.h"
#include "bench/report/table_report.h"

namespace fragtrace {

/// A row of the report and how it is drawn here.
struct BenchReportRow {
  const ReportRow* row;
  BenchConfiguration configuration;
};

struct BenchReportOptions {
  std::vector<BenchReportRow> rows;
  FrameTiming timing;
  std::filesystem::path json;
  std::filesystem::path chart;

  const RenderOptions& first() const { return rows.front().configuration.render; }
};

/// Options as the library parses them.
struct RawBenchReport {
  std::string scenes = "scenes";
  std::vector<std::string> parts;
  bool noIterative = false;
  RawConfigurations configurations;
  BenchReportOptions options;
};

/// Adds those of `render`, too.
void addBenchReportOptions(CLI::App& app, RawBenchReport& raw);

/// Throws UsageError.
BenchReportOptions finishBenchReport(const RawBenchReport& raw, const CLI::App& app);

}  // namespace fragtrace
