// SPDX-License-Identifier: MIT
// The viewer's programs, each with its scene on the device: made by the same steps as for `render`, so that
// they draw the same, and kept for being asked for again.
#pragma once

#include <list>
#include <memory>

#include "session/tracer.h"

namespace fragtrace {

struct ViewProgram {
  RenderOptions options;  ///< as far as a program depends on them
  Tracer tracer;
  std::string variant;
  size_t bytes = 0;   ///< on the device
  std::string error;  ///< why it cannot be had; empty: it can
};

class ViewPrograms {
 public:
  /// The scene must outlive this, and its tree is changed to what the programs need.
  ViewPrograms(const Context& context, LoadedScene& loaded, const RenderOptions& options)
      : context_(context), loaded_(loaded), treeOptions_(options) {}

  bool has(const RenderOptions& options) const;
  /// Compiles it if it is not there; what failed stays failed until forget().
  std::shared_ptr<ViewProgram> of(const RenderOptions& options);
  /// Makes all anew when they are asked for again.
  void forget() { programs_.clear(); }
  /// The scene and its tree are those of another time of its animation, loaded with these options: programs
  /// that somebody holds draw it from now on, all others are made anew when they are asked for again. Throws
  /// as replaceScene().
  void showPose(const RenderOptions& options);

 private:
  std::shared_ptr<ViewProgram> make(const RenderOptions& part);

  const Context& context_;
  LoadedScene& loaded_;
  RenderOptions treeOptions_;                         ///< that the scene's tree was built for
  std::list<std::shared_ptr<ViewProgram>> programs_;  ///< the latest used first
};

}  // namespace fragtrace
