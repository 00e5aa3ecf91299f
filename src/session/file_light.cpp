// SPDX-License-Identifier: MIT
#include "session/file_light.h"

#include <cmath>

#include "base/text.h"
#include "bvh/bvh.h"
#include "scene/camera.h"
#include "scene/fit.h"
#include "session/say.h"
#include "session/setup.h"

namespace fragtrace {

namespace {

/// Decides by the camera from which the file is seen without any option of it.
FileLight decideByFirstView(const Scene& scene, const Bvh& tree, const RenderOptions& options) {
  constexpr double kUsual = 1280.0 / 720.0;
  const CameraOverrides overrides = settledOverrides({}, scene);
  Camera camera = chooseCamera(scene.cameras, std::nullopt, overrides, scene.bounds);
  const double aspect = camera.aspectRatio > 0.0 ? camera.aspectRatio : kUsual;
  if (overrides.fit) {
    camera = fitted(camera, pointsToFit(scene, {}, {}, overrides).scene, aspect);
  }
  return decideLight({scene, tree}, camera, aspect, {options.light.lampUnits, hasMap(options)});
}

/// Returns true if the scene is the file's as it stands, with all that it shows.
bool isAsFile(const SceneSelection& selection) {
  return selection.hiddenNodes.empty() && selection.set.empty() && selection.lights.empty() &&
         !selection.animationTime && selection.animation.empty();
}

/// Returns true if nothing of the file could shine, whatever its pose.
bool staysDark(const RenderOptions& options, const Scene& scene) {
  if (isAsFile(options.selection)) return !mayShine(scene);
  return scene.lightSources.empty() && std::ranges::none_of(scene.materials, &Material::emissive);
}

/// Returns true if the options name a light.
bool isLitByUser(const RenderOptions& options) {
  return hasMap(options) || !options.selection.lights.empty();
}

/// Returns true if a light that the options name, or none, stands for that of a file without one.
bool isChosen(const RenderOptions& options) {
  return isLitByUser(options) || options.light.defaultLight == DefaultLight::None;
}

std::string percent(double share) { return std::to_string(std::lround(100.0 * share)) + " %"; }

}  // namespace

FileLight fileLightOf(const RenderOptions& options, const Scene& scene, const Bvh* tree,
                      std::shared_ptr<KeptDocument>* document) {
  if (staysDark(options, scene)) return {.own = OwnLight::None};
  if (hasMap(options) && scene.lightSources.empty()) return {};  // nothing hangs on its emission
  if (isAsFile(options.selection)) {
    if (tree != nullptr && !tree->nodes.empty()) return decideByFirstView(scene, *tree, options);
    return decideByFirstView(scene, buildSceneBvh(scene), options);
  }
  RenderOptions plain;
  plain.scene = options.scene;
  plain.selection = options.selection;
  takePose(plain.selection, {});
  plain.selection.lights.clear();
  plain.limits = options.limits;
  plain.limits.strict = false;
  const Scene standing = loadGltf(plain.scene, gltfOptionsOf(plain), document);
  return decideByFirstView(standing, buildSceneBvh(standing), options);
}

void setLampScale(Scene& scene, double lampScale) {
  scene.lampScale = lampScale;
  if (lampScale == 1.0) return;
  for (Light& light : scene.lights) {
    if (!scene.lightSources[light.source].added) light.intensity *= float(lampScale);
  }
}

OwnLight countedLight(const RenderOptions& options, const FileLight& light) {
  return isChosen(options) ? OwnLight::Enough : light.own;
}

double exposureOf(const RenderOptions& options, const FileLight& light) {
  const double exposure = exposureFor(light.mean);
  const bool alone = !isLitByUser(options) && countedLight(options, light) == OwnLight::Enough;
  return alone || exposure < 0.0 ? exposure : 0.0;
}

RenderOptions exposed(RenderOptions options, const FileLight& light) {
  const double exposure = exposureOf(options, light);
  if (!options.output.exposure && exposure != 0.0) options.output.exposure = exposure;
  return options;
}

std::string defaultLightReason(const RenderOptions& options, const FileLight& light) {
  switch (countedLight(options, light)) {
    case OwnLight::None:
      return "no light in the scene";
    case OwnLight::Dim:
      return "the scene's emission leaves " + percent(light.dark) + " of what is seen dark";
    default:
      return "";
  }
}

namespace {

/// Says what the user lights the scene by, with the file's lamps.
std::string lightOfUser(const RenderOptions& options, const FileLight& light) {
  std::vector<std::string> lights;
  if (options.light.studio) lights.emplace_back("the built-in studio");
  if (options.light.sky.on) lights.emplace_back("the sky");
  if (!options.light.hdriFile.empty()) lights.push_back("the environment " + options.light.hdriFile.string());
  if (!options.selection.lights.empty()) lights.emplace_back("--add-light");
  if (light.byLamps && options.selection.lights.empty()) lights.emplace_back("the file's own lamps");
  return joined(lights, " and ") + (lights.size() > 1 ? " light it" : " lights it");
}

/// Says who lights the scene by default, or which part of it its own light leaves out; what else lights it,
/// too, if that is asked for.
void sayWhoLights(const RenderOptions& options, const FileLight& light, bool always) {
  constexpr double kNoticed = 0.5;
  constexpr double kMuchMetal = 0.1;
  if (const std::string reason = defaultLightReason(options, light); !reason.empty()) {
    const bool studio = options.light.defaultLight == DefaultLight::Studio;
    say(options,
        reason + (studio ? ": the built-in studio lights it (--default-light)"
                         : ": a white environment that the camera does not see lights it (--default-light)"));
    return;
  }
  if (isLitByUser(options)) {
    if (always) say(options, lightOfUser(options, light));
    return;
  }
  if (light.own == OwnLight::None) {
    if (always) say(options, "nothing lights it (--default-light none)");
    return;
  }
  const std::string who =
      light.byLamps ? "the file's own lamps light it" : "the file's own emission lights it";
  if (light.dark > kNoticed)
    say(options, who + (light.byLamps ? ", and leave " : ", and leaves ") + percent(light.dark) +
                     " of what is seen dark (--studio adds light)");
  else if (light.byLamps && light.smoothMetal > kMuchMetal)
    say(options, who + ", and its smooth metal has nothing to reflect but them (--studio adds surroundings)");
  else if (always)
    say(options, who);
}

}  // namespace

void sayLight(const RenderOptions& options, const FileLight& light, bool always) {
  if (has(options.stages, Stage::Phong)) sayWhoLights(options, light, always || options.output.verbose);
  if (light.lampScale != 1.0 && options.light.lampUnits == LampUnits::Auto)
    say(options,
        formatted("as written, the file's lamps make what is seen %.0f times as bright as middle grey: they "
                  "are divided by %.0f, as watts taken for lumens (--lamp-units photometric does not)",
                  light.asWritten / kMiddleGrey, kLumensPerWatt));
  const double exposure = exposureOf(options, light);
  if (exposure == 0.0 || options.output.exposure) return;
  const double ratio = light.mean / kMiddleGrey;
  say(options,
      formatted("what is seen is %.3g times as %s as middle grey: .png, .jpg and window have an exposure of "
                "%.1f (--exposure 0 has none)",
                ratio > 1.0 ? ratio : 1.0 / ratio, ratio > 1.0 ? "bright" : "dark", exposure));
}

}  // namespace fragtrace
