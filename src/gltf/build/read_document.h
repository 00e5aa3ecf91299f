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

/// The document in the pose of the options: a copy for one that is kept for other poses, which lends buffers
/// and pictures to it, since they are large, until takeBack(). Throws InputError and UsageError.
Document posed(KeptDocument& read, bool isKept, const GltfOptions& options);
void takeBack(Document& lent, KeptDocument& kept);

}  // namespace fragtrace
