// SPDX-License-Identifier: MIT
#include "options/encoding_options.h"

#include <CLI/CLI.hpp>

#include "errors.h"
#include "image/format.h"

namespace fragtrace {

void addHalfOption(CLI::App& app, Encoding& encoding) {
  app.add_flag(
      "--half", encoding.half,
      "store the colours, normals and roughness of an .exr as 16-bit floats, for about half the file size; "
      "all other layers keep 32 bits; values beyond 65504 are clamped");
}

void addPngDepthOption(CLI::App& app, Encoding& encoding) {
  app.add_option("--png-depth", encoding.pngBits, "bits per channel of a .png: 8, 16")
      ->check(CLI::IsMember({8, 16}))
      ->capture_default_str();
}

void checkEncoding(const Encoding& encoding, const std::filesystem::path& output) {
  const auto format = formatOfName(output);
  if (encoding.half && format != ImageFormat::OpenExr)
    throw UsageError("--half: only .exr files hold 16-bit floats");
  if (encoding.pngBits != Encoding().pngBits && format != ImageFormat::Png)
    throw UsageError("--png-depth: '" + output.string() + "' is no .png");
}

}  // namespace fragtrace
