// SPDX-License-Identifier: MIT
// Text from anywhere, as it may be drawn: Dear ImGui ends the program over a line of 16,384 characters.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "base/text.h"
#include "shader/stage.h"
#include "view/exchange.h"

namespace fragtrace {

inline constexpr size_t kMostNameCharacters = 60;  ///< characters of one name among others
inline constexpr size_t kMostLineCharacters = 400;
inline constexpr size_t kMostPageCharacters = 4000;

/// Returns the text if it has at most `most` characters (UTF-8); else its beginning and its end, with what is
/// left out counted between them. Other control characters than line feeds become spaces.
std::string shownText(std::string_view text, size_t most);

/// The characters (UTF-8) beyond Latin-1 that shownText() has returned so far: the font has to have them.
const std::set<std::string>& shownCharacters();

/// Text for the command line, as a window says it: with the names of controls instead of those of options. An
/// option alone in brackets, " (--option)", is left out if there is no control for it.
std::string withControls(const std::string& text);

/// "distance 5 m: x 3, y 0, z -4", of places in metres.
std::string distanceText(const glm::dvec3& from, const glm::dvec3& to);

// Names that the viewer makes of a scene's.

/// The window's title, of limited length; without a scene it is the program's name.
std::string windowTitle(const std::filesystem::path& scene);

/// The first of SCENE-1.png, SCENE-2.png, ... that no file in the folder has.
std::filesystem::path freePictureName(const std::filesystem::path& folder, const std::filesystem::path& scene,
                                      const char* extension);
/// Does the same in the current folder, as a name without a folder.
std::filesystem::path freePictureName(const std::filesystem::path& scene, const char* extension);

// Named sets of stages, for users who do not want to choose each one.

struct Preset {
  const char* name;
  Stage last;  ///< it and all cumulative stages before it
  const char* sentence;
};

inline constexpr std::array kPresets{
    Preset{"Preview", Stage::Phong,
           "Blinn-Phong shading without shadows: the fastest picture that shows the shape"},
    Preset{"Phong", Stage::NormalMaps, "Blinn-Phong with shadows, mirrors, glass and normal maps"},
    Preset{"Path traced", Stage::Gi, "physically based materials and light: noisy at first, then exact"}};

/// Returns true if the cumulative stages are those of the preset; other switches do not matter.
bool isPreset(const StageSet& stages, const Preset& preset);

/// The preset's name, or that of the last stage that is on.
std::string presetName(const StageSet& stages);

// The progress of a side of the viewer towards the goal that its options set, and how long it will take.

struct ViewProgress {
  double fraction = 0.0;          ///< share of the samples or the time of the nearest goal, 0 to 1
  std::optional<double> seconds;  ///< left until then, if that can be told
};

/// The goals are samples, seconds and the relative error, which falls as 1 / sqrt(samples) (numbers.md);
/// the first to be reached counts. `share`: of the time that this side gets, 1 or, next to another, 0.5.
/// Seconds until the error's goal are told in its last ten minutes only: nobody waits for more.
ViewProgress progressOf(const SideStatistics& side, const RenderOptions& options, double share);

/// One or two words for the progress. They call no picture unfinished, since each sample only improves it.
std::string progressText(const SideStatistics& side, const RenderOptions& options);

/// "1 sample", "12 samples".
std::string samplesText(int samples);

/// "12 s", "3 min 20 s", "2 h 5 min".
std::string durationText(double seconds);

// The messages of the viewer: each text once, for some seconds.

struct Message {
  std::string text;
  double latest = 0.0;  ///< the time of the latest repetition, seconds
  bool closed = false;
};

/// The latest last; at most 16, older ones are forgotten.
using MessageList = std::deque<Message>;

/// A text that is there already moves to the end. "wrote FILE" takes the place of "writing FILE ...".
void addMessage(MessageList& messages, const std::string& text, double now);

void closeMessages(MessageList& messages);

/// Returns true if that text is there, and still seen.
bool isSeen(const MessageList& messages, const std::string& text, double now);

/// The opacity of a message, 0..1: it fades in steps, which cost one frame each.
double opacityOf(const Message& message, double now);

/// Seconds until one of them is seen less; infinite when none is seen.
double secondsToFade(const MessageList& messages, double now);

}  // namespace fragtrace
