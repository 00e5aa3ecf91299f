// SPDX-License-Identifier: MIT
// The part of the renderer that stores light samples for the pixels near them.
#include "render/renderer.h"

namespace fragtrace {

bool Renderer::storeReservoirs(const Film& film, const View& view, int index, const GoOn& goOn) {
  const std::optional<ShaderVariant> records = reservoirVariant(pace_->drawn);
  if (!records) return true;
  const glm::ivec2 size = film.size();
  const glm::ivec2 tile(software_ ? 256 : 2048);  // pixels of a draw
  if (!reservoirs_ || reservoirs_->size() != size) reservoirs_.emplace(size);
  reservoirs_->clear();
  View sample = view;
  sample.sampleOffset += index;
  return drawPass({drawn(*records), *reservoirs_, sample, tilesOf({{0, 0}, size, 0, 1}, tile)}, goOn);
}

}  // namespace fragtrace
