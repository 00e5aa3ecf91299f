// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "shader/render_options.h"

namespace fragtrace {

/// A file to be written, and the option that says so. No path: not asked for.
struct NamedOutput {
  const char* option;
  std::filesystem::path path;
  bool orStandardOutput = false;  ///< "-" means standard output
};

/// Returns true if a path means standard output, for options that allow it.
bool isStandardOutput(const std::filesystem::path& path);

/// Must be called before long work. Throws RenderError when an output cannot be written, UsageError when one
/// is a file that is read, two are one file, or one is "-" and not for standard output.
void checkOutputs(std::span<const NamedOutput> outputs, std::span<const std::filesystem::path> inputs);

/// Makes a file hold this text, whole or not at all, or prints it where the path is that of standard output;
/// nothing when there is no path. Throws RenderError.
void replaceText(const std::filesystem::path& path, const std::string& text);

/// Returns the files that a render reads, except for the pictures to which the scene refers.
std::vector<std::filesystem::path> inputsOf(const RenderOptions& options);
/// Returns the pictures that the scene names, once it is loaded.
std::vector<std::filesystem::path> inputsOf(const Scene& scene);
/// Returns true if the output holds layers and attributes: an .exr, or memory if no file is named.
bool holdsLayers(const RenderOptions& options);
/// OUTPUT.checkpoint.
std::filesystem::path checkpointOf(const std::filesystem::path& output);
/// Returns true if a render that is stopped leaves a checkpoint.
bool keepsCheckpoint(const RenderOptions& options);
/// The files that a render writes.
std::vector<NamedOutput> outputsOf(const RenderOptions& options);

}  // namespace fragtrace
