// SPDX-License-Identifier: MIT
#include "image/worker/avif.h"

#include <dlfcn.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

namespace fragtrace {

namespace {

// libheif's interface, whose headers are in a package that nothing else here needs.

struct HeifError {
  int code;
  int subcode;
  const char* message;
};
struct HeifContext;
struct HeifHandle;
struct HeifImage;
constexpr int kHeifRgb = 1;               // heif_colorspace_RGB
constexpr int kHeifInterleaved = 10;      // heif_channel_interleaved
constexpr int kHeifInterleavedRgba = 11;  // heif_chroma_interleaved_RGBA
constexpr int kHeifUnsupported = 4;       // heif_error_Unsupported_feature
constexpr int kHeifNoPlugin = 6;          // heif_error_Decoder_plugin_error: also where there is none

/// Looks a function of libheif up among what is loaded.
template <typename Function>
Function* found(const char* name) {
  auto* function = reinterpret_cast<Function*>(::dlsym(RTLD_DEFAULT, name));
  if (function == nullptr)
    throw std::runtime_error("AVIF cannot be decoded: OpenImageIO was built without libheif");
  return function;
}

template <typename Thing>
using Owned = std::unique_ptr<Thing, void (*)(Thing*)>;

template <typename Thing>
Owned<Thing> owned(Thing* thing, const char* release) {
  return {thing, found<void(Thing*)>(release)};
}

void check(const HeifError& error) {
  if (error.code == 0) return;
  const std::string text = error.message != nullptr ? error.message : "libheif gives no reason";
  if (error.code == kHeifUnsupported || error.code == kHeifNoPlugin)
    throw std::runtime_error("AVIF cannot be decoded: " + text +
                             " (on Debian 13: apt-get install libheif-plugin-dav1d)");
  throw std::runtime_error(text);
}

}  // namespace

void decodeAvif(std::span<const uint8_t> bytes, int width, int height, std::span<uint8_t> rgba) {
  const auto context = owned(found<HeifContext*()>("heif_context_alloc")(), "heif_context_free");
  check(found<HeifError(HeifContext*, const void*, size_t, const void*)>(
      "heif_context_read_from_memory_without_copy")(context.get(), bytes.data(), bytes.size(), nullptr));
  HeifHandle* opened = nullptr;
  check(found<HeifError(HeifContext*, HeifHandle**)>("heif_context_get_primary_image_handle")(context.get(),
                                                                                              &opened));
  const auto handle = owned(opened, "heif_image_handle_release");
  const auto sizeOf = [&](const char* side) { return found<int(const HeifHandle*)>(side)(handle.get()); };
  if (sizeOf("heif_image_handle_get_width") != width || sizeOf("heif_image_handle_get_height") != height ||
      rgba.size() != size_t(width) * size_t(height) * 4)
    throw std::runtime_error("its size is not what its header says");
  HeifImage* decoded = nullptr;
  check(found<HeifError(const HeifHandle*, HeifImage**, int, int, const void*)>("heif_decode_image")(
      handle.get(), &decoded, kHeifRgb, kHeifInterleavedRgba, nullptr));
  const auto image = owned(decoded, "heif_image_release");
  int stride = 0;
  const uint8_t* plane = found<const uint8_t*(const HeifImage*, int, int*)>("heif_image_get_plane_readonly")(
      image.get(), kHeifInterleaved, &stride);
  if (plane == nullptr) throw std::runtime_error("libheif gives no pixels");
  const size_t row = size_t(width) * 4;
  for (int y = 0; y < height; ++y)
    std::copy_n(plane + ptrdiff_t(y) * stride, row, rgba.begin() + ptrdiff_t(y) * ptrdiff_t(row));
}

}  // namespace fragtrace
