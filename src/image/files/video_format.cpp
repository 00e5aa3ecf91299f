// SPDX-License-Identifier: MIT
#include "image/files/video_format.h"

#include <algorithm>
#include <array>

#include "base/text.h"
#include "image/format.h"

namespace fragtrace {

namespace {

/// Frames are sRGB-encoded. Their luma and chroma are those of BT.709, in the range of television, and the
/// file says so. Without the flags, ffmpeg rounds down, which darkens a picture by half a step.
constexpr std::string_view kToYuv =
    "-vf scale=out_color_matrix=bt709:out_range=tv:flags=bicubic+accurate_rnd+full_chroma_int "
    "-color_primaries bt709 -color_trc iec61966-2-1 -colorspace bt709 -color_range tv";

constexpr std::array<VideoFormat, 4> kFormats{{
    {".mp4",
     {8, false},
     true,
     true,
     false,
     "-c:v libx264 -preset medium -crf 16 -pix_fmt yuv420p",
     "-movflags +faststart -f mp4"},
    {".webm",
     {8, false},
     false,
     true,
     true,
     "-c:v libvpx-vp9 -crf 18 -b:v 0 -row-mt 1 -pix_fmt yuv420p",
     "-f webm"},
    // With a palette for each picture, ffmpeg keeps none of those before in memory. A Bayer matrix stands
    // still where the picture does.
    {".gif",
     {8, false},
     false,
     false,
     true,
     "-vf split[all][some];[some]palettegen=stats_mode=single[palette];"
     "[all][palette]paletteuse=new=1:dither=bayer:bayer_scale=4",
     "-f gif"},
    // ProRes has no number for the curve of sRGB, and its encoder writes none of these by itself.
    {".mov",
     {16, true},
     false,
     true,
     false,
     "-c:v prores_ks -profile:v 4444 -pix_fmt yuva444p10le "
     "-bsf:v prores_metadata=color_primaries=bt709:color_trc=bt709:colorspace=bt709",
     "-f mov"},
}};

std::vector<std::string> wordsOf(const std::string& text) {
  const auto words = wordsIn(text);
  return {words.begin(), words.end()};
}

}  // namespace

std::optional<PixelForm> pixelFormOf(const std::filesystem::path& path) {
  const std::string extension = extensionOf(path);
  if (extension == ".rgb24") return PixelForm{8, false};
  if (extension == ".rgba64") return PixelForm{16, true};
  return std::nullopt;
}

const VideoFormat* videoFormatOf(const std::filesystem::path& path) {
  const auto* const format = std::ranges::find(kFormats, extensionOf(path), &VideoFormat::extension);
  return format == kFormats.end() ? nullptr : format;
}

std::vector<std::string> encodingOf(const VideoFormat& format) {
  return wordsOf(std::string(format.yuv ? kToYuv : "") + " " + std::string(format.encoding));
}

std::vector<std::string> containerOf(const VideoFormat& format) {
  return wordsOf(std::string(format.container));
}

bool holdsDisplay(const std::filesystem::path& path) {
  return isDisplayFormat(path) || pixelFormOf(path) || videoFormatOf(path) != nullptr;
}

bool holdsDisplayAlpha(const std::filesystem::path& path) {
  if (const auto form = pixelFormOf(path)) return form->alpha;
  const VideoFormat* const video = videoFormatOf(path);
  return video != nullptr ? video->pixels.alpha : formatOfName(path) == ImageFormat::Png;
}

}  // namespace fragtrace
