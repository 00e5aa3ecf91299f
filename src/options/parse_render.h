// SPDX-License-Identifier: MIT
// The options of `render`, as commands declare, check and settle them.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "options/option_row.h"
#include "shader/render_options.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace fragtrace {

/// The most samples of a pixel: sample indices have 32 bits, targets of the film 30.
inline constexpr int kMostSamples = 1 << 29;

/// A value of --material-variant: each of them.
inline constexpr const char* kAllVariants = "all";

/// The options as a command has parsed them, and the words that finishRender() settles them by.
struct RawRender {
  RenderOptions options{};
  std::optional<int> spp{};
  std::string stage = "gi";
  std::vector<std::string> enable{};
  std::vector<std::string> disable{};
  /// The switches of --config; those of the command line take precedence.
  std::vector<std::string> fileEnable{};
  std::vector<std::string> fileDisable{};
  bool noDefaultLight = false;
  bool shop = false;
  std::set<std::string> given{};  ///< names of options, with dashes, of the command line or of --config
  bool hasQuality = false;        ///< pictures for the eye have a quality by default
  bool anyOutput = false;  ///< pictures get their names later, so what any format holds may be asked for
};

/// Declares the option of the row with that name.
CLI::Option* addOption(CLI::App& app, const char* name, RawRender& raw);

/// Does the same with a help text of the command's own.
CLI::Option* addOption(CLI::App& app, const char* name, RawRender& raw, const std::string& help);

/// Declares all options of a group, in the order of the table.
void addOptions(CLI::App& app, OptionGroup group, RawRender& raw);

/// --rendering-backend, --buffer-reads, --vector-width, --shader-folder and --quiet, of commands that choose
/// all else themselves.
void addDeviceOptions(CLI::App& app, RawRender& raw);

/// Settles the options that depend on others, and checks that they go together. Throws UsageError.
RenderOptions finishRender(const RawRender& raw);

/// Throws UsageError where the file's format has no such choice.
void checkEncoding(const Encoding& encoding, const std::filesystem::path& output);

/// Throws UsageError for options that a sequence does not go with.
void checkSequence(const RenderOptions& options);

}  // namespace fragtrace
