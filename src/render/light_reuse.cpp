// SPDX-License-Identifier: MIT
// The part of the renderer that keeps light samples for the pixels near them.
#include "render/renderer.h"

namespace fragtrace {

bool Renderer::keepLight(const Film& film, const View& view, int index, const std::function<bool()>& goOn) {
  constexpr int kSide = 256;  // pixels of a draw
  const std::optional<ShaderVariant> records = lightRecordVariant(variant_);
  if (!records) return true;
  const ShaderVariant camera = variant_;
  const glm::ivec2 size = film.size();
  if (!reservoirs_ || reservoirs_->size() != size) reservoirs_.emplace(size);
  reservoirs_->clear();
  variant_ = *records;
  View sample = view;
  sample.sampleOffset += index;
  setFrame(*reservoirs_, sample);
  bool complete = true;
  for (int y = 0; complete && y < size.y; y += kSide) {
    for (int x = 0; complete && x < size.x; x += kSide) {
      const glm::ivec2 corner(x, y);
      complete = drawTile(*reservoirs_, corner, glm::min(glm::ivec2(kSide), size - corner), 1, goOn);
    }
  }
  variant_ = camera;
  setFrame(film, view);
  reservoirs_->bindTextures(layout::kReservoirTextures);
  return complete;
}

}  // namespace fragtrace
