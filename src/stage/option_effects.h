// SPDX-License-Identifier: MIT
// What each option changes: one table row a member of RenderOptions. Which options a picture, a loaded scene,
// a program or the attributes of a file depend on follows from it.
#pragma once

#include <functional>
#include <initializer_list>
#include <tuple>

#include "stage/effect.h"
#include "stage/render_options.h"

namespace fragtrace {

/// The earliest step that has to be done again for a picture of a scene when the option changes.
enum class Renewal : uint8_t {
  None,     ///< aim() and drawing
  Program,  ///< makeTracer(): the program, and what it reads of the scene
  Scene     ///< loadScene()
};

/// `member` is a pointer to a member of RenderOptions, or a function that takes the options to a reference.
template <typename Member>
struct OptionRow {
  Member member;
  Effect effect;
  Renewal renewal = Renewal::None;
  const char* attribute = nullptr;  ///< its name in the attribute fragtrace:settings, where it stands there
};

template <typename Member>
OptionRow(Member, Effect, Renewal = Renewal::None, const char* = nullptr) -> OptionRow<Member>;

/// A member without a row counts as Effect::Picture and Renewal::Scene: what is forgotten here costs time,
/// never a wrong picture. Stages have their effects in stageRows().
inline constexpr std::tuple kOptionRows{OptionRow{[](auto& o) -> auto& {return o.scene;
}  // namespace fragtrace
, Effect::Picture, Renewal::Scene
}
, OptionRow{[](auto& o) -> auto& {return o.output.file;
}
, Effect::Report
}
, OptionRow{[](auto& o) -> auto& {return o.camera.resolution;
}
, Effect::Picture
}
, OptionRow{[](auto& o) -> auto& {return o.camera.region;
}
, Effect::Picture
}
, OptionRow{[](auto& o) -> auto& {return o.sampling.spp;
}
, Effect::Count
}
, OptionRow{[](auto& o) -> auto& {return o.sampling.sampleOffset;
}
, Effect::Noise
}
, OptionRow{[](auto& o) -> auto& {return o.sampling.seed;
}
, Effect::Noise
}
, OptionRow{[](auto& o) -> auto& {return o.sampling.bounces;
}
, Effect::Picture, Renewal::None, "bounces"
}
, OptionRow{[](auto& o) -> auto& {return o.sampling.rouletteDepth;
}
, Effect::Noise, Renewal::None, "rr_depth"
}
, OptionRow{[](auto& o) -> auto& {return o.sampling.clampIndirect;
}
, Effect::Picture, Renewal::Program, "clamp_indirect"
}
, OptionRow{[](auto& o) -> auto& {return o.light.selection;
}
, Effect::Noise, Renewal::Program
}
, OptionRow{[](auto& o) -> auto& {return o.light.reuse;
}
, Effect::Noise, Renewal::Program
}
, OptionRow{[](auto& o) -> auto& {return o.light.caustics;
}
, Effect::Picture, Renewal::Program
}
, OptionRow{[](auto& o) -> auto& {return o.sampling.noise;
}
, Effect::Count
}
, OptionRow{[](auto& o) -> auto& {return o.sampling.seconds;
}
, Effect::Count
}
, OptionRow{[](auto& o) -> auto& {return o.camera.index;
}
, Effect::View
}
, OptionRow{[](auto& o) -> auto& {return o.camera.overrides;
}
, Effect::View
}
, OptionRow{[](auto& o) -> auto& {return o.camera.lens;
}
, Effect::Picture, Renewal::Program
}
, OptionRow{[](auto& o) -> auto& {return o.camera.sceneOrigin;
}
, Effect::Way, Renewal::Scene
}
, OptionRow{[](auto& o) -> auto& {return o.light.hdriFile;
}
, Effect::Picture, Renewal::Scene, "hdri"
}
, OptionRow{[](auto& o) -> auto& {return o.light.hdriRotationDegrees;
}
, Effect::Picture, Renewal::None, "hdri_rotation"
}
, OptionRow{[](auto& o) -> auto& {return o.light.hdriIntensity;
}
, Effect::Picture, Renewal::None, "hdri_intensity"
}
, OptionRow{[](auto& o) -> auto& {return o.light.backgroundBlur;
}
, Effect::Picture, Renewal::Scene, "background_blur"
}
, OptionRow{[](auto& o) -> auto& {return o.light.studio;
}
, Effect::Picture, Renewal::Scene, "studio"
}
, OptionRow{[](auto& o) -> auto& {return o.light.shadowCatcher;
}
, Effect::Picture, Renewal::Scene, "shadow_catcher"
}
, OptionRow{[](auto& o) -> auto& {return o.light.catcherHeight;
}
, Effect::Picture
}
, OptionRow{[](auto& o) -> auto& {return o.camera.lineWidth;
}
, Effect::Picture, Renewal::Scene
}
, OptionRow{[](auto& o) -> auto& {return o.output.exposure;
}
, Effect::Display
}
, OptionRow{[](auto& o) -> auto& {return o.light.backgroundColor;
}
, Effect::Picture
}
, OptionRow{[](auto& o) -> auto& {return o.light.background;
}
, Effect::Picture, Renewal::None, "background"
}
, OptionRow{[](auto& o) -> auto& {return o.light.defaultLight;
}
, Effect::Picture, Renewal::Scene
}
, OptionRow{[](auto& o) -> auto& {return o.output.toneMap;
}
, Effect::Display
}
, OptionRow{[](auto& o) -> auto& {return o.output.encoding;
}
, Effect::Display
}
, OptionRow{[](auto& o) -> auto& {return o.camera.pixelFilter;
}
, Effect::Picture, Renewal::Program
}
, OptionRow{[](auto& o) -> auto& {return o.device.traversal;
}
, Effect::Way, Renewal::Scene
}
, OptionRow{[](auto& o) -> auto& {return o.device.instancing;
}
, Effect::Way, Renewal::Scene
}
, OptionRow{[](auto& o) -> auto& {return o.device.backend;
}
, Effect::Way, Renewal::Program
}
, OptionRow{[](auto& o) -> auto& {return o.device.bufferReads;
}
, Effect::Way, Renewal::Program
}
, OptionRow{[](auto& o) -> auto& {return o.device.dispatch;
}
, Effect::Way, Renewal::Program
}
, OptionRow{[](auto& o) -> auto& {return o.device.vectorWidth;
}
, Effect::Way
}
, OptionRow{[](auto& o) -> auto& {return o.device.schedule;
}
, Effect::Way, Renewal::Program
}
, OptionRow{[](auto& o) -> auto& {return o.output.aovSamples;
}
, Effect::Layers
}
, OptionRow{[](auto& o) -> auto& {return o.output.aovVariance;
}
, Effect::Layers
}
, OptionRow{[](auto& o) -> auto& {return o.output.aovFeatures;
}
, Effect::Layers, Renewal::Program
}
, OptionRow{[](auto& o) -> auto& {return o.output.denoise;
}
, Effect::Display
}
, OptionRow{[](auto& o) -> auto& {return o.output.debugView;
}
, Effect::Picture, Renewal::Program
}
, OptionRow{[](auto& o) -> auto& {return o.output.treeLevel;
}
, Effect::Display
}
, OptionRow{[](auto& o) -> auto& {return o.output.checkpointSeconds;
}
, Effect::Report
}
, OptionRow{[](auto& o) -> auto& {return o.output.resume;
}
, Effect::Report
}
, OptionRow{[](auto& o) -> auto& {return o.output.sequence;
}
, Effect::View
}
, OptionRow{[](auto& o) -> auto& {return o.output.statsFile;
}
, Effect::Report
}
, OptionRow{[](auto& o) -> auto& {return o.device.shaderFolder;
}
, Effect::Way, Renewal::Program
}
, OptionRow{[](auto& o) -> auto& {return o.output.oidnLibrary;
}
, Effect::Display
}
, OptionRow{[](auto& o) -> auto& {return o.selection;
}
, Effect::Picture, Renewal::Scene
}
, OptionRow{[](auto& o) -> auto& {return o.limits.memoryBytes;
}
, Effect::Report, Renewal::Scene
}
, OptionRow{[](auto& o) -> auto& {return o.limits.allowExternalFiles;
}
, Effect::Report, Renewal::Scene
}
, OptionRow{[](auto& o) -> auto& {return o.limits.textureSide;
}
, Effect::Picture, Renewal::Scene
}
, OptionRow{[](auto& o) -> auto& {return o.limits.drawMissingTextures;
}
, Effect::Picture, Renewal::Scene
}
, OptionRow{[](auto& o) -> auto& {return o.output.quiet;
}
, Effect::Report, Renewal::Program
}
, OptionRow{[](auto& o) -> auto& {return o.output.verbose;
}
, Effect::Report
}
, OptionRow{[](auto& o) -> auto& {return o.output.progress;
}
, Effect::Report
}
, OptionRow{[](auto& o) -> auto& {return o.output.toStandardOutput;
}
, Effect::Report
}
,
}
;

/// Calls use(row, reference to the member) for each row.
template <typename Use>
void forEachOption(RenderOptions& options, const Use& use) {
  std::apply([&](const auto&... rows) { (use(rows, std::invoke(rows.member, options)), ...); }, kOptionRows);
}

/// The options, with all options and stages that have these effects as by default.
RenderOptions withoutEffects(RenderOptions options, std::initializer_list<Effect> effects);

/// What loadScene() looks at, but for what aim() does again: all else is as by default.
RenderOptions sceneOptions(RenderOptions options);

/// The same for makeTracer(), what loading depends on included.
RenderOptions programOptions(RenderOptions options);

}  // namespace fragtrace
