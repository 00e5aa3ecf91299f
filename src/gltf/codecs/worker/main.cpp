// SPDX-License-Identifier: MIT
// fragtrace_codecs: the libraries of compressed geometry in a process of its own, with limits that the loader
// sets.
#include "gltf/codecs/worker/decode.h"
#include "process/serve.h"

int main() {
  using namespace fragtrace;
  if (!isStartedByProgram("fragtrace_codecs")) return 2;
  answerRequests<CodecRequest, CodecReply>([](const CodecRequest& request, std::span<const uint8_t> input,
                                              std::span<uint8_t> output, CodecReply&) {
    request.codec == Codec::Draco ? decodeDraco(request, input, output)
                                  : decodeMeshopt(request, input, output);
  });
  return 0;
}
