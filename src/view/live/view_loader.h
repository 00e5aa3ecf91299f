// SPDX-License-Identifier: MIT
// Files for the viewer: scenes and thumbnails, in threads of their own while another scene is drawn, and the
// picture to compare with.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>

#include "image/image.h"
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

// Small pictures of environment maps, for the viewer's list of them.

/// Makes them in threads of their own, which are not waited for at the end.
class ThumbnailMaker {
 public:
  explicit ThumbnailMaker(Exchange& exchange) : exchange_(exchange) {}
  ~ThumbnailMaker() { cancel(); }
  ThumbnailMaker(const ThumbnailMaker&) = delete;
  ThumbnailMaker& operator=(const ThumbnailMaker&) = delete;

  /// Delivers one for each file (empty: the studio).
  void make(const std::vector<std::filesystem::path>& files, uint64_t memoryLimit);
  /// Ends the work under way after the file that is read now.
  void cancel();
  bool busy() const { return *threads_ > 0; }

 private:
  Exchange& exchange_;
  std::shared_ptr<std::atomic<bool>> cancelled_ = std::make_shared<std::atomic<bool>>(false);
  std::shared_ptr<std::atomic<int>> threads_ = std::make_shared<std::atomic<int>>(0);
};

/// A picture that the viewer compares with: linear R, G, B, and A where it has that. Throws InputError for
/// what is no picture of linear radiance (.exr, .hdr, .pfm) or too large.
Image readReference(const std::filesystem::path& path, uint64_t memoryLimit);

}  // namespace fragtrace
