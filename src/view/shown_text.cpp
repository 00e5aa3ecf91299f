// SPDX-License-Identifier: MIT
#include "view/shown_text.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <glm/glm.hpp>
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

}  // namespace

std::string shownText(std::string_view text, size_t most) {
  const std::vector<size_t> starts = characterStarts(text);
  const size_t count = starts.size() - 1;
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

}  // namespace fragtrace
