// SPDX-License-Identifier: MIT
#include "view/live/thumbnails.h"

#include <thread>
#include <utility>

#include "base/thread_name.h"
#include "scene/studio.h"
#include "view/picture/thumbnail.h"

namespace fragtrace {

void ThumbnailMaker::make(const std::vector<std::filesystem::path>& files, uint64_t memoryLimit) {
  ++*threads_;
  std::thread([cancelled = cancelled_, threads = threads_, files, memoryLimit, &exchange = exchange_] {
    nameThread("thumbnails");
    for (const std::filesystem::path& file : files) {
      EnvironmentThumbnail thumbnail{file, {}};
      try {
        if (*cancelled) break;
        thumbnail.image =
            thumbnailOf(file.empty() ? studioLight() : readLinearImage(file, memoryLimit).image);
      } catch (const std::exception&) {
        // A file that cannot be read is reported when it is chosen.
      }
      if (!*cancelled) exchange.deliver(std::move(thumbnail));
    }
    --*threads;
  }).detach();
}

void ThumbnailMaker::cancel() { *cancelled_ = true; }

}  // namespace fragtrace
