// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/dynamic_library.h"
#include "image/image.h"

namespace fragtrace {

// Open Image Denoise 2.x, opened when it is asked for: the functions of its C interface that the filter
// needs. Names, numbers and meanings are those of https://www.openimagedenoise.org/documentation.html.
//
// It runs in our process. Its input is our own numbers, not a file from anywhere, so there is no fault of a
// decoder to fence off; a process of its own would cost its start and a copy of up to nine floats per pixel.

struct OidnDeviceHandle;  // OIDNDevice is a pointer to one
struct OidnFilterHandle;  // OIDNFilter

inline constexpr int kOidnCpuDevice = 1;       // OIDN_DEVICE_TYPE_CPU
inline constexpr int kOidnFloat3 = 3;          // OIDN_FORMAT_FLOAT3
inline constexpr int kOidnHighQuality = 6;     // OIDN_QUALITY_HIGH
inline constexpr int kOidnNoError = 0;         // OIDN_ERROR_NONE
inline constexpr int kOidnCancelledError = 6;  // OIDN_ERROR_CANCELLED

/// `fraction` is the part done, 0..1; false ends the filter with the error "cancelled".
using OidnProgressMonitor = bool (*)(void* user, double fraction);

struct OidnFunctions : LibraryFunctions {
  using LibraryFunctions::LibraryFunctions;
  OidnDeviceHandle* (*newDevice)(int type) = find("oidnNewDevice");
  void (*commitDevice)(OidnDeviceHandle*) = find("oidnCommitDevice");
  /// The first error since the last call, and its message. Without a device it is that of the calling thread.
  int (*getDeviceError)(OidnDeviceHandle*, const char** message) = find("oidnGetDeviceError");
  int (*getDeviceInt)(OidnDeviceHandle*, const char* name) = find("oidnGetDeviceInt");
  void (*releaseDevice)(OidnDeviceHandle*) = find("oidnReleaseDevice");
  OidnFilterHandle* (*newFilter)(OidnDeviceHandle*, const char* type) = find("oidnNewFilter");
  /// Strides of 0: the pixels lie one behind the other. The memory stays the caller's.
  void (*setSharedFilterImage)(OidnFilterHandle*, const char* name, void* pixels, int format, size_t width,
                               size_t height, size_t byteOffset, size_t pixelStride,
                               size_t rowStride) = find("oidnSetSharedFilterImage");
  void (*setFilterBool)(OidnFilterHandle*, const char* name, bool value) = find("oidnSetFilterBool");
  void (*setFilterInt)(OidnFilterHandle*, const char* name, int value) = find("oidnSetFilterInt");
  void (*setProgressMonitor)(OidnFilterHandle*, OidnProgressMonitor,
                             void* user) = find("oidnSetFilterProgressMonitorFunction");
  void (*commitFilter)(OidnFilterHandle*) = find("oidnCommitFilter");
  void (*executeFilter)(OidnFilterHandle*) = find("oidnExecuteFilter");
  void (*releaseFilter)(OidnFilterHandle*) = find("oidnReleaseFilter");
};

/// The library with a device on the processor. It stays open when this goes.
struct OidnLibrary {
  OidnFunctions call;
  std::shared_ptr<OidnDeviceHandle> device{};
  std::string file{};     ///< a path, or the name that the loader found
  std::string version{};  ///< "2.5.1"
  double loadMs = 0.0;    ///< time to open it and to make the device
};

/// Opens `chosen`; without it the file that the variable FRAGTRACE_OIDN_LIBRARY names; without that what the
/// loader finds as libOpenImageDenoise.so.2, or a copy in the folders where pip installs the package pyoidn.
/// Throws UsageError that says what was looked for, or why a file that was named does not serve.
OidnLibrary openOidn(const std::filesystem::path& chosen);

/// Returns true if openOidn() opens one file that the user has named, false if it looks for any.
bool namesOidn(const std::filesystem::path& chosen);

// A picture filtered by Open Image Denoise (docs/design/denoising.md).

/// Called with the part done, 0..1, from one thread at a time; false stops the filter. Must not throw.
using OidnProgress = std::function<bool(double)>;

/// Returns true if the picture has the albedo and normal of kGuideChannels, by which the filter sees
/// surfaces.
bool hasOidnGuides(const Image& picture);

/// R, G and B of the picture that `noisy` converges to, estimated from its linear R, G and B, which it must
/// have and which are not clamped, and from albedo (0..1) and normal (-1..1) of kGuideChannels, if it has
/// both. Pixels whose coverage among these is 0 stay as they are. Values that are not finite count as 0.
/// Takes about `memoryBytes` at most, besides fifteen floats per pixel. Nothing when `progress` stops it.
/// Throws RenderError with what the library says.
std::optional<Image> denoisedByOidn(const Image& noisy, const OidnLibrary& library, uint64_t memoryBytes,
                                    const OidnProgress& progress = {});

// The layers of pictures that other renderers wrote, under our names.

/// R, G, B, A, samples.Y, variance.Y, kObservedChannel and kGuideChannels of a picture file, as far as it has
/// them. Missing guides are taken from its layers of first hits: ours (albedo, normal, depth), or colours and
/// guides of Cycles (ViewLayer.Combined.R, ViewLayer.Noisy Image.R, ViewLayer.Denoising Albedo.R, ...),
/// Mitsuba (albedo.R, sh_normal.X, nn.X, ...) or pbrt (Albedo.R, Ns.X, N.X). Noisy colours of Cycles are
/// preferred to filtered ones, and guides come from the layer of the colours. The result has no channel R if
/// the file has no colour.
Image layersForFilter(const Image& file);

}  // namespace fragtrace
