// SPDX-License-Identifier: MIT
// The pictures of textures and environment, which stay on the device and need not be packed again for the
// next picture of a sequence.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pack/gpu_scene.h"
#include "pack/textures/texture_plan.h"
#include "scene/scene.h"

namespace fragtrace {

struct KeptArrays {
  std::vector<std::pair<std::string, size_t>> images;  ///< names and sizes of the images packed
  TexturePlan textures;
  std::vector<PictureFacts> pictures;  ///< by the index of the scene's image; empty: none was packed
  const VolumeGrid* grid = nullptr;    ///< grid behind the arrays; it is only compared
  PackedGrid densities;
  struct KeptEnvironment {
    glm::ivec2 size{0};
    glm::ivec2 backdropSize{0};
    glm::vec3 upwardIrradiance{0.0f};
    double power = 0.0;
    int draws = 0;            ///< EnvironmentDraws
    bool forCatcher = false;  ///< upwardIrradiance is known
    bool light = false;       ///< appendEnvironmentLight()
    bool suns = false;        ///< appendSuns()
    double sunPower = 0.0;    ///< the part of the power of the sun that light paths begin at
  };
  std::optional<KeptEnvironment> environment;  ///< the environment map; a sequence has only one
  bool geometry = false;     ///< tree, leaves, faces and vertices are as packed before, as are all pictures
  std::vector<bool> cutOut;  ///< the triangles that the tree was packed without (cutOutTriangles)
};

}  // namespace fragtrace
