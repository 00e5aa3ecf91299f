// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "image/display/tone_map.h"
#include "image/files/header.h"
#include "image/image.h"

namespace fragtrace {

// The image library in a worker process (base/worker.h): a run that reads and writes no encoded picture
// does not load OpenImageIO's 250 shared objects.

// Every function throws std::runtime_error with the bare reason; the caller adds the file.

/// All channels as floats; values as stored, alpha unassociated in 8 and 16 bit formats.
Image decodeByProcess(std::span<const uint8_t> bytes, const ImageHeader& header);

TexelImage decodeTexelsByProcess(std::span<const uint8_t> bytes, const ImageHeader& header);

/// Why no picture but a .pfm can be decoded; empty where they can. The first call starts the process.
const std::string& whyNoPictures();

/// Why KTX2 textures cannot be decoded; empty where they can. The first call starts their codec.
const std::string& whyNoKtx2();

/// Interleaved RGB, or RGBA with unassociated alpha, of 8 bits as .png or .jpg, of 16 as .png.
std::vector<uint8_t> encodeBytesByProcess(int width, int height, int channelCount, int bits,
                                          std::span<const uint8_t> values, ImageFormat format);

/// Encodes all channels as .exr, or three as .hdr. `half` is for an .exr: channels with isStoredAsHalf()
/// become 16-bit floats, which must be able to hold the values.
std::vector<uint8_t> encodeFloatsByProcess(const Image& image, ImageFormat format, bool half = false);

/// Turns R, G, B of exposedColors() into what the view shows, and keeps A. A process of its own does so,
/// which reads the configuration's files before it is confined. Throws InputError, which lists the names
/// there are.
Image shownByView(Image exposed, const OcioView& view);

/// Starts the process ahead of its first use, which takes a millisecond here and 0.1 s there. A failure is
/// left for the first use to report.
void startImageProcess() noexcept;

// Many pictures at once.

struct EncodedPicture {
  std::span<const uint8_t> bytes;
  std::string name;  ///< the name in messages
};

/// Takes a picture by its index.
using TakeTexels = std::function<void(size_t index, TexelImage texels)>;

/// Decodes pictures as decodeTexels() does, the largest first, by as many processes as there are processors
/// and as the pictures are worth starting. Gives each to `take` as soon as it is decoded, from several
/// threads at once. Pictures that exist at the same time have at most `mostBytes`, unless there is only one.
/// Returns the message of each picture that cannot be decoded, and empty texts for the others. Throws what
/// `take` throws.
std::vector<std::string> decodeEach(std::span<const EncodedPicture> pictures, const TakeTexels& take,
                                    uint64_t mostBytes = defaultMemoryLimit() / 4);

}  // namespace fragtrace
