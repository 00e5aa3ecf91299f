// SPDX-License-Identifier: MIT
#include "options/stage_names.h"

#include "base/errors.h"
#include "options/choose.h"

namespace fragtrace {

std::vector<std::string> stageNames(bool cumulativeOnly) {
  std::vector<std::string> names;
  for (const StageRow& row : stageRows()) {
    if (row.cumulative || !cumulativeOnly) names.emplace_back(row.name);
  }
  return names;
}

Stage stageNamed(const char* option, const std::string& name) {
  const std::optional<Stage> stage = parseStage(name);
  if (!stage) throw UsageError(std::string(option) + ": " + whyNoneOf(name, stageNames(false)));
  return *stage;
}

}  // namespace fragtrace
