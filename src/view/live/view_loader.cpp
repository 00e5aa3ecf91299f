// SPDX-License-Identifier: MIT
#include "view/live/view_loader.h"

#include <utility>

#include "base/errors.h"
#include "gltf/edit/changed_file.h"
#include "gltf/edit/factors.h"
#include "image/channels.h"
#include "scene/studio.h"
#include "session/environment.h"
#include "session/say.h"
#include "view/camera_controller.h"
#include "view/files.h"
#include "view/pictures.h"

namespace fragtrace {

namespace {

struct Cancelled {};

/// What the window knows of a scene.
ViewedScene viewedOf(const LoadedScene& loaded, const Statistics& stats, const RenderOptions& options) {
  ViewedScene viewed;
  viewed.options = options;
  // From now on the camera is named by its index, like cameras that are chosen in the window.
  viewed.options.camera.index = loaded.cameraIndex;
  viewed.options.selection.camera.clear();
  // A camera that was placed by the scene's vertices is also kept by its numbers.
  if (loaded.overrides.fit) {
    if (loaded.view.shadowFade != glm::dvec2(0.0)) viewed.options.light.shadowFade = loaded.view.shadowFade;
    viewed.options.camera.overrides = overridesOf(poseOf(loaded.camera, loaded.framed));
  }
  viewed.camera = loaded.camera;
  viewed.cameras = loaded.scene.cameras;
  viewed.bounds = loaded.scene.bounds;
  viewed.present = traitsOf(loaded.scene, loaded.environment);
  viewed.description = stats.scene;
  viewed.light = loaded.light;
  const double exposure = exposureOf(viewed.options, loaded.light);
  if (exposure != 0.0) viewed.exposure = exposure;
  viewed.refersToFiles = loaded.scene.refersToFiles;
  viewed.surroundings = loaded.environment.kind;
  viewed.environments = environmentsNear(options);
  viewed.nodes = loaded.scene.nodes;
  viewed.materials = loaded.scene.materials;
  viewed.lights = loaded.scene.lightSources;
  viewed.sceneNames = loaded.scene.sceneNames;
  viewed.materialVariants = loaded.scene.materialVariants;
  viewed.animationNames = loaded.scene.animationNames;
  viewed.animationSeconds = loaded.scene.animationSeconds;
  return viewed;
}

}  // namespace

LoadResult loadViewed(const RenderOptions& options, Exchange& exchange, const BackgroundJob& job) {
  LoadResult result;
  result.viewed.options = options;
  const auto progress = [&](const std::string& step, double fraction) {
    const LoadStatus status{true, options.scene.filename().string(), step, fraction};
    if (!job.report([&] { exchange.set(&TraceStatus::load, status); })) throw Cancelled();
  };
  try {
    SceneBefore before;
    before.document = &result.document;
    // Numbers that the user sets are set later: the window shows the file's, too.
    RenderOptions plain = options;
    plain.selection.set.clear();
    if (!options.selection.set.empty()) checkChange(options.scene, options.selection.set);
    for (const std::string& warning : warningsOf(options.selection.set)) say(options, "warning: " + warning);
    Statistics stats;
    auto loaded = std::make_unique<LoadedScene>(loadScene(plain, stats, progress, FilmOf::Picture, before));
    RenderOptions unlit = plain;
    unlit.light.studio = unlit.light.sky.on = false;
    unlit.light.hdriFile.clear();
    const FileLight light =
        hasMap(options) ? fileLightOf(unlit, loaded->scene, nullptr, &result.document) : loaded->light;
    result.viewed = viewedOf(*loaded, stats, options);
    result.viewed.defaultLight = light.own != OwnLight::Enough;
    progress("packing", 0.9);
    result.scene = std::move(loaded);
  } catch (const Cancelled&) {
  } catch (...) {
    result.error = std::current_exception();
  }
  return result;
}

void makeThumbnails(const std::vector<std::filesystem::path>& files, uint64_t memoryLimit, Exchange& exchange,
                    const BackgroundJob& job) {
  for (const std::filesystem::path& file : files) {
    if (job.cancelled()) return;
    EnvironmentThumbnail thumbnail{file, {}};
    try {
      thumbnail.image = thumbnailOf(file.empty() ? studioLight() : readLinearImage(file, memoryLimit).image);
    } catch (const std::exception&) {
      // A file that cannot be read is reported when it is chosen.
    }
    job.report([&] { exchange.deliver(std::move(thumbnail)); });
  }
}

Image readReference(const std::filesystem::path& path, uint64_t memoryLimit) {
  LinearImage read = readLinearImage(path, memoryLimit);
  if (read.wasEncoded)
    throw InputError(path.string() +
                     ": holds the colours of a display; to compare with, an .exr, .hdr or .pfm "
                     "of linear radiance is needed");
  const Image whole = wholeOf(std::move(read.image));
  const auto color = findColorChannels(whole);
  if (!color) throw InputError(path.string() + ": has no colour");
  Image picture{whole.width, whole.height, {"R", "G", "B"}, {}, {}};
  std::vector<size_t> taken(color->begin(), color->end());
  if (const std::optional<size_t> alpha = findChannel(whole, "A")) {
    picture.channels.emplace_back("A");
    taken.push_back(*alpha);
  }
  const size_t count = whole.channelCount();
  picture.values.reserve(whole.values.size() / count * picture.channelCount());
  for (size_t first = 0; first < whole.values.size(); first += count) {
    for (const size_t channel : taken) picture.values.push_back(whole.values[first + channel]);
  }
  return picture;
}

}  // namespace fragtrace
