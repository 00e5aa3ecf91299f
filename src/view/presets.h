// SPDX-License-Identifier: MIT
// Named sets of stages, for users who do not want to choose each one.
#pragma once

#include <array>
#include <string>

#include "shader/stage.h"

namespace fragtrace {

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

}  // namespace fragtrace
