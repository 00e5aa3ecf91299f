// SPDX-License-Identifier: MIT
// The lights of a scene that the viewer offers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "view/exchange.h"

namespace fragtrace {

/// Returns environment maps beside the scene and beside the one that lights it now, by name, at most
/// kMostEnvironments.
inline constexpr size_t kMostEnvironments = 200;
std::vector<std::filesystem::path> environmentsNear(const RenderOptions& options);

struct EnvironmentChoice {
  std::string name;
  std::filesystem::path file{};  ///< the environment map; empty: none
  bool studio = false;
  bool sky = false;
  DefaultLight light = DefaultLight::Studio;  ///< used if the scene has no light of its own

  bool operator==(const EnvironmentChoice&) const = default;
};

/// The scene's own light or what stands for it, the studio, and all files.
std::vector<EnvironmentChoice> environmentChoices(const ViewedScene& scene);

/// The index of the choice that lights the scene.
size_t currentChoice(const ViewedScene& scene, const std::vector<EnvironmentChoice>& choices);

/// The options with that light.
RenderOptions withEnvironment(RenderOptions options, const EnvironmentChoice& choice);

}  // namespace fragtrace
