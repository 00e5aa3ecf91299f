// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "options/option_row.h"
#include "scene/parts.h"
#include "shader/render_options.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace fragtrace {

// The text of --add-light: "area at=0,2,1 to=0,0,0 size=1,0.5 power=50 color=1,0.9,0.8", "sun from=30,45".

/// Throws UsageError.
AddedLight addedLightIn(const std::string& text);

/// The text that is read as this light.
std::string textOf(const AddedLight& light);

// Words of a command line given to the option library, and its errors in the words of this program.

/// Numbers such as "-.5,0,1" look like short options to the library; a zero before the point settles it. And
/// --resolution, the word `before` it, may be written as 640x480.
std::string withNumberSettled(std::string argument, std::string_view before);

/// Gives a command its words, in their order, with numbers settled. Throws UsageError, which says where to
/// find `more`, and names the word that is not known with the one that was meant; without `more`, as for a
/// pasted text, it lists all such words in that order. Throws CLI::Success for --help and --version.
void parseWords(CLI::App& app, std::vector<std::string> words, const char* more = "");

/// The option that an unknown one probably means: what other programs call it, the same beginning, or similar
/// letters; empty if none is near. Names have their dashes, and the form of a value may follow.
std::string suggestedOption(const std::string& unknown, const std::vector<std::string>& known);

// The options of `render`, as commands declare, check and settle them.

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

/// --rendering-backend, --device, --buffer-reads, --vector-width, --shader-folder and --quiet, of commands
/// that choose all else themselves.
void addDeviceOptions(CLI::App& app, RawRender& raw);

/// Settles the options that depend on others, and checks that they go together. Throws UsageError.
RenderOptions finishRender(const RawRender& raw);

/// Throws UsageError where --ocio-display or another option of a view stands without --ocio-view.
void checkView(const OutputOptions& output);

/// Throws UsageError where the file's format has no such choice.
void checkEncoding(const Encoding& encoding, const std::filesystem::path& output);

/// Throws UsageError for options that a sequence does not go with.
void checkSequence(const RenderOptions& options);

// --config FILE.json: an object whose members are long option names without their dashes.

void addConfigOption(CLI::App& app, std::string& file);

/// Runs a parsed command with its settled options (finishRender()). An option of the file (none: an empty
/// path) counts unless the command line has given it, or one that excludes it. Names of files in it mean
/// what they mean on the command line. Returns the command's status. Throws InputError that names the file
/// and the line, or the member as a JSON pointer, also where `run` throws UsageError about an option of the
/// file; and what else `run` throws.
int runConfigured(RawRender& raw, const std::filesystem::path& config, CLI::App& command,
                  const std::function<int(const RenderOptions&)>& run);

/// Returns the settled options of a parsed command and of the file, for a caller that runs nothing yet;
/// throws as runConfigured(). `defaults` is another such file (none: an empty path), whose options count
/// where neither command line nor `config` has them; what they say of who lights the scene ends where those
/// do.
RenderOptions finishConfigured(RawRender& raw, const std::filesystem::path& config, CLI::App& command,
                               const std::filesystem::path& defaults = {});

}  // namespace fragtrace
