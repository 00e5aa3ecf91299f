// SPDX-License-Identifier: MIT
#include "view/shown_text.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <regex>
#include <utility>
#include <vector>

namespace fragtrace {

namespace {

/// The place at which each character begins, and the end; a byte that no character can hold is one of its
/// own.
std::vector<size_t> characterStarts(std::string_view text) {
  const auto continues = [&](size_t i) { return (static_cast<unsigned char>(text[i]) & 0xc0u) == 0x80u; };
  std::vector<size_t> starts;
  for (size_t i = 0; i < text.size(); ++i) {
    const bool isPart = continues(i) && !starts.empty() && i - starts.back() < 4;
    if (!isPart) starts.push_back(i);
  }
  starts.push_back(text.size());
  return starts;
}

constexpr unsigned char kBeyondLatin1 = 0xc4;  // the first byte of U+0100, and of no character before

/// The controls of the panel, as it names them, and their options.
constexpr std::array<std::pair<std::string_view, std::string_view>, 26> kControls{{
    {"--animation", "Clip"},
    {"--animation-time", "Time"},
    {"--background", "Background"},
    {"--bounces", "Bounces"},
    {"--camera-type", "Projection"},
    {"--camera-view-angle", "View angle"},
    {"--clamp-indirect", "Clamp indirect"},
    {"--debug-view", "Show"},
    {"--denoise", "Denoise"},
    {"--exposure", "Exposure"},
    {"--f-stop", "Depth of field"},
    {"--fog-anisotropy", "Fog forward"},
    {"--fog-density", "Fog"},
    {"--fog-height", "Fog height"},
    {"--hdri-file", "Environment"},
    {"--hdri-intensity", "Intensity"},
    {"--hdri-rotation", "Rotation"},
    {"--noise", "Noise to reach"},
    {"--pixel-filter", "Pixel filter"},
    {"--shadow-catcher", "Shadow catcher"},
    {"--sky", "Sky"},
    {"--sky-turbidity", "Haze"},
    {"--studio", "Studio"},
    {"--sun-azimuth", "Sun from"},
    {"--sun-elevation", "Sun height"},
    {"--traversal", "Traversal"},
}};

std::set<std::string>& charactersSoFar() {
  static std::set<std::string> characters;
  return characters;
}

constexpr int kNoSampleGoal = 1 << 24;  // above, samples are limited by their number alone
constexpr double kLongest = 99.0 * 3600.0;
constexpr double kLongestForNoise = 600.0;

}  // namespace

std::string shownText(std::string_view text, size_t most) {
  const std::vector<size_t> starts = characterStarts(text);
  const size_t count = starts.size() - 1;
  for (size_t i = 0; i < count; ++i) {
    if (static_cast<unsigned char>(text[starts[i]]) >= kBeyondLatin1)
      charactersSoFar().emplace(text.substr(starts[i], starts[i + 1] - starts[i]));
  }
  std::string shown(text);
  if (count > most) {
    const size_t tail = most / 4;
    const size_t head = most - tail;
    shown = text.substr(0, starts[head]);
    shown += " ... (" + std::to_string(count - most) + " characters) ... ";
    shown += text.substr(starts[count - tail]);
  }
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < ' ' && c != '\n') c = ' ';
  }
  return shown;
}

const std::set<std::string>& shownCharacters() { return charactersSoFar(); }

std::string withControls(const std::string& text) {
  static const std::regex option(R"((^|[ (])(--[a-z-]+))");
  static const std::regex alone(R"( \(--[a-z-]+\))");
  std::string shown;
  auto rest = text.begin();
  for (std::sregex_iterator found(text.begin(), text.end(), option); found != std::sregex_iterator();
       ++found) {
    const auto& name = (*found)[2];
    const auto* control = std::ranges::find(kControls, std::string_view(name.first, name.second),
                                            &std::pair<std::string_view, std::string_view>::first);
    shown.append(rest, name.first);
    shown += control == kControls.end() ? name.str() : std::string(control->second);
    rest = name.second;
  }
  shown.append(rest, text.end());
  return std::regex_replace(shown, alone, "");
}

std::string distanceText(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 way = to - from;
  return formatted("distance %.4g m: x %.4g, y %.4g, z %.4g", glm::length(way), way.x, way.y, way.z);
}

std::string windowTitle(const std::filesystem::path& scene) {
  if (scene.empty()) return "fragtrace";
  return "fragtrace: " + shownText(scene.filename().string(), kMostNameCharacters);
}

std::filesystem::path freePictureName(const std::filesystem::path& scene, const char* extension) {
  return freePictureName({}, scene, extension);
}

