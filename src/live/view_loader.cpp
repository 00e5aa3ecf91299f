// SPDX-License-Identifier: MIT
#include "live/view_loader.h"

#include "view/camera_controller.h"

#include <atomic>
#include <mutex>
#include <thread>

namespace fragtrace {

namespace {

struct Cancelled {};

}  // namespace

struct SceneLoader::Job {
  std::atomic<bool> cancelled = false;
  std::mutex mutex;
  std::optional<LoadResult> result;
};

void SceneLoader::start(const RenderOptions& options) {
  cancel();
  job_ = std::make_shared<Job>();
  ++*threads_;
  // Detached: a load that nobody waits for any more ends at its next step.
  std::thread([job = job_, threads = threads_, options, &exchange = exchange_] {
    LoadResult result{options, nullptr, {}, nullptr};
    const auto progress = [&](const char* step, double fraction) {
      if (job->cancelled) throw Cancelled();
      exchange.tellLoad({true, options.scene.filename().string(), step, fraction});
    };
    try {
      result.scene = std::make_unique<LoadedScene>(loadScene(options, result.stats, progress));
      // From now on it is told by its index, as others are that are chosen in the window.
      result.options.cameraIndex = result.scene->cameraIndex;
      result.options.selection.camera.clear();
      // So is a camera that was placed by the scene's vertices.
      if (result.options.camera.fit != Fit::None)
        result.options.camera = overridesOf(poseOf(result.scene->camera, result.scene->scene.bounds));
      progress("packing", 0.9);
    } catch (const Cancelled&) {
      result.scene.reset();
    } catch (...) {
      result.error = std::current_exception();
    }
    if (!job->cancelled) {
      const std::lock_guard lock(job->mutex);
      job->result = std::move(result);
    }
    exchange.nudge();
    --*threads;
  }).detach();
}

void SceneLoader::cancel() {
  if (job_) job_->cancelled = true;
  job_.reset();
}

std::optional<LoadResult> SceneLoader::take() {
  if (!job_) return std::nullopt;
  std::optional<LoadResult> result;
  {
    const std::lock_guard lock(job_->mutex);
    result = std::move(job_->result);
    job_->result.reset();
  }
  if (result) job_.reset();
  return result;
}

bool SceneLoader::busy() const { return *threads_ > 0; }

}  // namespace fragtrace
