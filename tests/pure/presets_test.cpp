// SPDX-License-Identifier: MIT
#include "view/shown_text.h"

#include <gtest/gtest.h>

namespace fragtrace {
namespace {

TEST(Presets, AreToldByTheStagesThatBuildOnEachOther) {
  for (const Preset& preset : kPresets) {
    StageSet stages = stagesUpTo(preset.last);
    EXPECT_EQ(presetName(stages), preset.name);
    stages.flip(size_t(Stage::Sobol));
    EXPECT_EQ(presetName(stages), preset.name);
    stages.reset(size_t(Stage::Phong));
    EXPECT_FALSE(isPreset(stages, preset));
  }
  EXPECT_EQ(presetName(stagesUpTo(Stage::Shadows)), "Shadows");
}

}  // namespace
}  // namespace fragtrace