std::filesystem::path freePictureName(const std::filesystem::path& folder, const std::filesystem::path& scene,
                                      const char* extension) {
  for (int i = 1;; ++i) {
    std::filesystem::path path = folder / (scene.stem().string() + "-" + std::to_string(i) + extension);
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return path;
  }
}

bool isPreset(const StageSet& stages, const Preset& preset) {
  for (const StageRow& row : stageRows()) {
    if (row.cumulative && has(stages, row.stage) != (int(row.stage) <= int(preset.last))) return false;
  }
  return true;
}

std::string presetName(const StageSet& stages) {
  for (const Preset& preset : kPresets) {
    if (isPreset(stages, preset)) return preset.name;
  }
  std::string name;
  for (const StageRow& row : stageRows()) {
    if (row.cumulative && has(stages, row.stage)) name = row.label;
  }
  return name;
}

ViewProgress progressOf(const SideStatistics& side, const RenderOptions& options, double share) {
  ViewProgress progress;
  if (side.resting) return {1.0, 0.0};
  if (side.samples <= 0) return progress;
  double longest = 0.0;  // longer times to the nearest goal are not shown
  const auto goal = [&](double fraction, double told) {
    if (fraction > progress.fraction) longest = told;
    progress.fraction = std::max(progress.fraction, std::clamp(fraction, 0.0, 1.0));
  };
  if (options.sampling.spp < kNoSampleGoal) goal(double(side.samples) / options.sampling.spp, kLongest);
  if (options.sampling.seconds > 0.0) goal(side.seconds / options.sampling.seconds, kLongest);
  if (options.sampling.noise > 0.0 && side.error > 0.0) {
    const double ratio = options.sampling.noise / side.error;
    goal(ratio * ratio, kLongestForNoise);
  }
  if (progress.fraction <= 0.0) return progress;
  const double seconds = side.seconds * (1.0 / progress.fraction - 1.0) / share;
  if (seconds <= longest) progress.seconds = seconds;
  return progress;
}

std::string progressText(const SideStatistics& side, const RenderOptions& options) {
  if (!side.resting) return side.samples > 0 ? "refining" : "drawing";
  const bool clean = side.error >= 0.0 && side.error <= options.sampling.noise;
  return options.sampling.noise > 0.0 && clean ? "clean enough" : "finished";
}

std::string samplesText(int samples) {
  return std::to_string(samples) + (samples == 1 ? " sample" : " samples");
}

std::string durationText(double seconds) {
  const long whole = std::lround(std::ceil(std::max(seconds, 0.0)));
  if (whole < 60) return std::to_string(whole) + " s";
  const auto two = [](long a, const char* unitA, long b, const char* unitB) {
    return std::to_string(a) + unitA + std::to_string(b) + unitB;
  };
  if (whole < 3600) return two(whole / 60, " min ", whole % 60, " s");
  return two(whole / 3600, " h ", whole / 60 % 60, " min");
}

namespace {

constexpr size_t kMostMessages = 16;
constexpr double kWholeSeconds = 10.0;
constexpr double kStepSeconds = 0.1;
constexpr int kSteps = 5;
const std::string kWrote = "wrote ";
const std::string kWriting = "writing ";

/// Steps that have been taken, from 0 (all of it is seen) to kSteps (nothing is).
int stepsOf(const Message& message, double now) {
  if (message.closed) return kSteps;
  const double fading = now - message.latest - kWholeSeconds;
  return std::clamp(int(std::floor(fading / kStepSeconds)) + 1, 0, kSteps);
}

}  // namespace

void addMessage(MessageList& messages, const std::string& text, double now) {
  const std::string promise = text.starts_with(kWrote) ? kWriting + text.substr(kWrote.size()) : "";
  std::erase_if(messages, [&](const Message& message) {
    return message.text == text || (!promise.empty() && message.text.starts_with(promise));
  });
  messages.push_back({.text = text, .latest = now});
  if (messages.size() > kMostMessages) messages.pop_front();
}

void closeMessages(MessageList& messages) {
  for (Message& message : messages) message.closed = true;
}

double opacityOf(const Message& message, double now) { return 1.0 - double(stepsOf(message, now)) / kSteps; }

bool isSeen(const MessageList& messages, const std::string& text, double now) {
  return std::ranges::any_of(messages,
                             [&](const Message& m) { return m.text == text && stepsOf(m, now) < kSteps; });
}

double secondsToFade(const MessageList& messages, double now) {
  double least = std::numeric_limits<double>::infinity();
  for (const Message& message : messages) {
    const int steps = stepsOf(message, now);
    if (steps == kSteps) continue;
    least = std::min(least, message.latest + kWholeSeconds + kStepSeconds * steps - now);
  }
  return std::max(least, 0.0);
}

}  // namespace fragtrace
