// SPDX-License-Identifier: MIT
#pragma once

#include "gltf/gltf.h"
#include "gltf/read/document.h"

namespace fragtrace {

/// Reads and checks the document; pictures beside it are not read yet. Throws InputError.
Document readDocument(const std::filesystem::path& path, const GltfOptions& options);

}  // namespace fragtrace
