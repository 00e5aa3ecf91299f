// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>

#include "bvh/bvh.h"
#include "scene/describe.h"

namespace fragtrace {

/// Scene counts as `info --json` and `--stats` spell them.
nlohmann::ordered_json sceneJson(const SceneDescription& scene);
nlohmann::ordered_json bvhJson(const BvhQuality& bvh);

/// JSON text; bytes that are no UTF-8 (file names) are replaced, so that the text is always valid.
std::string jsonText(const nlohmann::ordered_json& json);

}  // namespace fragtrace
