// SPDX-License-Identifier: MIT
// `fragtrace merge`: parts of one render, made with other samples each (--sample-offset, --seed), joined.
#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <memory>

#include "base/errors.h"
#include "cli/commands.h"
#include "cli/program.h"
#include "image/format.h"
#include "options/option_text.h"
#include "options/parse_render.h"
#include "session/outputs.h"
#include "session/picture/denoising.h"
#include "session/picture/joined_parts.h"
#include "session/picture/picture_file.h"

namespace fragtrace {

namespace {

struct MergeOptions {
  std::vector<std::filesystem::path> parts;
  std::filesystem::path output;
  RenderOptions filter;  ///< read are the options that denoise the joined picture
};

int runMerge(const MergeOptions& options) {
  checkOutputs(std::array{NamedOutput{"--output", options.output}}, options.parts);
  RenderOptions filter = options.filter;
  const std::optional<OidnLibrary> oidn = openDenoiser(filter);
  std::vector<Part> parts;
  for (const std::filesystem::path& path : options.parts) parts.push_back(readPart(path));
  const Part joined = joinedParts(std::move(parts));
  Image result = joined.image;
  std::string filtered;
  if (filter.output.denoise != Denoise::None) {
    DenoiseStatistics stats;
    result = denoisedFile(result, options.parts.front(), filter, oidn, stats);
    result.placement = joined.image.placement;
    filtered = ", " + filterText(stats);
  }
  filter.output.file = options.output;
  sayClamped(filter, writeImage(options.output, result, filter.output.encoding));
  if (!filter.output.quiet && !standardOutputIsClosed())
    std::printf("%s: %s%s\n", options.output.string().c_str(),
                describeParts(options.parts.size(), joined).c_str(), filtered.c_str());
  return 0;
}

}  // namespace

RunCommand addMerge(CLI::App& app) {
  struct Raw {
    MergeOptions options;
    RawRender filter;
  };
  const auto raw = std::make_shared<Raw>();
  app.add_option(
         "parts", raw->options.parts,
         ".exr files of render, with the same settings and different samples (--sample-offset, --seed)")
      ->type_name("FILE")
      ->required();
  app.add_option("-o,--output", raw->options.output, "file to write, an .exr")->type_name("FILE")->required();
  addOption(app, "--denoise", raw->filter,
            "filter that removes noise from the merged picture: " + joined(kDenoiseNames));
  addOption(app, "--half", raw->filter);
  addFileFilterOptions(app, raw->filter);
  return [raw] {
    MergeOptions options = raw->options;
    if (formatOfName(options.output) != ImageFormat::OpenExr)
      throw UsageError("--output: '" + options.output.string() + "' does not end in .exr");
    options.filter = finishRender(raw->filter);
    return runMerge(options);
  };
}

}  // namespace fragtrace
