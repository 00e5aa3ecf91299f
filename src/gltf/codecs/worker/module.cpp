// SPDX-License-Identifier: MIT
// The worker's module for compressed geometry.
#include "base/worker/module.h"

#include "base/message.h"
#include "gltf/codecs/worker/decode.h"

namespace fragtrace {

extern "C" void fragtraceWork(std::span<const uint8_t> input, WorkOutput& output) {
  if (input.empty()) return;
  const auto request = takeMessage<CodecRequest>(input);
  if (request.codec == Codec::Draco)
    decodeDraco(request, input, output.room);
  else if (request.codec == Codec::DracoCounts)
    countDraco(input, output.room);
  else
    decodeMeshopt(request, input, output.room);
  output.used = output.room.size();
}

}  // namespace fragtrace
