// SPDX-License-Identifier: MIT
// The worker's module for pictures.
#include "base/worker/module.h"

#include <stdexcept>

#include "base/message.h"
#include "image/worker/library.h"
#include "image/worker/message.h"

namespace fragtrace {
namespace {

using Bytes = std::span<const uint8_t>;

void decodeFloatsInto(WorkOutput& output, const PictureMessage& request, Bytes input) {
  const Image image = decodeFloats(input, request.format);
  const glm::ivec2 size(image.width, image.height);
  if ((image.placement ? image.placement->whole : size) != glm::ivec2(request.width, request.height) ||
      int(image.channelCount()) > request.channelCount)
    throw std::runtime_error("its size is not what its header says");
  const PictureMessage reply = messageOf(image, request.task, request.format, 0);
  output.append(asMessage(reply));
  output.append(asBytes(image.values));
  output.append(textsOf(image, 0));
}

void decodeTexelsInto(WorkOutput& output, const PictureMessage& request, Bytes input) {
  decodeTexels(input, request.format, request.width, request.height, request.bits, output.room);
  output.used = output.room.size();
}

std::vector<uint8_t> encodedFloats(const PictureMessage& request, Bytes input) {
  const SentImage sent = takeImage(request, input);
  return encodeFloats(sent.image, sent.values, sent.halves, request.format);
}

void showInto(WorkOutput& output, const PictureMessage& request, Bytes input) {
  SentImage sent = takeImage(request, input);
  sent.image.values.assign(sent.values.begin(), sent.values.end());
  showByView(sent.image);
  output.append(asBytes(sent.image.values));
}

}  // namespace

extern "C" void fragtraceWork(Bytes input, WorkOutput& output) {
  if (input.empty()) return openImageLibrary();
  const auto request = takeMessage<PictureMessage>(input);
  switch (request.task) {
    case PictureTask::DecodeFloats:
      return decodeFloatsInto(output, request, input);
    case PictureTask::DecodeTexels:
      return decodeTexelsInto(output, request, input);
    case PictureTask::EncodeBytes:
      return output.append(encodeBytes(request.width, request.height, request.channelCount, request.bits,
                                       input, request.format));
    case PictureTask::EncodeFloats:
      return output.append(encodedFloats(request, input));
    case PictureTask::ShowByView:
      return showInto(output, request, input);
  }
}

}  // namespace fragtrace
