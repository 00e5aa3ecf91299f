// SPDX-License-Identifier: MIT
#include "cli/denoise_options.h"

#include <CLI/CLI.hpp>
#include <array>
#include <string_view>

#include "options/choose.h"

namespace fragtrace {

namespace {

constexpr std::array<std::string_view, 3> kFileFilterNames{"auto", "variance", "oidn"};

}  // namespace

void addFileFilterOptions(CLI::App& app, RawRender& raw) {
  addOption(app, "--oidn-library", raw);
  addOption(app, "--rendering-backend", raw,
            rowOf("--rendering-backend").help + "; the variance filter needs it");
  addOption(app, "--shader-folder", raw);
  addOption(
      app, "--memory-limit", raw,
      "memory limit, counted separately for the picture and for Open Image Denoise, such as 500MB or 2GiB");
  addOption(app, "--quiet", raw, "print errors only");
  addOption(app, "--verbose", raw, "print the choices that the program makes");
}

void addDenoiseCommandOptions(CLI::App& app, RawDenoise& raw) {
  raw.render.options.output.denoise = Denoise::Auto;
  app.add_option("picture", raw.picture,
                 "linear picture: an .exr of fragtrace or another renderer, an .hdr or a .pfm")
      ->type_name("FILE")
      ->required();
  addOption(app, "--output", raw.render,
            "picture to write: .exr (with all layers), .hdr .pfm (linear radiance), .png .jpg (tone-mapped, "
            "sRGB)")
      ->required();
  addOption(app, "--denoise", raw.render,
            "filter: " + joined(kFileFilterNames) +
                "; auto uses oidn if it is installed, otherwise variance, which needs the layers of --aov "
                "denoising");
  addFileFilterOptions(app, raw.render);
  addOption(app, "--exposure", raw.render);
  addOption(app, "--tone-map", raw.render);
  addOptions(app, OptionGroup::Encoding, raw.render);
}

DenoiseOptions finishDenoise(const RawDenoise& raw) {
  const RenderOptions render = finishRender(raw.render);
  if (render.output.denoise == Denoise::None)
    throw UsageError("--denoise: 'none' is none of " + joined(kFileFilterNames));
  checkEncoding(render.output.encoding, render.output.file);
  return {raw.picture, render};
}

}  // namespace fragtrace
