// SPDX-License-Identifier: MIT
#include "view/presets.h"

namespace fragtrace {

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

}  // namespace fragtrace
