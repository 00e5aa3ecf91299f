// SPDX-License-Identifier: MIT
// Makes the picture of a side on the device from its film. While samples are few, it joins the picture of the
// view before, and filters.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include "gl/gl.h"
#include "image/denoise/oidn.h"
#include "render/denoise.h"
#include "render/picture_passes.h"
#include "session/tracer.h"
#include "view/exchange.h"

namespace fragtrace {

// Measures the time that the steps of a picture take, of the tracing thread and of the device.

class PassClock {
 public:
  /// With `waits`, each step ends when the device has done it: for measurements.
  explicit PassClock(bool waits) : waits_(waits) {}
  /// From now on, steps are timed by the device's own clock, and the times are known one picture later. This
  /// is for drivers that begin a step before the last one is done. From this call on, all calls need a
  /// context.
  void askDevice() { asksDevice_ = true; }
  /// Must be called before the context ends.
  void forgetDevice();
  /// Begins a time that belongs to no step.
  void restart();
  /// Counts the time since the last call to this step.
  void end(Pass pass);
  /// Returns the times of all steps since the last call.
  PassTimes take();

 private:
  struct Stamp {
    GlQuery time;
    std::optional<Pass> pass;  ///< the pass that ends there
  };
  void stamp(std::optional<Pass> pass);
  void readStamps();

  bool waits_;
  bool asksDevice_ = false;
  std::deque<Stamp> stamps_;  ///< the oldest first
  uint64_t stampedAt_ = 0;    ///< nanoseconds, of the last that was read
  std::chrono::steady_clock::time_point wall_;
  double cpuMs_ = 0.0;
  PassTimes times_;
};

/// The share of the filtered picture that shows at that many samples: all up to 64, none from 256 on.
double filteredShare(double samples);

/// From this number of samples per pixel on, the past is not used.
inline constexpr int kNoPastFrom = 16;

/// The memory that a side keeps on the device from picture to picture.
struct SideMemory {
  std::optional<Film> guides;  ///< guides of the present view
  int guideSamples = 0;        ///< samples of the guides; 0: they are drawn again
  SeenPicture past;            ///< picture of the view before
  SeenPicture present;         ///< shown last, before it was filtered

  /// Must be called when the camera or the resolution changes.
  void turn();
  /// Must be called before a completely different picture: forgets the past.
  void forget();
};

/// A picture as the window shows it: RGBA32F, linear, the first row at the top.
struct ShownTexture {
  GlTexture texture;
  glm::ivec2 size{0};     ///< exact size of the picture
  void* ready = nullptr;  ///< a fence, of one that was handed over
};

/// The settings that make a side's picture.
struct Showing {
  bool filtered = false;
  bool byOidn = false;      ///< Open Image Denoise filters, and must be there; else the variance filter
  int samples = 0;          ///< per pixel
  bool past = true;         ///< uses the picture of the view before
  bool cones = false;       ///< guides read textures by ray cones, as the film's samples did
  double expectedMs = 0.0;  ///< time of layers and variance filter, 0: not known
};

/// R, G, B and A.
Image imageOf(const ShownTexture& shown);

class PictureMaker {
 public:
  /// `oidn` and the clock must outlive this. Needs a context, as all calls do; throws RenderError, as they
  /// do.
  PictureMaker(const std::filesystem::path& shaderFolder, const std::optional<OidnLibrary>& oidn,
               PassClock& clock);

  /// Shows the film in `into`, which was drawn by `tracer`, whose one feature is the guides that a filter
  /// needs, drawn where they are not there yet. False when goOn() said no.
  bool show(const Film& film, const Showing& showing, const RenderOptions& options, Tracer& tracer,
            const View& view, SideMemory& memory, ShownTexture& into, const std::function<bool()>& goOn);

  /// Compiles the filter, if that was not done yet.
  void prepareFilter();

  /// Shows a picture of the host: R, G, B and, if there is one, A.
  void show(const Image& image, ShownTexture& into) const;

  /// The sums over all pixels: samples, rays, and pixels in which the driver ended a loop.
  glm::vec3 count(const Film& film);

 private:
  bool drawGuides(const Showing& showing, glm::ivec2 size, Tracer& tracer, const View& view,
                  SideMemory& memory, const std::function<bool()>& goOn);
  const GlTexture* filtered(const Showing& showing, const RenderOptions& options, const SeenPicture& present,
                            const std::function<bool()>& goOn);

  ShaderSource source_;
  const std::optional<OidnLibrary>& oidn_;
  PassClock& clock_;
  PicturePasses passes_;
  SeenPasses seen_;
  std::unique_ptr<VarianceFilter> filter_;  ///< made when it is first needed
  GlTexture counted_;                       ///< a texel
  // These are used within one call only.
  glm::ivec2 room_{0};
  GlTexture raw_;
  NoisyTextures fresh_;
  GlTexture denoised_;
};

}  // namespace fragtrace
