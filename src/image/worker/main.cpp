// SPDX-License-Identifier: MIT
// fragtrace_imageio: the image library in a process of its own, with limits that the program sets. It ends
// when the program does.
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <stdexcept>

#include "image/worker/messages.h"
#include "image/worker/openimageio.h"

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

int decodeFloatsInto(const ImageRequest& request, std::span<const uint8_t> input, Output& output) {
  const Image image = decodeFloats(input, request.format);
  if (image.width != request.width || image.height != request.height ||
      int(image.channelCount()) > request.channelCount)
    throw std::runtime_error("its size is not what its header says");
  std::vector<std::string> texts = image.channels;
  for (const auto& [name, text] : image.attributes) {
    texts.push_back(name);
    texts.push_back(text);
  }
  output.append(bytesOf(image.values));
  output.append(packTexts(texts));
  return int(image.channelCount());
}

std::vector<uint8_t> encodeFloatsOf(const ImageRequest& request, std::span<const uint8_t> input) {
  const size_t count = size_t(request.width) * size_t(request.height) * size_t(request.channelCount);
  const std::vector<std::string> texts = unpackTexts(input.subspan(count * sizeof(float)));
  Image image{request.width, request.height, {}, {}, {}};
  const auto channels = texts.begin() + request.channelCount;
  image.channels.assign(texts.begin(), channels);
  for (auto text = channels; text != texts.end(); text += 2) image.attributes[*text] = *(text + 1);
  return encodeFloats(image, {reinterpret_cast<const float*>(input.data()), count}, request.format);
}

ImageReply perform(const ImageRequest& request, std::span<const uint8_t> input, std::span<uint8_t> room) {
  ImageReply reply;
  Output output{room, 0};
  reply.channelCount = request.channelCount;
  switch (request.task) {
    case ImageTask::DecodeFloats:
      reply.channelCount = decodeFloatsInto(request, input, output);
      break;
    case ImageTask::DecodeTexels:
      decodeTexels(input, request.format, request.width, request.height,
                   {reinterpret_cast<uint16_t*>(room.data()), room.size() / sizeof(uint16_t)});
      output.used = room.size();
      break;
    case ImageTask::EncodeBytes:
      output.append(encodeBytes(request.width, request.height, request.channelCount, input, request.format));
      break;
    case ImageTask::EncodeFloats:
      output.append(encodeFloatsOf(request, input));
      break;
  }
  reply.outputBytes = output.used;
  reply.done = true;
  return reply;
}

ImageReply refusal(const char* reason) {
  ImageReply reply;
  std::strncpy(reply.reason, reason, sizeof reply.reason - 1);
  return reply;
}

ImageReply answer(const ImageRequest& request, int memoryFile) {
  const uint64_t size = outputOffset(request) + request.outputBytes;
  void* memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, memoryFile, 0);
  ::close(memoryFile);
  if (memory == MAP_FAILED) return refusal("it does not fit into memory");
  auto* bytes = static_cast<uint8_t*>(memory);
  ImageReply reply;
  try {
    reply =
        perform(request, {bytes, request.inputBytes}, {bytes + outputOffset(request), request.outputBytes});
  } catch (const std::bad_alloc&) {
    reply = refusal("it does not fit into memory");
  } catch (const std::exception& error) {
    reply = refusal(error.what());
  }
  ::munmap(memory, size);
  return reply;
}

}  // namespace
}  // namespace fragtrace

int main() {
  using namespace fragtrace;
  struct stat status {};
  if (::fstat(kImageProcessSocket, &status) != 0 || !S_ISSOCK(status.st_mode)) {
    static constexpr char kHint[] = "fragtrace_imageio: started by fragtrace, not by hand\n";
    (void)!::write(STDERR_FILENO, kHint, sizeof kHint - 1);
    return 2;
  }
  openImageLibrary();
  int memoryFile = -1;
  while (const auto request = receiveRequest(kImageProcessSocket, memoryFile)) {
    const ImageReply reply = answer(*request, memoryFile);
    if (::send(kImageProcessSocket, &reply, sizeof reply, MSG_NOSIGNAL) != ssize_t(sizeof reply)) break;
  }
  // What the libraries would tidy up on a normal end goes with the process.
  ::_exit(0);
}
