// SPDX-License-Identifier: MIT
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gltf/gltf.h"
#include "gltf/read/container.h"
#include "gltf/read/diagnostics.h"
#include "gltf/read/motion.h"
#include "image/image.h"

namespace fragtrace {

// A glTF file as tinygltf's model, with all references and byte ranges checked and all buffers in memory.

/// The place of a picture as the file gives it: a URI as written, or a buffer view.
struct ImageSource {
  std::string uri;
  int bufferView = -1;
  std::string mimeType;
  std::vector<uint8_t> bytes{};  ///< content of the URI, with Document::keepsPictures; empty until it is read
};

struct Document {
  Document(std::string file, const InputLimits& limits)
      : diagnostics(std::move(file)),
        textureSide(limits.textureSide),
        drawMissingTextures(limits.drawMissingTextures),
        memory(limits.memoryBytes) {}

  tinygltf::Model model;  ///< the document without skins, animations and pictures
  FileAccess access;
  GltfProgress progress{};  ///< reports this load; a document that is kept has none
  std::vector<ImageSource> images;
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

/// Counts memory that `place` asks for. Throws InputError if it is too much.
void takeMemory(Document& document, const std::string& place, uint64_t bytes);

// Reads extensions and extras, which tinygltf passes on as generic values. The schema has checked their
// types.

/// The member of that name, or a null value where there is none.
inline const tinygltf::Value& memberOf(const tinygltf::Value& object, std::string_view name) {
  static const tinygltf::Value kNone;
  const std::string key(name);
  return object.Has(key) ? object.Get(key) : kNone;
}

inline double numberOf(const tinygltf::Value& object, std::string_view name, double otherwise) {
  const tinygltf::Value& member = memberOf(object, name);
  return member.IsNumber() ? member.GetNumberAsDouble() : otherwise;
}

inline std::vector<double> numbersOf(const tinygltf::Value& object, std::string_view name,
                                     std::vector<double> otherwise) {
  const tinygltf::Value& member = memberOf(object, name);
  if (!member.IsArray()) return otherwise;
  std::vector<double> numbers;
  numbers.reserve(member.ArrayLen());
  for (int i = 0; i < int(member.ArrayLen()); ++i) numbers.push_back(member.Get(i).GetNumberAsDouble());
  return numbers;
}

}  // namespace fragtrace
