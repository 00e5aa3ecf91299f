// SPDX-License-Identifier: MIT
#include "image/files/process.h"

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "advice.h"
#include "base/errors.h"
#include "base/message.h"
#include "base/parallel.h"
#include "base/worker.h"
#include "image/channels.h"
#include "image/worker/message.h"

namespace fragtrace {

namespace {

using Bytes = std::span<const uint8_t>;

Worker& worker() {
  static constexpr WorkerKind kPictures{kPictureModule, "the image library", kPictureAdvice,
                                        "; .pfm files need none"};
  static Worker theOne(kPictures);
  return theOne;
}

/// A codec of its own, since few builds have it.
Worker& ktx2Worker() {
  static constexpr WorkerKind kKtx2{"libfragtrace_ktx2.so", "the codec of KTX2 textures",
                                    "scripts/build makes it",
                                    "; `scripts/setup ktx2` before scripts/build brings it, `gltf-transform "
                                    "ktxdecompress IN OUT` (with KTX-Software's `ktx`) writes a file with "
                                    "PNG textures"};
  static Worker theOne(kKtx2);
  return theOne;
}

/// Decoders take some 10 ns a value on slow machines, and a few times the memory of what they make.
WorkResult decode(PictureTask task, Bytes bytes, const ImageHeader& header, uint64_t room) {
  constexpr uint64_t kLibrary = uint64_t(512) << 20;
  constexpr uint64_t kValuesASecond = 10'000'000;
  const uint64_t values = decodedValues(header);
  const PictureMessage request{.task = task,
                               .format = header.format,
                               .width = header.width,
                               .height = header.height,
                               .channelCount = header.channelCount,
                               .bits = task == PictureTask::DecodeTexels ? header.texelBits : 0};
  Worker& codec = header.format == ImageFormat::Ktx2 ? ktx2Worker() : worker();
  return codec.perform({asMessage(request), bytes}, room,
                       {.memoryBytes = kLibrary + 4 * bytes.size() + 16 * values,
                        .cpuSeconds = unsigned(2 + values / kValuesASecond)});
}

/// The room is more than any of the formats needs for incompressible values.
std::vector<uint8_t> encode(const PictureMessage& request, Bytes values, Bytes texts) {
  constexpr uint64_t kHeader = 1 << 20;
  constexpr uint64_t kOfALine = 64;
  const uint64_t room = 2 * (values.size() + texts.size()) + uint64_t(request.height) * kOfALine + kHeader;
  const WorkResult result = worker().perform({asMessage(request), values, texts}, room, {});
  return {result.output.begin(), result.output.end()};
}

/// Returns true if the picture, or the larger one in which it lies, has the header's size, and no more
/// channels.
bool isAsPromised(const PictureMessage& picture, const ImageHeader& header) {
  const glm::ivec2 size(picture.width, picture.height);
  const Placement placed = picture.placement.whole.x != 0 ? picture.placement : Placement{{0, 0}, size};
  return placed.whole == glm::ivec2(header.width, header.height) &&
         glm::all(glm::greaterThan(size, glm::ivec2(0))) &&
         glm::all(glm::greaterThanEqual(placed.corner, glm::ivec2(0))) &&
         glm::all(glm::lessThanEqual(size, placed.whole - placed.corner)) && picture.channelCount >= 1 &&
         picture.channelCount <= header.channelCount;
}

/// The file of an .hdr with the only form of header that the image library knows.
std::vector<uint8_t> withPlainHeader(Bytes bytes, const HdrForm& form) {
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + form.resolution + "\n";
  std::vector<uint8_t> plain(header.begin(), header.end());
  plain.insert(plain.end(), bytes.begin() + std::ptrdiff_t(form.pixelsAt), bytes.end());
  return plain;
}

[[noreturn]] void refuseAnswer() { throw std::runtime_error("the worker process sent a broken answer"); }

}  // namespace

Image decodeByProcess(Bytes bytes, const ImageHeader& asShown) {
  ImageHeader header = asShown;
  std::vector<uint8_t> plain;
  if (header.format == ImageFormat::Hdr) bytes = plain = withPlainHeader(bytes, header.hdr);
  if (header.hdr.columns) std::swap(header.width, header.height);
  const uint64_t pixels = uint64_t(header.width) * uint64_t(header.height);
  constexpr uint64_t kRoomForTexts = 1 << 16;  // besides those that stand in the file
  const WorkResult result =
      decode(PictureTask::DecodeFloats, bytes, header,
             pixels * uint64_t(header.channelCount) * sizeof(float) + bytes.size() + kRoomForTexts);
  Bytes output = result.output;
  const auto picture = takeMessage<PictureMessage>(output);
  if (!isAsPromised(picture, header)) refuseAnswer();
  SentImage sent = takeImage(picture, output);
  sent.image.values.assign(sent.values.begin(), sent.values.end());
  return std::move(sent.image);
}

TexelImage decodeTexelsByProcess(Bytes bytes, const ImageHeader& header) {
  const uint64_t values = uint64_t(header.width) * uint64_t(header.height) * 4;
  const uint64_t size = values * uint64_t(header.texelBits) / 8;
  const WorkResult result = decode(PictureTask::DecodeTexels, bytes, header, size);
  if (result.output.size() != size) refuseAnswer();
  TexelImage texels{header.width, header.height, result.output, result.memory};
  if (header.texelBits == 16)
    texels.rgba = std::span(reinterpret_cast<const uint16_t*>(result.output.data()), values);
  return texels;
}

const std::string& whyNoPictures() { return worker().whyNot(); }

const std::string& whyNoKtx2() {
  static const std::string why = ktx2Worker().whyNot();
  return why;
}

std::vector<uint8_t> encodeBytesByProcess(int width, int height, int channelCount, int bits, Bytes values,
                                          ImageFormat format) {
  return encode({.task = PictureTask::EncodeBytes,
                 .format = format,
                 .width = width,
                 .height = height,
                 .channelCount = channelCount,
                 .bits = bits},
                values, {});
}

std::vector<uint8_t> encodeFloatsByProcess(const Image& image, ImageFormat format, bool half) {
  const int bits = half ? 16 : 32;
  return encode(messageOf(image, PictureTask::EncodeFloats, format, bits), asBytes(image.values),
                textsOf(image, bits));
}

Image shownByView(Image exposed, const OcioView& view) {
  static constexpr WorkerKind kViews{kPictureModule, "the image library", kPictureAdvice,
                                     "; --tone-map needs none", true};
  static Worker views(kViews);
  try {
    const char* usual = std::getenv("OCIO");
    if (view.config.empty() && (usual == nullptr || *usual == 0))
      throw std::runtime_error("no configuration is named (--ocio-config FILE, or $OCIO)");
    // Without alpha, which some configurations change a little.
    Image colors = onlyChannels(exposed, {"R", "G", "B"});
    colors.attributes = {{"config", view.config},
                         {"display", view.display},
                         {"view", view.view},
                         {"look", view.look},
                         {"input", view.input}};
    const PictureMessage request = messageOf(colors, PictureTask::ShowByView, ImageFormat::Pfm, 0);
    const std::vector<uint8_t> texts = textsOf(colors, 0);
    const Bytes values = asBytes(colors.values);
    const WorkResult result = views.perform({asMessage(request), values, texts}, values.size(), {});
    if (result.output.size() != values.size()) refuseAnswer();
    const auto* shown = reinterpret_cast<const float*>(result.output.data());
    for (size_t first = 0; first < exposed.values.size(); first += exposed.channelCount(), shown += 3)
      std::copy_n(shown, 3, exposed.values.begin() + std::ptrdiff_t(first));
  } catch (const std::runtime_error& error) {
    throw InputError(std::string("--ocio-view: ") + error.what());
  }
  return exposed;
}

void startImageProcess() noexcept {
  try {
    worker().start();
  } catch (const std::exception&) {
    // The first use tries again, and says why it cannot.
  }
}

namespace {

/// Each thread that decodes has a process of its own, which waits for more work. Ends those that wait, except
/// for one of each kind.
void endSpareImageProcesses() {
  worker().endSpare();
  ktx2Worker().endSpare();
}

struct Job {
  size_t index;
  uint64_t bytes;  ///< bytes of the file and its texels
};

/// Returns the bytes that decoding shares with a process. A broken header is refused later.
uint64_t sharedBytes(std::span<const uint8_t> file) {
  try {
    const ImageHeader header = readImageHeader(file);
    return file.size() +
           uint64_t(header.width) * uint64_t(header.height) * 4 * uint64_t(header.texelBits) / 8;
  } catch (const std::runtime_error&) {
    return file.size();
  }
}

/// The bytes that threads hold at the same time.
struct SharedRoom {
  uint64_t most;
  uint64_t held = 0;
  std::mutex mutex{};
  std::condition_variable freed{};
};

/// Holds bytes of the room. Waits until they fit, or until nothing else is held.
class HeldRoom {
 public:
  HeldRoom(SharedRoom& room, uint64_t bytes) : room_(room), bytes_(bytes) {
    std::unique_lock lock(room.mutex);
    room.freed.wait(lock, [&] { return room.held == 0 || bytes + room.held <= room.most; });
    room.held += bytes;
  }
  ~HeldRoom() {
    const std::lock_guard lock(room_.mutex);
    room_.held -= bytes_;
    room_.freed.notify_all();
  }
  HeldRoom(const HeldRoom&) = delete;
  HeldRoom& operator=(const HeldRoom&) = delete;

