// SPDX-License-Identifier: MIT
// libFuzzer's target over what is read of environments and textures in this process: headers, and .pfm as a
// whole. What the distribution's libraries decode, they decode in a process of their own. The decoder of
// KTX2, where it was built, works here: what it does with memory that is not its own shows.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "image/files/header.h"
#include "image/files/pfm.h"
#include "image/image.h"
#ifdef FRAGTRACE_FUZZ_KTX2
#include "base/message.h"
#include "base/worker/module.h"
#include "image/worker/message.h"

namespace {

void decodeKtx2(const fragtrace::ImageHeader& header, const uint8_t* data, size_t size) {
  using namespace fragtrace;
  static const bool isReady = [] {
    WorkOutput nothing;
    fragtraceWork({}, nothing);
    return true;
  }();
  constexpr int kMostTexels = 1 << 20;
  if (!isReady || header.width > kMostTexels / header.height) return;
  const PictureMessage request{.task = PictureTask::DecodeTexels,
                               .format = header.format,
                               .width = header.width,
                               .height = header.height,
                               .channelCount = header.channelCount,
                               .bits = header.texelBits};
  std::vector<uint8_t> input(sizeof request + size);
  std::memcpy(input.data(), &request, sizeof request);
  std::memcpy(input.data() + sizeof request, data, size);
  std::vector<uint8_t> room(size_t(header.width) * size_t(header.height) * 4);
  WorkOutput output{room};
  fragtraceWork(input, output);
  if (output.used != room.size()) std::abort();
}

}  // namespace
#endif

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    const fragtrace::ImageHeader header = fragtrace::readImageHeader({data, size});
    const int64_t pixels = int64_t(header.width) * header.height;
    if (header.width < 1 || header.height < 1 || header.channelCount < 1 ||
        pixels > fragtrace::kMaximumPixels)
      std::abort();
#ifdef FRAGTRACE_FUZZ_KTX2
    if (header.format == fragtrace::ImageFormat::Ktx2) decodeKtx2(header, data, size);
#endif
    if (header.format == fragtrace::ImageFormat::Pfm) {
      const fragtrace::Image image = fragtrace::decodePfm({data, size});
      if (image.values.size() != size_t(pixels) * image.channelCount()) std::abort();
    }
  } catch (const std::runtime_error&) {
    return 0;
  }
  return 0;
}
