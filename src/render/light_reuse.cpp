// SPDX-License-Identifier: MIT
// The part of the renderer that stores light samples for the pixels near them.
#include "render/renderer.h"

namespace fragtrace {

bool Renderer::keepLight(const Film& film, const View& view, int index, const GoOn& goOn) {
  constexpr glm::ivec2 kTile(256);  // pixels of a draw
  const std::optional<ShaderVariant> records = lightRecordVariant(pace_->drawn);
  if (!records) return true;
  const glm::ivec2 size = film.size();
  if (!reservoirs_ || reservoirs_->size() != size) reservoirs_.emplace(size);
  reservoirs_->clear();
  View sample = view;
  sample.sampleOffset += index;
  return drawPass({drawn(*records), *reservoirs_, sample, tilesOf({{0, 0}, size, 0, 1}, kTile)}, goOn);
}

}  // namespace fragtrace
