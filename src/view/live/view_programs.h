// SPDX-License-Identifier: MIT
// The viewer's programs, each with its scene on the device. They are made by the same steps as for `render`,
// so they draw the same, and are kept for later.
#pragma once

#include <functional>
#include <future>
#include <list>
#include <memory>
#include <optional>
#include <thread>

#include "gl/context.h"
#include "session/tracer.h"

namespace fragtrace {

struct ViewProgram {
  RenderOptions options;  ///< the options on which a program depends
  Tracer tracer;
  std::string variant;
  bool asksForCones = false;           ///< levels and the programs of Tracer::cones are made, or were
  bool hasCones = false;               ///< they are there
  size_t bytes = 0;                    ///< on the device
  std::string error;                   ///< why it cannot be had; empty: it can
  std::vector<std::string> driverLog;  ///< messages of the context that compiled it, if that was another one
};

/// What has changed in the scene: surroundings of the same kind, numbers of surfaces and lights, or all that
/// an animation moves, and its tree.
enum class Renewed : uint8_t { Surroundings, Surfaces, Pose };

/// Lets programs be compiled while others draw.
struct CompileAside {
  OutsideContext context;      ///< shares its objects with the one that draws
  std::function<void()> came;  ///< called in the compiling thread, once a program is there
};

class ViewPrograms {
 public:
  /// The scene must outlive this, and its tree is changed to what the programs need.
  ViewPrograms(const Context& context, LoadedScene& loaded, const RenderOptions& options,
               std::optional<CompileAside> aside)
      : context_(context), loaded_(loaded), treeOptions_(options), aside_(std::move(aside)) {}
  ViewPrograms(const ViewPrograms&) = delete;
  ViewPrograms& operator=(const ViewPrograms&) = delete;

  bool has(const RenderOptions& options) const;
  /// Compiles it if it is not there; what failed stays failed until forget().
  std::shared_ptr<ViewProgram> of(const RenderOptions& options);
  /// Returns the same as of(), but null if the program compiles in the background. That begins now unless
  /// another one does.
  std::shared_ptr<ViewProgram> soon(const RenderOptions& options);
  /// Begins to make what a moving picture of the program needs to read textures by ray cones, next to other
  /// drawing. Does nothing while another program compiles.
  void addCones(const std::shared_ptr<ViewProgram>& program);
  /// Returns true if a program that was compiled aside has come since the last call.
  bool takeCompiled();
  bool compiling() const { return coming_.valid(); }
  /// Waits for what is compiled aside, which reads the scene: it comes before every change of the scene.
  void waitForCompiler();
  /// Makes all again when they are asked for again.
  void forget();
  /// Programs that somebody holds draw the scene, loaded or changed with these options, from now on; all
  /// others are made again when they are asked for again, as is one whose text holds a scene with other
  /// surfaces. Throws as replaceScene(), and std::logic_error if the scene was changed before
  /// waitForCompiler().
  void show(Renewed renewed, const RenderOptions& options);

 private:
  std::shared_ptr<ViewProgram> make(const RenderOptions& part) const;
  std::shared_ptr<ViewProgram> makeAside(const RenderOptions& part) const;
  void startAside(std::function<std::shared_ptr<ViewProgram>()> make);
  void makeCones(const ViewProgram& program) const;
  void keep(std::shared_ptr<ViewProgram> program);
  void replace(ViewProgram& program, bool surfacesAlone) const;

  const Context& context_;
  LoadedScene& loaded_;
  RenderOptions treeOptions_;                         ///< the scene's tree was built for these
  std::list<std::shared_ptr<ViewProgram>> programs_;  ///< the latest used first
  std::optional<CompileAside> aside_;
  std::future<std::shared_ptr<ViewProgram>> coming_;
  bool compiled_ = false;
  std::jthread compiler_;  ///< ends before what it uses
};

}  // namespace fragtrace
