// SPDX-License-Identifier: MIT
#include "image/files/decode_each.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "base/errors.h"
#include "base/parallel.h"
#include "image/files/header.h"
#include "image/files/process.h"

namespace fragtrace {
namespace {

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
  const uint64_t threads = std::min<uint64_t>(
      {jobs.size(), std::max(std::thread::hardware_concurrency(), 1u), 1 + sum / kWorthAProcess});

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
