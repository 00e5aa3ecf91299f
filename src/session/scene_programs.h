// SPDX-License-Identifier: MIT
// Programs that draw one scene, each with its copy on the device. They are made by the same steps as for
// `render`, so they draw the same, and are kept for later.
#pragma once

#include <functional>
#include <future>
#include <list>
#include <memory>
#include <optional>
#include <thread>

#include "gl/context.h"
#include "options/option_row.h"
#include "session/tracer.h"

namespace fragtrace {

struct SceneProgram {
  RenderOptions options;  ///< the options on which a program depends
  Tracer tracer;
  std::string variant;
  bool asksForCones = false;           ///< levels and the programs of Tracer::cones are made, or were
  bool hasCones = false;               ///< they are there
  size_t bytes = 0;                    ///< on the device
  std::string error;                   ///< why it cannot be had; empty: it can
  std::vector<std::string> driverLog;  ///< messages of the context that compiled it, if that was another one
};

/// Lets programs be compiled while others draw.
struct CompileAside {
  OutsideContext context;      ///< shares its objects with the one that draws
  std::function<void()> came;  ///< called in the compiling thread, once a program is there
};

class ScenePrograms {
 public:
  /// The scene must outlive this, and its tree is changed to what the programs need.
  ScenePrograms(const Context& context, LoadedScene& loaded, const RenderOptions& options,
                std::optional<CompileAside> aside)
      : context_(context), loaded_(loaded), treeOptions_(options), aside_(std::move(aside)) {}
  ScenePrograms(const ScenePrograms&) = delete;
  ScenePrograms& operator=(const ScenePrograms&) = delete;

  bool has(const RenderOptions& options) const;
  /// Compiles it if it is not there; what failed stays failed until forget().
  std::shared_ptr<SceneProgram> of(const RenderOptions& options);
  /// Returns the same as of(), but null if the program compiles in the background. That begins now unless
  /// another one does.
  std::shared_ptr<SceneProgram> soon(const RenderOptions& options);
  /// Begins to make what a moving picture of the program needs to read textures by ray cones, next to other
  /// drawing. Does nothing while another program compiles.
  void addCones(const std::shared_ptr<SceneProgram>& program);
  /// Returns true if a program that was compiled aside has come since the last call.
  bool takeCompiled();
  bool compiling() const { return coming_.valid(); }
  /// Waits for what is compiled aside, which reads the scene: it comes before every change of the scene.
  void waitForCompiler();
  /// Makes all again when they are asked for again.
  void forget();
  /// Programs that somebody holds draw the scene from now on, of which that much has changed: surroundings
  /// of the same kind, surfaces, or all of it; from Renewal::Pose on with another tree, built for `options`.
  /// All others are made again when they are asked for again, as is one whose text holds a scene with other
  /// surfaces. Throws as replaceScene(), and std::logic_error if the scene was changed before
  /// waitForCompiler().
  void show(Renewal renewed, const RenderOptions& options);
  /// Returns true if a program's text has held the whole scene.
  bool heldText() const { return heldText_; }

 private:
  std::shared_ptr<SceneProgram> make(const RenderOptions& part) const;
  std::shared_ptr<SceneProgram> makeAside(const RenderOptions& part) const;
  void startAside(std::function<std::shared_ptr<SceneProgram>()> make);
  void makeCones(const SceneProgram& program) const;
  void keep(std::shared_ptr<SceneProgram> program);
  void replace(SceneProgram& program, bool surfacesAlone) const;

  const Context& context_;
  LoadedScene& loaded_;
  RenderOptions treeOptions_;                          ///< the scene's tree was built for these
  std::list<std::shared_ptr<SceneProgram>> programs_;  ///< the latest used first
  std::optional<CompileAside> aside_;
  std::future<std::shared_ptr<SceneProgram>> coming_;
  bool compiled_ = false;
  bool heldText_ = false;
  std::jthread compiler_;  ///< ends before what it uses
};

}  // namespace fragtrace
