// SPDX-License-Identifier: MIT
#include "session/picture/picture_parts.h"

#include <algorithm>

#include "base/errors.h"
#include "render/film.h"
#include "session/picture/picture_file.h"
#include "session/picture_memory.h"

namespace fragtrace {

std::vector<Region> dividedRegion(const Region& region, int mostSide, uint64_t mostPixels) {
  const uint64_t side = std::min(uint64_t(mostSide), mostPixels);
  const int width = int(std::min(uint64_t(region.size.x), side));
  const int height = int(std::min(mostPixels / uint64_t(width), uint64_t(mostSide)));
  std::vector<Region> parts;
  for (int y = 0; y < region.size.y; y += height) {
    for (int x = 0; x < region.size.x; x += width) {
      const glm::ivec2 corner(x, y);
      parts.push_back({region.corner + corner, glm::min(glm::ivec2(width, height), region.size - corner)});
    }
  }
  return parts;
}

std::vector<Region> partsOf(const RenderOptions& options, const LoadedScene& loaded) {
  const int mostSide = Film::mostSide();
  const glm::ivec2 size = loaded.region.size;
  const std::string what = std::to_string(size.x) + " x " + std::to_string(size.y) + " pixels";
  std::vector<Region> parts = dividedRegion(loaded.region, mostSide, mostFilmPixels(options, size));
  if (parts.size() > 1 && showsColors(options))
    throw UsageError("a picture of " + what +
                     " has to be drawn in parts here, and the scale of a debug view needs the whole; "
                     "--resolution or --region makes it smaller");
  if (parts.size() > 1 && options.light.reuse == LightReuse::Spatial)
    throw UsageError(
        "--light-reuse spatial: a picture of " + what +
        " has to be drawn in parts here (--memory-limit), and pixels take light from those about "
        "them; --resolution makes it smaller");
  if (std::max(size.x, size.y) > mostSide && options.output.denoise == Denoise::Variance)
    throw UsageError("--denoise variance: this driver filters at most " + std::to_string(mostSide) +
                     " pixels a side, and the picture has " + what);
  return parts;
}

View viewOf(const LoadedScene& loaded, const Region& part) {
  View view = loaded.view;
  if (part.size != loaded.size) view.placement = Placement{part.corner, loaded.size};
  return view;
}

void paste(const Image& part, glm::ivec2 corner, Image& picture) {
  const size_t row = size_t(part.width) * part.channelCount();
  for (int y = 0; y < part.height; ++y)
    std::copy_n(part.pixel(0, y), row, picture.pixel(corner.x, corner.y + y));
}

}  // namespace fragtrace
