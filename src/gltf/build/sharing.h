// SPDX-License-Identifier: MIT
// The meshes that the scene holds once, in place of a copy for each time that they stand in it.
#pragma once

#include <cstdint>

#include "gltf/build/flatten.h"

namespace fragtrace {

/// The bytes that a scene takes while it is loaded, built and packed.
struct SharingCost {
  uint64_t flat = 0;    ///< every mesh copied for each time that it stands in the scene
  uint64_t shared = 0;  ///< meshes shared where that is less
};

/// Rays take longer through two trees than through one: sharing must save half of more than 64 MiB, or be
/// what stays within `limit`.
bool paysToShare(const SharingCost& cost, uint64_t limit);

struct PlacedMeshes {
  std::vector<PrimitiveInstance> flat;
  std::vector<MeshToShare> shared;
  uint64_t bytes = 0;  ///< memory that they take
  std::string reason;  ///< reason in a few words
  std::string copies;  ///< repeated meshes that cannot be shared; may be empty
};

/// Decides which meshes are copied and which are shared. Meshes that shine are copied, since their triangles
/// are lights. So are meshes so flat or so unevenly scaled that rounding shows (docs/design/numerics.md).
PlacedMeshes chooseSharing(std::vector<PrimitiveInstance> instances, Instancing wanted,
                           const std::vector<Material>& materials, uint64_t limit);

}  // namespace fragtrace
