// SPDX-License-Identifier: MIT
// fragtrace_imageio: the image library in a process of its own, with limits that the program sets.
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

#include "image/worker/messages.h"
#include "image/worker/openimageio.h"
#include "process/serve.h"

namespace fragtrace {
namespace {

/// Where a task's result goes, and how much of it is used.
struct Output {
  std::span<uint8_t> room;
  uint64_t used = 0;

  void append(std::span<const uint8_t> bytes) {
    if (bytes.size() > room.size() - used) throw std::runtime_error("it is larger than what its header says");
    std::copy(bytes.begin(), bytes.end(), room.begin() + std::ptrdiff_t(used));
    used += bytes.size();
  }
};

std::span<const uint8_t> bytesOf(std::span<const float> values) {
  return {reinterpret_cast<const uint8_t*>(values.data()), values.size_bytes()};
}

void decodeFloatsInto(const ImageRequest& request, std::span<const uint8_t> input, Output& output,
                      ImageReply& reply) {
  const Image image = decodeFloats(input, request.format);
  const glm::ivec2 size(image.width, image.height);
  if ((image.placement ? image.placement->whole : size) != glm::ivec2(request.width, request.height) ||
      int(image.channelCount()) > request.channelCount)
    throw std::runtime_error("its size is not what its header says");
  std::vector<std::string> texts = image.channels;
  appendAttributes(image, texts);
  reply.numberCount = int(image.numbers.size());
  output.append(bytesOf(image.values));
  output.append(packTexts(texts));
  reply.channelCount = int(image.channelCount());
  reply.width = size.x;
  reply.height = size.y;
  reply.placement = messageOf(image.placement);
}

std::vector<uint8_t> encodeFloatsOf(const ImageRequest& request, std::span<const uint8_t> input) {
  const size_t count = size_t(request.width) * size_t(request.height) * size_t(request.channelCount);
  const std::vector<std::string> texts = unpackTexts(input.subspan(count * sizeof(float)));
  Image image{request.width, request.height, {}, {}, {}};
  const auto channelCount = size_t(request.channelCount);
  const size_t typeCount = request.bits == 16 ? channelCount : 0;
  if (texts.size() < channelCount + typeCount) throw std::runtime_error("the request is broken");
  image.channels.assign(texts.begin(), texts.begin() + request.channelCount);
  std::vector<bool> halves;
  for (size_t i = 0; i < typeCount; ++i) halves.push_back(texts[channelCount + i] == "half");
  takeAttributes(std::span(texts).subspan(channelCount + typeCount), request.numberCount, image);
  image.placement = placementOf(request.placement);
  return encodeFloats(image, {reinterpret_cast<const float*>(input.data()), count}, halves, request.format);
}

void perform(const ImageRequest& request, std::span<const uint8_t> input, std::span<uint8_t> room,
             ImageReply& reply) {
  Output output{room, 0};
  reply.channelCount = request.channelCount;
  switch (request.task) {
    case ImageTask::DecodeFloats:
      decodeFloatsInto(request, input, output, reply);
      break;
    case ImageTask::DecodeTexels:
      decodeTexels(input, request.format, request.width, request.height,
                   {reinterpret_cast<uint16_t*>(room.data()), room.size() / sizeof(uint16_t)});
      output.used = room.size();
      break;
    case ImageTask::EncodeBytes:
      output.append(encodeBytes(request.width, request.height, request.channelCount, request.bits, input,
                                request.format));
      break;
    case ImageTask::EncodeFloats:
      output.append(encodeFloatsOf(request, input));
      break;
  }
  reply.outputBytes = output.used;
}

}  // namespace
}  // namespace fragtrace

int main() {
  using namespace fragtrace;
  if (!isStartedByProgram("fragtrace_imageio")) return 2;
  openImageLibrary();
  answerRequests<ImageRequest, ImageReply>(perform);
  // What the libraries would tidy up on a normal end goes with the process.
  ::_exit(0);
}