 private:
  SharedRoom& room_;
  uint64_t bytes_;
};

/// The start of a process takes as long as decoding so many bytes of texels.
constexpr uint64_t kWorthAProcess = uint64_t(16) << 20;

}  // namespace

std::vector<std::string> decodeEach(std::span<const EncodedPicture> pictures, const TakeTexels& take,
                                    uint64_t mostBytes) {
  std::vector<Job> jobs;
  uint64_t sum = 0;
  for (size_t i = 0; i < pictures.size(); ++i) {
    jobs.push_back({i, sharedBytes(pictures[i].bytes)});
    sum += jobs.back().bytes;
  }
  std::ranges::stable_sort(jobs, std::ranges::greater(), &Job::bytes);
  const uint64_t threads = std::min<uint64_t>({jobs.size(), processorCount(), 1 + sum / kWorthAProcess});

  std::vector<std::string> errors(pictures.size());
  SharedRoom room{mostBytes};
  const auto work = [&](size_t i) {
    const auto [index, bytes] = jobs[i];
    const HeldRoom held(room, bytes);
    TexelImage texels;
    try {
      texels = decodeTexels(pictures[index].bytes, pictures[index].name);
    } catch (const InputError& error) {
      errors[index] = error.what();
      return;
    }
    take(index, std::move(texels));
  };
  forEachIndex(jobs.size(), work, uint32_t(threads));
  endSpareImageProcesses();
  return errors;
}

}  // namespace fragtrace
