// SPDX-License-Identifier: MIT
// Scenes for the viewer, loaded in a thread of their own while another is drawn.
#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <optional>

#include "session/setup.h"
#include "view/exchange.h"

namespace fragtrace {

/// A load that has ended: the scene, or why there is none.
struct LoadResult {
  RenderOptions options;
  std::unique_ptr<LoadedScene> scene;
  std::shared_ptr<KeptDocument> document;  ///< the document for poses, if it is animated
  Statistics stats;
  std::exception_ptr error;
  bool ownLight = true;                             ///< the scene needs no default light
  std::vector<std::filesystem::path> environments;  ///< environmentsNear()
};

class SceneLoader {
 public:
  explicit SceneLoader(Exchange& exchange) : exchange_(exchange) {}

  /// Begins; what was being loaded before is dropped.
  void start(const RenderOptions& options);
  void cancel();
  /// Returns the load that has ended since the last call, if one has.
  std::optional<LoadResult> take();
  /// Returns true if a thread still works, even in vain.
  bool busy() const;

 private:
  struct Job;
  Exchange& exchange_;
  std::shared_ptr<Job> job_;
  std::shared_ptr<std::atomic<int>> threads_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace fragtrace
