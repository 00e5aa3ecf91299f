// SPDX-License-Identifier: MIT
// A scene on a device that is told new options: what renders, sequences and Python do between two pictures.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "bvh/scene_tree.h"
#include "gl/context.h"
#include "gl/gl.h"
#include "image/denoise/oidn.h"
#include "options/option_row.h"
#include "render/denoise.h"
#include "session/setup.h"
#include "session/tracer.h"

namespace fragtrace {

/// The device and the filter, which several pictures share.
struct Device {
  std::unique_ptr<Context> context;
  std::optional<DebugLog> driverLog;     ///< messages of the context's driver
  std::optional<ProgramCache> programs;  ///< those that the scene before has left to the next
  std::optional<OidnLibrary> oidn;
  std::unique_ptr<FilterThread> filter{};  ///< the variance filter, from the first picture that it filters on
};

/// A change of the scene that options do not say, such as a turntable's.
struct SceneChange {
  Renewal least = Renewal::None;  ///< what is renewed at least
  std::function<void(LoadedScene&)>
      change{};  ///< called with each scene that was loaded, before it is packed
};

/// Points and lines get their width from the camera and the picture's size.
bool seesStrokesAlike(const RenderOptions& a, const RenderOptions& b);

class Session {
 public:
  /// For so many pictures of about the same size; with the hash of the scene always, or where the options'
  /// output keeps it. `document` is the file of the first options, where it is read already.
  explicit Session(double pictures = 1.0, bool alwaysHashes = false,
                   std::shared_ptr<KeptDocument> document = {})
      : pictures_(pictures), alwaysHashes_(alwaysHashes), document_(std::move(document)) {}

  /// Makes scene and tracer as the options ask, and says which step was the earliest that had to be done
  /// again; steps that were not take no time in the statistics. The device's context is opened where there is
  /// none. Throws as loadScene(), makeContext() and makeTracer(); then the next call does what is missing.
  Renewal set(const RenderOptions& options, Device& device, Statistics& stats,
              const SceneChange& change = {});

  /// The scene of the latest options, and its tracer.
  LoadedScene& loaded() { return *loaded_; }
  bool isLoaded() const { return loaded_.has_value(); }
  Tracer& tracer() { return *tracer_; }
  bool hasTracer() const { return tracer_.has_value(); }

  /// Frees what only packing needs. Other programs need the scene to be loaded again.
  void releaseGeometry();
  /// The context is lost, and all that was on it.
  void forgetTracer() { tracer_.reset(); }

 private:
  Renewal renewalOf(const RenderOptions& options) const;
  void load(const RenderOptions& options, Statistics& stats);

  double pictures_;
  bool alwaysHashes_;
  std::shared_ptr<KeptDocument> document_;  ///< the animated file that is posed
  RenderOptions options_;                   ///< those of the scene that is loaded
  bool isSet_ = false;
  bool released_ = false;
  std::optional<LoadedScene> loaded_;
  std::optional<Tracer> tracer_;
  std::optional<RefittableTree> tree_;  ///< the latest tree, where the next pose may refit it
  Statistics prepared_;                 ///< of the latest renewal
};

}  // namespace fragtrace
