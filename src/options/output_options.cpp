// SPDX-License-Identifier: MIT
#include "options/output_options.h"

#include <CLI/CLI.hpp>

#include "options/choose.h"
#include "options/numbers.h"

namespace fragtrace {

namespace {

constexpr std::array<std::string_view, 5> kFormatNames{"png", "jpg", "exr", "hdr", "pfm"};

}  // namespace

void addOutputOptions(CLI::App& app, RawRender& raw) {
  app.add_option(
         "--region", raw.region,
         "X,Y,WIDTH,HEIGHT in pixels from the top left of the picture: draw and write this part alone, "
         "with the same samples as in the whole")
      ->delimiter(',')
      ->expected(4)
      ->check(wholeNumber(0, 65536));
  app.add_option("--checkpoint", raw.options.output.checkpointSeconds,
                 "write the state of the render to OUTPUT.checkpoint every this many seconds, and when the "
                 "render is interrupted; the file is deleted when the picture is finished")
      ->check(CLI::Range(0.1, 1e7));
  app.add_flag("--resume", raw.options.output.resume,
               "continue from OUTPUT.checkpoint; the result is the same picture; if there is no checkpoint, "
               "start from the beginning, or do nothing if the picture is finished");
  app.add_option("--format", raw.format,
                 "format of the picture that --output - writes to standard output: " + joined(kFormatNames));
  app.add_option("--progress", raw.progress,
                 "how progress is reported on stderr: as a bar or lines (auto), as one JSON object per line, "
                 "messages included (json), or not at all (none)")
      ->capture_default_str();
}

void chooseStandardOutput(const RawRender& raw, RenderOptions& o) {
  if (!raw.format.empty()) choose<int>("--format", raw.format, kFormatNames);
  if (raw.output != "-") {
    if (!raw.format.empty())
      throw UsageError("--format: needs --output -; a file has the format of its name");
    return;
  }
  const auto refuse = [](const std::string& why) { throw UsageError("--output -: " + why); };
  if (raw.format.empty()) refuse("needs --format, one of " + joined(kFormatNames));
  if (o.output.checkpointSeconds > 0.0 || o.output.resume) refuse("--checkpoint and --resume need a file");
  if (raw.statsFile == "-")
    refuse("standard output takes the picture or the statistics (--stats -), not both");
  o.output.toStandardOutput = true;
  o.output.file = "standard output." + raw.format;
}

}  // namespace fragtrace
