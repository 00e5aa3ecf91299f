// SPDX-License-Identifier: MIT
// The worker's module for KTX2 textures: by Binomial's transcoder, which scripts/setup ktx2 fetches.
#include <basisu_transcoder.h>

#include <stdexcept>
#include <utility>

#include "base/message.h"
#include "base/worker/module.h"
#include "image/worker/message.h"

namespace fragtrace {
namespace {

/// Returns true where the second of two channels is stored as alpha.
bool isRedAndGreen(const basist::ktx2_transcoder& file) {
  return file.is_etc1s() ? file.get_dfd_channel_id1() == basist::KTX2_DF_CHANNEL_ETC1S_GGG
                         : file.get_dfd_channel_id0() == basist::KTX2_DF_CHANNEL_UASTC_RRRG;
}

}  // namespace

/// Level 0 as 8 bits per channel.
extern "C" void fragtraceWork(std::span<const uint8_t> input, WorkOutput& output) {
  if (input.empty()) return basist::basisu_transcoder_init();
  const auto request = takeMessage<PictureMessage>(input);
  basist::ktx2_transcoder file;
  if (request.task != PictureTask::DecodeTexels || !file.init(input.data(), uint32_t(input.size())) ||
      !file.start_transcoding())
    throw std::runtime_error("the KTX2 file is broken");
  if (int64_t(file.get_width()) != request.width || int64_t(file.get_height()) != request.height)
    throw std::runtime_error("its size is not what its header says");
  const uint32_t texels = file.get_width() * file.get_height();
  const std::span<uint8_t> values = output.room;
  if (request.bits != 8 || values.size() != size_t(texels) * 4)
    throw std::runtime_error("its texels have 8 bits");
  if (!file.transcode_image_level(0, 0, 0, values.data(), texels,
                                  basist::transcoder_texture_format::cTFRGBA32))
    throw std::runtime_error("its level 0 is broken");
  if (isRedAndGreen(file)) {
    for (size_t i = 0; i < values.size(); i += 4) {
      values[i + 1] = std::exchange(values[i + 3], 255);
      values[i + 2] = 0;
    }
  }
  output.used = values.size();
}

}  // namespace fragtrace
