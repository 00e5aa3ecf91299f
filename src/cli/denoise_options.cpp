// SPDX-License-Identifier: MIT
#include "cli/denoise_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string_view>

#include "options/choose.h"
#include "options/encoding_options.h"
#include "options/numbers.h"

namespace fragtrace {

namespace {

constexpr std::array<std::string_view, 3> kFileFilterNames{"auto", "variance", "oidn"};

/// What `render` says of its option.
std::string describedByRender(const char* name) {
  CLI::App render;
  RawRender unused;
  addRenderOptions(render, unused);
  addDenoiseOption(render, unused);
  return render.get_option(name)->get_description();
}

}  // namespace

void addFileFilterOptions(CLI::App& app, RawRender& raw) {
  app.add_option("--oidn-library", raw.oidnLibrary, describedByRender("--oidn-library"))->type_name("FILE");
  app.add_option("--rendering-backend", raw.backend,
                 describedByRender("--rendering-backend") + "; the variance filter needs it")
      ->capture_default_str();
  app.add_option("--shader-folder", raw.shaderFolder, describedByRender("--shader-folder"))
      ->type_name("FOLDER");
  app.add_option("--memory-limit", raw.options.limits.memoryBytes,
                 "memory limit, counted separately for the picture and for Open Image Denoise, such as 500MB "
                 "or 2GiB")
      ->transform(memorySize(kLeastMemoryBytes))
      ->type_name("SIZE");
  app.add_flag("--quiet", raw.options.output.quiet, "print errors only");
  app.add_flag("--verbose", raw.options.output.verbose, "print the choices that the program makes");
}

void addDenoiseCommandOptions(CLI::App& app, RawDenoise& raw) {
  raw.render.denoise = "auto";
  app.add_option("picture", raw.picture,
                 "linear picture: an .exr of fragtrace or another renderer, an .hdr or a .pfm")
      ->type_name("FILE")
      ->required();
  app.add_option("-o,--output", raw.render.output,
                 "picture to write: .exr (with all layers), .hdr .pfm (linear radiance), .png .jpg "
                 "(tone-mapped, sRGB)")
      ->type_name("FILE")
      ->required();
  app.add_option("--denoise", raw.render.denoise,
                 "filter: " + joined(kFileFilterNames) +
                     "; auto uses oidn if it is installed, otherwise variance, which needs the layers of "
                     "--aov denoising")
      ->capture_default_str();
  addFileFilterOptions(app, raw.render);
  app.add_option("--exposure", raw.render.options.output.exposure, describedByRender("--exposure"))
      ->capture_default_str();
  app.add_option("--tone-map", raw.render.toneMap, describedByRender("--tone-map"))->capture_default_str();
  addHalfOption(app, raw.render.options.output.encoding);
  addPngDepthOption(app, raw.render.options.output.encoding);
}

DenoiseOptions finishDenoise(const RawDenoise& raw) {
  if (std::ranges::find(kFileFilterNames, raw.render.denoise) == kFileFilterNames.end())
    throw UsageError("--denoise: '" + raw.render.denoise + "' is none of " + joined(kFileFilterNames));
  const RenderOptions render = finishRender(raw.render);
  checkEncoding(render.output.encoding, render.output.file);
  return {raw.picture, render};
}

}  // namespace fragtrace
