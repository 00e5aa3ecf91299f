// SPDX-License-Identifier: MIT
// `fragtrace denoise`: filters the noise out of a picture that stands in a file.
#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <memory>

#include "base/errors.h"
#include "cli/commands.h"
#include "cli/denoise_options.h"
#include "cli/program.h"
#include "image/channels.h"
#include "image/format.h"
#include "session/outputs.h"
#include "session/picture/denoised_file.h"
#include "session/picture/picture_file.h"

namespace fragtrace {

namespace {

/// The part of the picture that the file's format can hold.
Image writable(const Image& picture, const std::filesystem::path& path) {
  if (formatOfName(path) == ImageFormat::OpenExr) return picture;
  std::vector<std::string> names{"R", "G", "B"};
  if (findChannel(picture, "A")) names.emplace_back("A");
  return onlyChannels(picture, names);
}

int runDenoise(const DenoiseOptions& asked) {
  RenderOptions options = asked.render;
  checkOutputs(std::array{NamedOutput{"--output", options.output.file}}, std::array{asked.picture});
  const std::optional<OidnLibrary> oidn = openDenoiser(options);
  const LinearImage read = readLinearImage(asked.picture, options.limits.memoryBytes);
  // Such files hold values as a display shows them, for which the filters are not made.
  if (read.wasEncoded)
    throw InputError(asked.picture.string() + ": is no picture of linear radiance (.exr, .hdr, .pfm)");
  const Image drawn = asDrawn(read.image);
  DenoiseStatistics stats;
  Image result = denoisedFile(drawn, asked.picture, options, oidn, stats);
  result.placement = drawn.placement;
  writePicture(options, writable(result, options.output.file), {});
  if (!options.output.quiet && !standardOutputIsClosed()) {
    std::printf("%s: %d x %d, %s\n", options.output.file.string().c_str(), result.width, result.height,
                filterText(stats).c_str());
  }
  return 0;
}

}  // namespace

RunCommand addDenoise(CLI::App& app) {
  const auto raw = std::make_shared<RawDenoise>();
  addDenoiseCommandOptions(app, *raw);
  return [raw] { return runDenoise(finishDenoise(*raw)); };
}

}  // namespace fragtrace
