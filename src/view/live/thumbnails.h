// SPDX-License-Identifier: MIT
// Small pictures of environment maps, for the viewer's list of them.
#pragma once

#include <atomic>
#include <memory>

#include "view/exchange.h"

namespace fragtrace {

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

}  // namespace fragtrace
