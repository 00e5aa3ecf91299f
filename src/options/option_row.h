// SPDX-License-Identifier: MIT
// An option of `render`: one row of a table (optionRows()), from which its declaration, its text in
// commands and option files, and what has to be done again when it changes follow.
#pragma once

namespace CLI {
class App;
}

#include <functional>
#include <initializer_list>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "shader/render_options.h"
#include "shader/stage.h"

namespace fragtrace {

struct RawRender;

/// The earliest step that has to be done again for a picture of a scene when the option changes.
enum class Renewal : uint8_t {
  None,          ///< aim() and drawing
  Program,       ///< makeTracer(): the program, and what it reads of the scene
  Surroundings,  ///< the sky
  Surfaces,      ///< numbers of materials and lights; where they need other geometry, as a pose
  Pose,          ///< the same file in another pose: surroundings and light stay
  Scene          ///< loadScene()
};

/// The commands that have an option.
enum class OptionGroup : uint8_t {
  File,      ///< the scene and the picture, which each command declares by itself
  Tracing,   ///< all that draw
  Encoding,  ///< commands that write pictures
  Output,    ///< commands that write one picture at a time
  Sequence,  ///< commands that write numbered pictures
  Filter,    ///< commands that finish a picture
  None       ///< a member that another row's option sets, too
};

using AttributeValue = std::variant<bool, int, double, std::string>;

/// The properties of an option that do not depend on its type.
struct OptionTraits {
  Effect effect = Effect::Picture;
  Renewal renewal = Renewal::None;
  const char* attribute = nullptr;  ///< its name in the attribute fragtrace:settings, where it stands there
  bool copied = true;               ///< the option is in the command that the viewer copies
  bool kept = false;                ///< the viewer keeps its own when a command is pasted
  const char* excludes = nullptr;   ///< an option of an earlier row
  OptionGroup group = OptionGroup::Tracing;
};

/// Where help shows an option.
struct OptionHelp {
  const char* topic = nullptr;
  bool everyday = false;               ///< --help shows it, too, not --help all alone
  const char* metavariable = nullptr;  ///< what stands for its value; none: a word for the value's type
  const char* unit = nullptr;
};

struct OptionRow {
  const char* name = "";  ///< the name with its dashes
  std::string help{};
  OptionTraits traits{};
  OptionHelp shown{};
  std::vector<std::string> choices{};  ///< names that a value may be
  bool open = false;                   ///< a value may be something else, too
  std::vector<std::string>
      examples{};  ///< values, as one word each; none: a flag. The first and last of a range
  /// Declares the option, so that parsing sets its members. RawRender outlives the command.
  std::function<void(CLI::App&, const OptionRow&, RawRender&)> add{};
  std::function<bool(const RenderOptions&)> isDefault{};
  /// The value as the command line spells it, a word each time that the option is given; of a flag none.
  std::function<std::vector<std::string>(const RenderOptions&)> words{};
  std::function<void(RenderOptions& to, const RenderOptions& from)> copy{};  ///< its members
  std::function<AttributeValue(const RenderOptions&)>
      value{};  ///< its value as an attribute of the picture's file; may be empty
};

/// The row of the option. A name that there is not is an error of the program: std::logic_error.
const OptionRow& rowOf(std::string_view name);

/// Appends the option to a command, unless it is as by default.
void appendRow(std::string& text, const OptionRow& row, const RenderOptions& options);

/// The options, with all options and stages that have these effects as by default. A member without a row
/// counts as Effect::Picture and Renewal::Scene: it costs time, never a wrong picture. Stages have their
/// effects in stageRows().
RenderOptions withoutEffects(RenderOptions options, std::initializer_list<Effect> effects);

/// Keeps the options that makeTracer() and loadScene() read and aim() does not read again; all others get
/// their defaults.
RenderOptions programOptions(RenderOptions options);

/// The earliest step that has to be done again where options change; the later ones follow it.
Renewal renewalBetween(const RenderOptions& before, const RenderOptions& now);

/// Gives options the values of the others where this step would renew them; a later or an earlier one does
/// not count.
void takeStep(RenderOptions& options, const RenderOptions& from, Renewal step);

/// The same of pose and numbers.
void takePose(RenderOptions& options, const RenderOptions& from);

/// Returns true if they differ in an option of this very step.
bool differIn(Renewal step, const RenderOptions& a, const RenderOptions& b);

/// Returns true if both need the same program, for whatever pose and numbers of the same scene.
bool sameBesidePose(const RenderOptions& a, const RenderOptions& b);

/// All options of `render`, in the order of --help, in one list for each part of RenderOptions.
std::span<const OptionRow> optionRows();

std::vector<OptionRow> fileRows();  ///< the scene and the picture
std::vector<OptionRow> cameraRows();
std::vector<OptionRow> samplingRows();  ///< stages included
std::vector<OptionRow> lightRows();
std::vector<OptionRow> skyRows();
std::vector<OptionRow> fogRows();
std::vector<OptionRow> volumeRows();
std::vector<OptionRow> deviceRows();
std::vector<OptionRow> inputRows();
std::vector<OptionRow> outputRows();

}  // namespace fragtrace
