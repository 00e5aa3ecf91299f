// SPDX-License-Identifier: MIT
#include "session/outputs.h"

#include <cstdio>

#include "base/errors.h"
#include "image/files/whole_file.h"
#include "image/format.h"

namespace fragtrace {

namespace {

/// True when both names lead to one file, or to one place where none stands yet.
bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
  if (a.empty() || b.empty()) return false;
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error)) return true;
  return std::filesystem::weakly_canonical(a, error) == std::filesystem::weakly_canonical(b, error);
}

}  // namespace

bool isStandardOutput(const std::filesystem::path& path) { return path == "-"; }

void checkOutputs(std::span<const NamedOutput> outputs, std::span<const std::filesystem::path> inputs) {
  for (const NamedOutput& output : outputs) {
    if (isStandardOutput(output.path)) {
      if (output.orStandardOutput) continue;
      throw UsageError(std::string(output.option) + ": '-' is no file, and standard output does not take it");
    }
    if (!output.path.empty()) checkReplaceable(output.path);
    const std::string name = std::string(output.option) + ": " + output.path.string();
    for (const std::filesystem::path& input : inputs) {
      if (sameFile(output.path, input)) throw UsageError(name + " is read by this command");
    }
    for (const NamedOutput& other : outputs) {
      if (&other != &output && sameFile(output.path, other.path))
        throw UsageError(name + " is the file of " + other.option + ", too");
    }
  }
}

void replaceText(const std::filesystem::path& path, const std::string& text) {
  if (isStandardOutput(path)) {
    std::fputs(text.c_str(), stdout);  // main() sees whether it could be written
  } else if (!path.empty()) {
    replaceFile(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  }
}

std::vector<std::filesystem::path> inputsOf(const RenderOptions& options) {
  return {options.scene, options.light.hdriFile, options.volume.file};
}

std::vector<std::filesystem::path> inputsOf(const Scene& scene) {
  std::vector<std::filesystem::path> inputs;
  for (const EncodedImage& image : scene.images) inputs.emplace_back(image.name);
  return inputs;
}

bool holdsLayers(const RenderOptions& options) {
  return options.output.file.empty() || formatOfName(options.output.file) == ImageFormat::OpenExr;
}

std::filesystem::path checkpointOf(const std::filesystem::path& output) {
  return std::filesystem::path(output) += ".checkpoint";
}

bool keepsCheckpoint(const RenderOptions& options) {
  return options.output.checkpointSeconds > 0.0 || options.output.resume;
}

std::vector<NamedOutput> outputsOf(const RenderOptions& options) {
  std::vector<NamedOutput> outputs = {{"--stats", options.output.statsFile, true},
                                      {"--trace-file", options.output.traceFile},
                                      {"--shader-text", options.output.shaderText}};
  if (!options.output.toStandardOutput) outputs.push_back({"--output", placeOf(options.output)});
  if (keepsCheckpoint(options)) outputs.push_back({"--checkpoint", checkpointOf(options.output.file)});
  return outputs;
}

}  // namespace fragtrace
