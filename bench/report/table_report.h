// SPDX-License-Identifier: MIT
// `bench report`: Table I and Figure 9 of the report that fragtrace began with, measured again.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/report/frame_report.h"

namespace fragtrace {

/// The parts of the report; rows of one part belong together.
enum class ReportPart : uint8_t { Primitives, Traversal, Gi };
inline constexpr std::array<std::string_view, 3> kReportPartNames{"primitives", "traversal", "gi"};

/// One row: what is drawn, and the report's own figure.
struct ReportRow {
  ReportPart part;
  const char* subject;  ///< "1 primitive", "15,743 triangles"
  const char* method;   ///< "flat", "iterative"
  const char* scene;    ///< file name
  const char* options;
  double reportLow;   ///< milliseconds per picture; 0: the report has no such row
  double reportHigh;  ///< the same where it is one figure
  int samples = 1;    ///< samples per pixel of a picture
  double faces = 0;   ///< faces in the chart; 0: the row is not in it

  bool iterative() const { return std::string_view(method) == "iterative"; }
};
std::span<const ReportRow> reportRows();

/// The measurements of a row: with a draw for every sample, as in a viewer, and with many samples per draw.
/// Either may be missing.
struct MeasuredRow {
  const ReportRow* row = nullptr;
  std::optional<FrameSetting> single;
  std::optional<FrameSetting> many;
};

/// The rows of a table for people: mean and standard deviation of the milliseconds of a picture, beside the
/// report's.
std::string reportTable(const BenchMachine& machine, std::span<const MeasuredRow> rows);

/// Returns the ratios that show the shape of the curves: iterative against the number of triangles, the trees
/// against iterative, shadows against flat.
std::string reportRatios(std::span<const MeasuredRow> rows);

/// Figure 9: frame time against faces, both axes logarithmic, as SVG.
std::string reportChart(const BenchMachine& machine, std::span<const MeasuredRow> rows);

}  // namespace fragtrace
