// SPDX-License-Identifier: MIT
#include "image/files/process.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <string>

#include "advice.h"
#include "image/channels.h"
#include "image/worker/messages.h"
#include "process/child.h"
#include "process/shared_memory.h"

namespace fragtrace {
namespace {

struct Limits {
  uint64_t memoryBytes = RLIM_INFINITY;  ///< data of the process
  unsigned cpuSeconds = 0;               ///< 0: no limit
};

/// Decoders take some 10 ns a value on slow machines, and a few times the memory of what they make.
Limits decodingLimits(const ImageHeader& header, size_t encodedBytes) {
  constexpr uint64_t kLibrary = uint64_t(512) << 20;
  constexpr uint64_t kValuesASecond = 10'000'000;
  const uint64_t values = uint64_t(header.width) * uint64_t(header.height) * uint64_t(header.channelCount);
  return {kLibrary + 4 * encodedBytes + 16 * values, unsigned(2 + values / kValuesASecond)};
}

struct Answer {
  ImageReply reply;
  std::shared_ptr<SharedMemory> memory;
  std::span<uint8_t> output;
};

/// One request after the other, to a process that is started again when it has died.
class Service {
 public:
  void start() {
    const std::lock_guard lock(mutex_);
    start(lock);
  }

  Answer perform(const ImageRequest& request, std::span<const uint8_t> firstInput,
                 std::span<const uint8_t> secondInput, const Limits& limits) {
    Answer answer;
    answer.memory = std::make_shared<SharedMemory>(outputOffset(request) + request.outputBytes);
    const auto input = std::ranges::copy(firstInput, answer.memory->bytes().begin()).out;
    std::ranges::copy(secondInput, input);

    const std::lock_guard lock(mutex_);
    start(lock);
    const ImageReply reply = exchange(request, answer.memory->file(), limits);
    if (!reply.done)
      throw std::runtime_error(std::string(reply.reason, ::strnlen(reply.reason, sizeof reply.reason)));
    if (reply.outputBytes > request.outputBytes || reply.channelCount < 1 ||
        reply.channelCount > request.channelCount)
      throw std::runtime_error("the image process sent a broken answer");
    answer.reply = reply;
    answer.output = answer.memory->bytes().subspan(outputOffset(request), reply.outputBytes);
    return answer;
  }

 private:
  static constexpr const char* kProcessName = "fragtrace_imageio";

  void start(const std::lock_guard<std::mutex>&) {
    if (child_) return;
    try {
      child_ = startChild(kProcessName, kServiceSocket);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("the image library " + std::string(error.what()) + "; .pfm files need none");
    }
  }

  ImageReply exchange(const ImageRequest& request, int memoryFile, const Limits& limits) {
    limitChild(*child_, limits.memoryBytes, limits.cpuSeconds);
    ImageReply reply;
    // The processor time ends it; this is for one that sleeps.
    const int patienceMs = limits.cpuSeconds == 0 ? -1 : int(limits.cpuSeconds * 20 + 60) * 1000;
    if (sendWithFile(child_->socket, asMessage(request), memoryFile) &&
        awaitReply(*child_, asMessage(reply), patienceMs))
      return reply;
    const std::string end = endChild(*child_);
    child_.reset();
    if (end == kLibraryMissing)
      throw std::runtime_error("the image library is not installed (" + std::string(kPictureAdvice) +
                               "); .pfm files need none");
    throw std::runtime_error(end == kOutOfTime ? "it takes longer to decode than its size is given: " +
                                                     std::to_string(limits.cpuSeconds) + " s"
                                               : "the image library failed: " + end);
  }

