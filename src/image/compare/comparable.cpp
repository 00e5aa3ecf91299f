// SPDX-License-Identifier: MIT
#include "image/compare/comparable.h"

#include "base/errors.h"
#include "image/channels.h"

namespace fragtrace {
namespace {

std::string sizeText(const Image& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height);
}

}  // namespace

ColorReader colorReader(const Image& image, const char* which) {
  const auto channels = findColorChannels(image);
  if (!channels) throw RenderError(std::string("cannot compare: the ") + which + " has no colour channels");
  return {image, *channels};
}

size_t commonPixelCount(const Image& picture, const Image& reference) {
  if (picture.width != reference.width || picture.height != reference.height)
    throw RenderError("cannot compare: the sizes differ, " + sizeText(picture) + " against " +
                      sizeText(reference) + " pixels");
  return size_t(picture.width) * size_t(picture.height);
}

}  // namespace fragtrace
