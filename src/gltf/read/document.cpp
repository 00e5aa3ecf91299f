// SPDX-License-Identifier: MIT
#include "gltf/read/document.h"

#include "base/errors.h"

namespace fragtrace {

std::span<const uint8_t> bytesOf(const Document& document, int bufferView) {
  document.diagnostics.need(pointerTo("bufferViews", bufferView));
  const tinygltf::BufferView& view = document.model.bufferViews.at(size_t(bufferView));
  if (view.byteLength == 0) return {};
  static const std::vector<unsigned char> kNone;
  const auto& buffers = document.model.buffers;
  const bool isThere = size_t(view.buffer) < buffers.size();
  const std::vector<unsigned char>& bytes = isThere ? buffers[size_t(view.buffer)].data : kNone;
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset) {
    document.diagnostics.lose(pointerTo("bufferViews", bufferView), "is used, but its buffer has no data");
  }
  return {bytes.data() + view.byteOffset, view.byteLength};
}

void takeMemory(Document& document, const std::string& place, uint64_t bytes) {
  document.diagnostics.attempt(place, [&] { document.memory.take(bytes); });
}

}  // namespace fragtrace
