// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <condition_variable>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "gl/gl.h"
#include "image/image.h"
#include "render/picture_passes.h"

namespace fragtrace {

/// Uploads linear R, G, B, variance.Y, samples.Y, kGuideChannels, and kObservedChannel if it is there, which
/// `observed` says, in the order of the image's rows. Pixels whose colour is not finite are filled from their
/// neighbours; other such values count as 0. Throws RenderError if a layer is missing, which it names, or if
/// the picture is larger than this driver's textures.
NoisyTextures texturesOf(const Image& noisy, bool& observed);

/// Such textures as an image of all these layers except the observation. The last row of the textures comes
/// first.
Image imageOf(const NoisyTextures& noisy, glm::ivec2 size);

// The variance filter: a joint bilateral filter whose width in each pixel follows the noise that its samples
// show (docs/design/denoising.md).

/// The version changes whenever the filter gives another picture.
inline constexpr std::string_view kVarianceFilter = "variance 5";

/// The filter's programs and textures, which belong to one context. That context must be current in every
/// call; framebuffer, viewport, program and texture units of it are changed.
class VarianceFilter {
 public:
  /// Throws RenderError if the driver fails, as filtered() does.
  explicit VarianceFilter(const ShaderSource& source);

  /// R, G and B of the picture to which `noisy`, of `size` pixels, converges. They are valid until the next
  /// call. All values must be finite. Without `observed` the samples count as independent. goOn() is called
  /// between passes, which are then waited for; if it returns false, the result is null. Without goOn nothing
  /// is waited for.
  const GlTexture* filtered(const NoisyTextures& noisy, glm::ivec2 size, bool observed,
                            const std::function<bool()>& goOn, PicturePasses& passes);

  /// Filters linear R, G, B, given its variance.Y and samples.Y, kGuideChannels, and kObservedChannel if it
  /// is there. Pixels whose colour is not finite are filled from their neighbours; other such values count as
  /// 0. Throws RenderError that names a layer if it is missing.
  Image filtered(const Image& noisy, PicturePasses& passes);

 private:
  void makeRoom(glm::ivec2 size);
  void summarize(const NoisyTextures& noisy, glm::ivec2 size, bool observed, PicturePasses& passes);

  GlProgram summary_;
  GlProgram prepare_;
  GlProgram noise_;
  GlProgram filter_;
  GlProgram compare_;
  GlProgram finish_;
  std::array<GlTexture, 3> summaries_;  ///< a texel each, in the order of shaders/denoise/denoise.glsl
  glm::ivec2 room_{0};                  ///< size of the textures below
  GlTexture light_;
  GlTexture seenLight_;
  GlTexture guides_;
  GlTexture variance_;
  GlTexture moved_;
  std::array<GlTexture, 2> turns_;
};

/// The filter in a thread and a context of its own: its programs are made while the picture is drawn, and
/// serve all pictures that follow.
class FilterThread {
 public:
  /// Begins, in a context of the same kind as `backend` (Context::backend) on that device. Throws
  /// std::system_error where there is no thread.
  FilterThread(const ShaderSource& source, const std::string& backend, const std::string& device);
  FilterThread(const FilterThread&) = delete;
  FilterThread& operator=(const FilterThread&) = delete;
  ~FilterThread();

  /// Waits for the programs. Throws RenderError where they cannot be had.
  void awaitPrograms() { ready_.get(); }

  /// The same as VarianceFilter::filtered(), once awaitPrograms() has returned. One call at a time.
  Image filtered(const Image& noisy);

  /// What the driver has said since the last call.
  std::vector<std::string> takeMessages() { return std::exchange(messages_, {}); }

 private:
  using Task = std::packaged_task<Image(VarianceFilter&, PicturePasses&, DebugLog&)>;
  void run(const ShaderSource& source, const std::string& backend, const std::string& device);

  std::promise<void> made_;
  std::shared_future<void> ready_ = made_.get_future().share();
  std::mutex mutex_;  ///< of the next three
  std::condition_variable changed_;
  bool ends_ = false;
  std::optional<Task> task_;  ///< what waits for the thread
  std::vector<std::string> messages_;
  std::thread thread_;  ///< the last, which uses all others
};

}  // namespace fragtrace
