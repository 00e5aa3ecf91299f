// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "gltf/gltf.h"
#include "gltf/read/document.h"
#include "gltf/read/motion.h"

namespace fragtrace {

struct KeptDocument {
  Document document;  ///< the file as it stands, not posed
  nlohmann::json root;
  std::vector<Animation> animations;
  std::vector<float> keyTimes = {};  ///< key times of the latest pose, in any order
};

/// Reads and checks the document; pictures beside it are not read yet. Throws InputError.
KeptDocument readDocument(const std::filesystem::path& path, const GltfOptions& options);

/// The document in the pose of the options. Throws InputError and UsageError.
Document posed(KeptDocument read, const GltfOptions& options);

/// A copy for posed(). It takes buffers and pictures with it, since they are large: takeBack() returns them.
KeptDocument lend(KeptDocument& kept);
void takeBack(Document& lent, KeptDocument& kept);

}  // namespace fragtrace
