// SPDX-License-Identifier: MIT
// `fragtrace denoise`: filters the noise out of a picture that stands in a file.
#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <memory>
#include <string_view>

#include "base/errors.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/program.h"
#include "image/channels.h"
#include "image/files/video_format.h"
#include "image/format.h"
#include "options/library/option_facts.h"
#include "options/option_row.h"
#include "options/option_text.h"
#include "options/parse_render.h"
#include "session/outputs.h"
#include "session/picture/denoising.h"
#include "session/picture/joined_parts.h"
#include "session/picture/picture_file.h"
#include "session/say.h"

namespace fragtrace {

namespace {

constexpr std::array<std::string_view, 3> kFileFilterNames{"auto", "variance", "oidn"};

/// The part of the picture that the file's format can hold.
Image writable(const Image& picture, const std::filesystem::path& path) {
  if (formatOfName(path) == ImageFormat::OpenExr) return picture;
  std::vector<std::string> names{"R", "G", "B"};
  if (findChannel(picture, "A")) names.emplace_back("A");
  return onlyChannels(picture, names);
}

int runDenoise(const std::filesystem::path& file, RenderOptions options) {
  checkOutputs(std::array{NamedOutput{"--output", options.output.file}}, std::array{file});
  const std::optional<OidnLibrary> oidn = openDenoiser(options);
  const LinearImage read = readLinearImage(file, options.limits.memoryBytes);
  // Such files hold values as a display shows them, for which the filters are not made.
  if (read.wasEncoded)
    throw InputError(file.string() + ": is no picture of linear radiance (.exr, .hdr, .pfm)");
  sayNotes(options, file, read.image);
  const Image drawn = asDrawn(read.image);
  if (!options.output.exposure && holdsDisplay(options.output.file)) {
    options.output.exposure = exposureOf(drawn);
    if (options.output.exposure)
      say(options,
          formatted("%s has an exposure of %.1f, as the render of %s asks for (--exposure 0 has none)",
                    options.output.file.string().c_str(), *options.output.exposure, file.string().c_str()));
  }
  DenoiseStatistics stats;
  Image result = denoisedFile(drawn, file, options, oidn, stats);
  result.placement = drawn.placement;
  writePicture(options, writable(result, options.output.file), {});
  if (!options.output.quiet && !standardOutputIsClosed()) {
    std::printf("%s: %d x %d, %s\n", options.output.file.string().c_str(), result.width, result.height,
                filterText(stats).c_str());
  }
  return 0;
}

}  // namespace

void addFileFilterOptions(CLI::App& app, RawRender& raw) {
  addOption(app, "--oidn-library", raw);
  addOption(app, "--rendering-backend", raw,
            rowOf("--rendering-backend").help + "; the variance filter needs it");
  addOption(app, "--device", raw);
  addOption(app, "--shader-folder", raw);
  addOption(
      app, "--memory-limit", raw,
      "memory limit, counted separately for the picture and for Open Image Denoise, such as 500MB or 2GiB");
  addOption(app, "--quiet", raw, "print errors only");
  addOption(app, "--verbose", raw, "print the choices that the program makes");
}

RunCommand addDenoise(CLI::App& app) {
  struct Raw {
    std::string picture;
    RawRender render;
  };
  const auto raw = std::make_shared<Raw>();
  raw->render.options.output.denoise = Denoise::Auto;
  app.add_option("picture", raw->picture,
                 "linear picture: an .exr of fragtrace or another renderer, an .hdr or a .pfm")
      ->type_name("FILE")
      ->required();
  addOption(app, "--output", raw->render,
            "picture to write: .exr (with all layers), .hdr .pfm (linear radiance), .png .jpg (tone-mapped, "
            "sRGB)")
      ->required();
  addOption(app, "--denoise", raw->render,
            "filter: " + joined(kFileFilterNames) +
                "; auto uses oidn if it is installed, otherwise variance, which needs the layers of --aov "
                "denoising")
      ->check(withChoices(kFileFilterNames));
  addFileFilterOptions(app, raw->render);
  addOption(app, "--exposure", raw->render);
  addOption(app, "--tone-map", raw->render);
  addOptions(app, OptionGroup::Encoding, raw->render);
  return [raw] {
    const RenderOptions options = finishRender(raw->render);
    if (options.output.denoise == Denoise::None)
      throw UsageError("--denoise: 'none' is none of " + joined(kFileFilterNames));
    checkEncoding(options.output.encoding, options.output.file);
    return runDenoise(raw->picture, options);
  };
}

}  // namespace fragtrace
