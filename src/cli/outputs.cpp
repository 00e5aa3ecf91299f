// SPDX-License-Identifier: MIT
#include "cli/outputs.h"

#include "errors.h"
#include "image/whole_file.h"

namespace fragtrace {

namespace {

/// True when both names lead to one file, or to one place where none stands yet.
bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
  if (a.empty() || b.empty()) return false;
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error)) return true;
  return std::filesystem::weakly_canonical(a, error) == std::filesystem::weakly_canonical(b, error);
}

void refuseInput(const char* option, const std::filesystem::path& output,
                 const std::filesystem::path& input) {
  if (sameFile(output, input))
    throw UsageError(std::string(option) + ": " + output.string() + " is read by this render");
}

}  // namespace

void checkOutputs(const RenderOptions& options) {
  checkReplaceable(options.output);
  if (!options.statsFile.empty()) checkReplaceable(options.statsFile);
  if (sameFile(options.output, options.statsFile)) {
    throw UsageError("--stats: " + options.statsFile.string() + " is the picture's name, too");
  }
  for (const std::filesystem::path& input : {options.scene, options.hdriFile}) {
    refuseInput("--output", options.output, input);
    refuseInput("--stats", options.statsFile, input);
  }
}

void checkOutputs(const RenderOptions& options, const Scene& scene) {
  for (const EncodedImage& image : scene.images) {
    refuseInput("--output", options.output, image.name);
    refuseInput("--stats", options.statsFile, image.name);
  }
}

}  // namespace fragtrace
