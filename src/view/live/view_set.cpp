// SPDX-License-Identifier: MIT
// Numbers of the file that the viewer's user sets: their way into the scene that is drawn, and into a file.
#include <algorithm>

#include "gltf/edit/changed_file.h"
#include "gltf/edit/factors.h"
#include "session/file_light.h"
#include "view/live/view_tracer.h"

namespace fragtrace {

bool ViewTracer::setSurfaces(const TraceRequest& request) {
  const SceneSelection& wanted = request.sides[0].selection;
  const auto isText = [](const RenderOptions& side) {
    return side.device.traversal == TraversalMethod::Literals;
  };
  // An animation may drive the same numbers, and lines are built again for another camera.
  if (!sameMoment(wanted, loadedOptions_.selection) || wanted.animationTime ||
      !loaded_->scene.strokes.empty() || std::ranges::any_of(request.sides, isText))
    return false;
  const auto traits = [&](const Scene& scene) { return traitsOf(scene, loaded_->environment); };
  const TraitSet before = traits(loaded_->scene);
  programs_->waitForCompiler();
  if (!setByEye(loaded_->scene, fileMaterials_, fileLights_, wanted.set) || traits(loaded_->scene) != before)
    return false;
  takePose(loadedOptions_.selection, wanted);
  programs_->showSurfaces(wanted);
  return true;
}

namespace {

/// The option by which `render` lights the file that holds the numbers as it is shown; empty: none is needed.
std::string lightToName(const RenderOptions& options, const LoadedScene& loaded) {
  if (hasMap(options) || options.light.defaultLight == DefaultLight::None) return "";
  RenderOptions saved = options;
  takePose(saved.selection, {});
  const bool shines = fileLightOf(saved, loaded.scene, nullptr, nullptr).own == OwnLight::Enough;
  if (loaded.environment.kind == Surroundings::Map) return shines ? "--studio" : "";
  return loaded.environment.kind == Surroundings::None && !shines ? "--no-default-light" : "";
}

}  // namespace

void ViewTracer::saveModel(const std::filesystem::path& path) {
  const std::vector<SetNumber>& set = request_.sides.front().selection.set;
  try {
    writeChanged(loadedOptions_.scene, path, set);
    exchange_.deliver(SavedModel{set});
    exchange_.deliver("wrote " + path.string());
    if (const std::string light = lightToName(loadedOptions_, *loaded_); !light.empty())
      exchange_.deliver("the emission that was set decides how that file is lit: render it with " + light +
                        " to see it as here");
  } catch (const std::exception& error) {
    exchange_.deliver(std::string("not written: ") + error.what());
  }
}

}  // namespace fragtrace
