// SPDX-License-Identifier: MIT
// A scene on a device that is told new options: what all front ends do between two pictures.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "bvh/scene_tree.h"
#include "gl/context.h"
#include "gl/gl.h"
#include "image/denoise/oidn.h"
#include "options/option_row.h"
#include "render/denoise.h"
#include "session/scene_programs.h"
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
  void forgetTracer() {
    tracer_.reset();
    programs_.reset();
  }

  // The viewer draws a scene by several programs, loads it in another thread, and calls these instead of
  // set().

  /// Takes over a scene of these options that is loaded without the numbers that they set, and the document
  /// that was read for it. There are no programs yet.
  void open(LoadedScene loaded, std::shared_ptr<KeptDocument> document, const RenderOptions& options);
  /// From now on programs can be had, in this context, which must outlive them; the session is not moved any
  /// more.
  void openPrograms(const Context& context, std::optional<CompileAside> aside);
  ScenePrograms& programs() { return *programs_; }
  bool hasPrograms() const { return programs_ != nullptr; }
  /// The options that the scene has now; all but sky, numbers and pose, and of the camera what gives strokes
  /// their width, are those of open().
  const RenderOptions& options() const { return options_; }
  /// Gives the scene, which its programs then draw, the sky, the numbers and the pose of these options. With
  /// `keepsStrokes` another camera alone does not renew its strokes. Returns Renewal::None, or the last step
  /// that was done. Throws as loadScene() and ScenePrograms::show(); where that is the former, the scene
  /// stays, until it is asked for another one.
  Renewal renewScene(const RenderOptions& options, bool keepsStrokes);
  /// The options, with front-to-back instead of an automatic traversal for a scene that is posed again: its
  /// triangles are no shader text, which would be compiled each time.
  RenderOptions asPosed(RenderOptions options) const;

 private:
  Renewal renewalOf(const RenderOptions& options) const;
  void load(const RenderOptions& options, FilmOf film, Statistics& stats);
  void relight(const RenderOptions& options);
  bool setSurfaces(const RenderOptions& options);

  double pictures_;
  bool alwaysHashes_;
  std::shared_ptr<KeptDocument> document_;  ///< the animated file that is posed
  RenderOptions options_;                   ///< those of the scene that is loaded
  bool isSet_ = false;
  bool released_ = false;
  std::optional<LoadedScene> loaded_;
  std::optional<Tracer> tracer_;
  std::optional<RefittableTree> tree_;   ///< the latest tree, where the next pose may refit it
  Statistics prepared_;                  ///< of the latest renewal
  std::vector<Material> fileMaterials_;  ///< those of open(), without what the user sets
  std::vector<LightSource> fileLights_;
  std::unique_ptr<ScenePrograms> programs_;
};

}  // namespace fragtrace
