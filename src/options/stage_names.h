// SPDX-License-Identifier: MIT
// Names of stages, as options spell them.
#pragma once

#include <string>
#include <vector>

#include "shader/stage.h"

namespace fragtrace {

/// Returns the names in the order of stageRows(). `cumulativeOnly`: only those that --stage takes.
std::vector<std::string> stageNames(bool cumulativeOnly);

/// Throws UsageError.
Stage stageNamed(const char* option, const std::string& name);

}  // namespace fragtrace
