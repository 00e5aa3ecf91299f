// SPDX-License-Identifier: MIT
// What the viewer shows of a side while its samples are few: filtered, and with what its camera saw before.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "denoise/oidn_library.h"
#include "render/denoise.h"
#include "session/tracer.h"
#include "view/picture/reproject.h"

namespace fragtrace {

/// How much of the filter shows at that many samples: all up to 64, none from 256 on.
double filteredShare(double samples);

/// What a side keeps from picture to picture.
struct SideMemory {
  Image guides;                        ///< kGuideChannels of the present view; may be empty
  int guideSamples = 0;                ///< of these
  std::optional<SeenPicture> past;     ///< of the view before
  std::optional<SeenPicture> present;  ///< published last, before it was filtered

  /// The camera or the resolution is another one.
  void turn();
};

class ViewDenoiser {
 public:
  /// `oidn` must outlive this.
  ViewDenoiser(const std::filesystem::path& shaderFolder, const std::optional<OidnLibrary>& oidn)
      : shaderFolder_(shaderFolder), oidn_(oidn) {}

  /// R, G, B and A as they are to be shown. `drawn` has R, G, B, A, samples.Y and variance.Y of so many
  /// samples per pixel, drawn by `tracer`, whose one feature is the guides, drawn where they are not there
  /// yet. By Open Image Denoise, which must be there, or by variance. Nothing when goOn() said no. Throws
  /// RenderError.
  std::optional<Image> shown(const Image& drawn, int samples, const RenderOptions& options, bool byOidn,
                             Tracer& tracer, const View& view, SideMemory& memory,
                             const std::function<bool()>& goOn);

 private:
  bool drawGuides(glm::ivec2 size, int samples, Tracer& tracer, const View& view, SideMemory& memory,
                  const std::function<bool()>& goOn);

  std::filesystem::path shaderFolder_;
  const std::optional<OidnLibrary>& oidn_;
  std::unique_ptr<VarianceFilter> filter_;  ///< made when it is first needed
};

}  // namespace fragtrace
