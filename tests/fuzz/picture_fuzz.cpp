// SPDX-License-Identifier: MIT
// libFuzzer's target over what is read of environments and textures in this process: headers, and .pfm as a
// whole. What the distribution's libraries decode, they decode in a process of their own.
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "image/files/header.h"
#include "image/files/pfm.h"
#include "image/limits.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    const fragtrace::ImageHeader header = fragtrace::readImageHeader({data, size});
    const int64_t pixels = int64_t(header.width) * header.height;
    if (header.width < 1 || header.height < 1 || header.channelCount < 1 ||
        pixels > fragtrace::kMaximumPixels)
      std::abort();
    if (header.format == fragtrace::ImageFormat::Pfm) {
      const fragtrace::Image image = fragtrace::decodePfm({data, size});
      if (image.values.size() != size_t(pixels) * image.channelCount()) std::abort();
    }
  } catch (const std::runtime_error&) {
    return 0;
  }
  return 0;
}
