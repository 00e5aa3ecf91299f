// SPDX-License-Identifier: MIT
#include "gltf/codecs/compression.h"

#include "advice.h"
#include "base/message.h"

namespace fragtrace {

const WorkerKind kGeometryCodecs{"libfragtrace_geometry.so", "the library that decodes it", kCodecAdvice, ""};

std::vector<uint8_t> decodeByProcess(Worker& codecs, const CodecRequest& request,
                                     std::span<const uint8_t> encoded) {
  // Draco's tables of corners take some hundred bytes for a triangle whose output is 24 bytes.
  constexpr uint64_t kLibraries = uint64_t(256) << 20;
  constexpr uint64_t kOfAByte = 64;
  constexpr uint64_t kBytesASecond = 5'000'000;
  const uint64_t bytes = encoded.size() + request.outputBytes;
  const WorkResult result = codecs.perform(
      {asMessage(request), encoded}, request.outputBytes,
      {.memoryBytes = kLibraries + kOfAByte * bytes, .cpuSeconds = unsigned(2 + bytes / kBytesASecond)});
  return {result.output.begin(), result.output.end()};
}

}  // namespace fragtrace
