// SPDX-License-Identifier: MIT
// A glTF file as tinygltf's model, with all references and byte ranges checked and all buffers in memory.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "gltf/diagnostics.h"

namespace fragtrace {

/// Where a picture is, as the file says: a URI as written, or a buffer view.
struct ImageSource {
  std::string uri;
  int bufferView = -1;
};

struct Document {
  explicit Document(std::string file) : diagnostics(std::move(file)) {}

  tinygltf::Model model;  ///< without skins and animations, which are not applied, and without pictures
  std::filesystem::path folder;  ///< what relative URIs start from
  std::vector<ImageSource> images;
  Diagnostics diagnostics;
};

/// The bytes of a buffer view. Throws InputError if its buffer has none, as a buffer without URI may.
std::span<const uint8_t> bytesOf(const Document& document, int bufferView);

/// Reads and checks the document; pictures beside it are not read yet. Throws InputError.
Document readDocument(const std::filesystem::path& path);

}  // namespace fragtrace
