// SPDX-License-Identifier: MIT
#include "view/live/view_loader.h"

#include <algorithm>
#include <mutex>
#include <thread>
#include <utility>

#include "base/errors.h"
#include "base/thread_name.h"
#include "gltf/edit/changed_file.h"
#include "gltf/edit/factors.h"
#include "image/channels.h"
#include "scene/studio.h"
#include "session/file_light.h"
#include "session/say.h"
#include "view/camera_controller.h"
#include "view/environments.h"
#include "view/pictures.h"

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
    nameThread("load");
    LoadResult result;
    result.options = options;
    const auto progress = [&](const std::string& step, double fraction) {
      const std::lock_guard lock(job->mutex);
      if (job->cancelled) throw Cancelled();
      exchange.set(&TraceStatus::load, {true, options.scene.filename().string(), step, fraction});
    };
    try {
      SceneBefore before;
      before.document = &result.document;
      // Numbers that the user sets are set later: the window shows the file's, too.
      RenderOptions plain = options;
      plain.selection.set.clear();
      if (!options.selection.set.empty()) checkChange(options.scene, options.selection.set);
      for (const std::string& warning : warningsOf(options.selection.set))
        say(options, "warning: " + warning);
      result.scene =
          std::make_unique<LoadedScene>(loadScene(plain, result.stats, progress, FilmOf::Picture, before));
      RenderOptions unlit = plain;
      unlit.light.studio = unlit.light.sky.on = false;
      unlit.light.hdriFile.clear();
      const LoadedScene& loaded = *result.scene;
      const FileLight light =
          hasMap(options) ? fileLightOf(unlit, loaded.scene, nullptr, &result.document) : loaded.light;
      result.ownLight = light.own == OwnLight::Enough;
      result.environments = environmentsNear(options);
      // From now on the camera is named by its index, like cameras that are chosen in the window.
      result.options.camera.index = result.scene->cameraIndex;
      result.options.selection.camera.clear();
      // A camera that was placed by the scene's vertices is also kept by its numbers.
      if (result.scene->overrides.fit) {
        if (result.scene->view.shadowFade != glm::dvec2(0.0))
          result.options.light.shadowFade = result.scene->view.shadowFade;
        result.options.camera.overrides = overridesOf(poseOf(result.scene->camera, result.scene->framed));
      }
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
    exchange.wakeTracer();
    --*threads;
  }).detach();
}

void SceneLoader::cancel() {
  if (job_) {
    // From here on the job reports nothing more.
    const std::lock_guard lock(job_->mutex);
    job_->cancelled = true;
  }
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

Image readReference(const std::filesystem::path& path, uint64_t memoryLimit) {
  LinearImage read = readLinearImage(path, memoryLimit);
  if (read.wasEncoded)
    throw InputError(path.string() +
                     ": holds the colours of a display; to compare with, an .exr, .hdr or .pfm "
                     "of linear radiance is needed");
  const Image whole = wholeOf(std::move(read.image));
  const auto color = findColorChannels(whole);
  if (!color) throw InputError(path.string() + ": has no colour");
  const auto alpha = std::ranges::find(whole.channels, "A");
  Image picture{whole.width, whole.height, {"R", "G", "B"}, {}, {}};
  if (alpha != whole.channels.end()) picture.channels.emplace_back("A");
  const size_t count = whole.channelCount();
  picture.values.reserve(whole.values.size() / count * picture.channelCount());
  for (size_t first = 0; first < whole.values.size(); first += count) {
    for (const size_t channel : *color) picture.values.push_back(whole.values[first + channel]);
    if (alpha != whole.channels.end())
      picture.values.push_back(whole.values[first + size_t(alpha - whole.channels.begin())]);
  }
  return picture;
}

}  // namespace fragtrace
