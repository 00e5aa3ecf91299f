// SPDX-License-Identifier: MIT
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gltf/gltf.h"
#include "gltf/read/container.h"
#include "gltf/read/diagnostics.h"
#include "gltf/read/json.h"
#include "image/image.h"

namespace fragtrace {

// A glTF file as tinygltf's model, with all references and byte ranges checked and all buffers in memory.

/// The bytes of the document's buffers, in its order. A buffer without data is empty.
using Buffers = std::vector<std::vector<uint8_t>>;

/// The place of a picture as the file gives it: a URI as written, or a buffer view.
struct ImageSource {
  std::string uri;
  int bufferView = -1;
  std::vector<uint8_t> bytes{};  ///< content of the URI, with Document::keepsPictures; empty until it is read
};

/// The bytes that all poses of a file share.
struct FileBytes {
  Buffers buffers;
  std::vector<ImageSource> images;
};

/// glTF 2.0, section 3.7.3: indices of nodes, and of an accessor of one matrix a joint.
struct Skin {
  std::vector<int> joints;
  int inverseBindMatrices = -1;  ///< none: all are the identity
};

struct Document {
  Document(std::string file, const InputLimits& limits)
      : diagnostics(std::move(file)),
        textureSide(limits.textureSide),
        drawMissingTextures(limits.drawMissingTextures),
        memory(limits.memoryBytes) {}

  /// The JSON that all poses of a file share but for numbers: materials, lights, and all extensions and
  /// extras are read from it. It has no skins and animations any more.
  std::shared_ptr<nlohmann::json> root = nullptr;
  tinygltf::Model model = {};  ///< the geometry, nodes, cameras and textures in it
  std::shared_ptr<FileBytes> bytes = std::make_shared<FileBytes>();
  FileAccess access;
  GltfProgress progress{};      ///< reports this load; a document that is kept has none
  std::vector<size_t> strides;  ///< bytes between elements by buffer view; 0: they are packed
  std::vector<Skin> skins;
  std::vector<std::string> sceneNames, animationNames, materialVariants;
  std::vector<std::optional<double>> animationSeconds;  ///< as in Scene
  /// Key times of the animation that poses the document.
  std::vector<float> keyTimes;
  Diagnostics diagnostics;
  int textureSide;             ///< larger pictures are scaled down
  bool drawMissingTextures;    ///< pictures that cannot be read are warned of
  bool refersToFiles = false;  ///< buffers or pictures are other files
  Making made;
  bool keepsPictures = false;  ///< their bytes are read once for all poses
  MemoryBudget memory;         ///< memory that loading may still take
};

/// The bytes of a buffer view. Throws a Loss if its buffer has none, as a buffer without URI may.
std::span<const uint8_t> bytesOf(const Document& document, int bufferView);

/// The JSON of an element of one of its arrays.
inline const nlohmann::json& jsonOf(const Document& document, const char* array, int index) {
  return document.root->at(array).at(size_t(index));
}

/// Counts memory that `place` asks for. Throws InputError if it is too much.
void takeMemory(Document& document, const std::string& place, uint64_t bytes);

}  // namespace fragtrace