  std::mutex mutex_;
  std::unique_ptr<Child> child_;
};

Service& service() {
  static Service theOne;
  return theOne;
}

std::span<const uint8_t> asBytes(std::span<const float> values) {
  return {reinterpret_cast<const uint8_t*>(values.data()), values.size_bytes()};
}

/// Whether the picture, or the larger one that it lies in, has that size.
bool isPlacedIn(const Image& image, glm::ivec2 whole) {
  const glm::ivec2 size(image.width, image.height);
  const Placement placed = image.placement.value_or(Placement{{0, 0}, size});
  return placed.whole == whole && glm::all(glm::greaterThan(size, glm::ivec2(0))) &&
         glm::all(glm::greaterThanEqual(placed.corner, glm::ivec2(0))) &&
         glm::all(glm::lessThanEqual(size, placed.whole - placed.corner));
}

/// More than any of the formats makes of incompressible values.
uint64_t roomForEncoded(uint64_t rawBytes, int height) {
  constexpr uint64_t kHeader = 1 << 20;
  constexpr uint64_t kOfALine = 64;
  return 2 * rawBytes + uint64_t(height) * kOfALine + kHeader;
}

}  // namespace

Image decodeByProcess(std::span<const uint8_t> bytes, const ImageHeader& header) {
  const uint64_t pixels = uint64_t(header.width) * uint64_t(header.height);
  constexpr uint64_t kRoomForTexts = 1 << 16;  // beside those that stand in the file
  ImageRequest request{ImageTask::DecodeFloats,
                       header.format,
                       header.width,
                       header.height,
                       header.channelCount,
                       bytes.size(),
                       0,
                       {},
                       0,
                       0};
  request.outputBytes = pixels * uint64_t(header.channelCount) * sizeof(float) + bytes.size() + kRoomForTexts;
  const Answer answer = service().perform(request, bytes, {}, decodingLimits(header, bytes.size()));

  const int channelCount = answer.reply.channelCount;
  Image image{answer.reply.width, answer.reply.height, {}, {}, {}};
  image.placement = placementOf(answer.reply.placement);
  if (!isPlacedIn(image, {header.width, header.height}))
    throw std::runtime_error("the image process sent a broken answer");
  const uint64_t count = uint64_t(image.width) * uint64_t(image.height) * uint64_t(channelCount);
  if (answer.output.size() < count * sizeof(float))
    throw std::runtime_error("the image process sent a broken answer");
  const auto* values = reinterpret_cast<const float*>(answer.output.data());
  image.values.assign(values, values + count);
  const auto texts = unpackTexts(answer.output.subspan(count * sizeof(float)));
  if (texts.size() < size_t(channelCount)) throw std::runtime_error("the image process sent a broken answer");
  image.channels.assign(texts.begin(), texts.begin() + channelCount);
  takeAttributes(std::span(texts).subspan(size_t(channelCount)), answer.reply.numberCount, image);
  return image;
}

TexelImage decodeTexelsByProcess(std::span<const uint8_t> bytes, const ImageHeader& header) {
  const uint64_t values = uint64_t(header.width) * uint64_t(header.height) * 4;
  const ImageRequest request{ImageTask::DecodeTexels,
                             header.format,
                             header.width,
                             header.height,
                             header.channelCount,
                             bytes.size(),
                             values * sizeof(uint16_t),
                             {},
                             0,
                             0};
  const Answer answer = service().perform(request, bytes, {}, decodingLimits(header, bytes.size()));
  if (answer.output.size() != request.outputBytes)
    throw std::runtime_error("the image process sent a broken answer");
  return {header.width,
          header.height,
          {reinterpret_cast<const uint16_t*>(answer.output.data()), values},
          answer.memory};
}

std::vector<uint8_t> encodeBytesByProcess(int width, int height, int channelCount, int bits,
                                          std::span<const uint8_t> values, ImageFormat format) {
  const ImageRequest request{ImageTask::EncodeBytes,
                             format,
                             width,
                             height,
                             channelCount,
                             values.size(),
                             roomForEncoded(values.size(), height),
                             {},
                             bits,
                             0};
  const Answer answer = service().perform(request, values, {}, {});
  return {answer.output.begin(), answer.output.end()};
}

std::vector<uint8_t> encodeFloatsByProcess(const Image& image, ImageFormat format, bool half) {
  std::vector<std::string> texts = image.channels;
  if (half) {
    for (const std::string& channel : image.channels)
      texts.emplace_back(isStoredAsHalf(channel) ? "half" : "float");
  }
  appendAttributes(image, texts);
  const std::vector<uint8_t> packed = packTexts(texts);
  const std::span<const uint8_t> values = asBytes(image.values);
  const uint64_t size = values.size() + packed.size();
  const ImageRequest request{ImageTask::EncodeFloats,
                             format,
                             image.width,
                             image.height,
                             int(image.channelCount()),
                             size,
                             roomForEncoded(size, image.height),
                             messageOf(image.placement),
                             half ? 16 : 32,
                             int(image.numbers.size())};
  const Answer answer = service().perform(request, values, packed, {});
  return {answer.output.begin(), answer.output.end()};
}

void startImageProcess() noexcept {
  try {
    service().start();
  } catch (const std::exception&) {
    // The first use tries again, and says why it cannot.
  }
}

}  // namespace fragtrace
