// SPDX-License-Identifier: MIT
#include "view/live/reference.h"

#include <algorithm>
#include <utility>

#include "base/errors.h"
#include "image/channels.h"

namespace fragtrace {

Image readReference(const std::filesystem::path& path, uint64_t memoryLimit) {
  LinearImage read = readLinearImage(path, memoryLimit);
  if (read.wasEncoded)
    throw InputError(path.string() +
                     ": holds the colours of a display; to compare with, an .exr, .hdr or .pfm "
                     "of linear radiance is needed");
  const Image whole = wholeOf(std::move(read.image));
  const auto color = findColorChannels(whole);
  if (!color) throw InputError(path.string() + ": has no colour");
  const auto alpha = std::ranges::find(whole.channels, "A");
  Image picture{whole.width, whole.height, {"R", "G", "B"}, {}, {}};
  if (alpha != whole.channels.end()) picture.channels.emplace_back("A");
  const size_t count = whole.channelCount();
  picture.values.reserve(whole.values.size() / count * picture.channelCount());
  for (size_t first = 0; first < whole.values.size(); first += count) {
    for (const size_t channel : *color) picture.values.push_back(whole.values[first + channel]);
    if (alpha != whole.channels.end())
      picture.values.push_back(whole.values[first + size_t(alpha - whole.channels.begin())]);
  }
  return picture;
}

}  // namespace fragtrace
