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

namespace limit {
inline uint64_t& memoryBytes(RenderOptions& o) { return o.limits.memoryBytes; }
inline bool& allowExternalFiles(RenderOptions& o) { return o.limits.allowExternalFiles; }
inline int& textureSide(RenderOptions& o) { return o.limits.textureSide; }
inline bool& drawMissingTextures(RenderOptions& o) { return o.limits.drawMissingTextures; }
}  // namespace limit

/// A member without a row counts as Effect::Picture and Renewal::Scene: what is forgotten here costs time,
/// never a wrong picture. Stages have their effects in stageRows().
inline constexpr std::tuple kOptionRows{
    OptionRow{&RenderOptions::scene, Effect::Picture, Renewal::Scene},
    OptionRow{&RenderOptions::output, Effect::Report},
    OptionRow{&RenderOptions::resolution, Effect::Picture},
    OptionRow{&RenderOptions::region, Effect::Picture},
    OptionRow{&RenderOptions::spp, Effect::Count},
    OptionRow{&RenderOptions::sampleOffset, Effect::Noise},
    OptionRow{&RenderOptions::seed, Effect::Noise},
    OptionRow{&RenderOptions::bounces, Effect::Picture, Renewal::None, "bounces"},
    OptionRow{&RenderOptions::rouletteDepth, Effect::Noise, Renewal::None, "rr_depth"},
    OptionRow{&RenderOptions::clampIndirect, Effect::Picture, Renewal::Program, "clamp_indirect"},
    OptionRow{&RenderOptions::lightSelection, Effect::Noise, Renewal::Program},
    OptionRow{&RenderOptions::lightReuse, Effect::Noise, Renewal::Program},
    OptionRow{&RenderOptions::caustics, Effect::Picture, Renewal::Program},
    OptionRow{&RenderOptions::noise, Effect::Count},
    OptionRow{&RenderOptions::seconds, Effect::Count},
    OptionRow{&RenderOptions::cameraIndex, Effect::View},
    OptionRow{&RenderOptions::camera, Effect::View},
    OptionRow{&RenderOptions::lens, Effect::Picture, Renewal::Program},
    OptionRow{&RenderOptions::sceneOrigin, Effect::Way, Renewal::Scene},
    OptionRow{&RenderOptions::hdriFile, Effect::Picture, Renewal::Scene, "hdri"},
    OptionRow{&RenderOptions::hdriRotationDegrees, Effect::Picture, Renewal::None, "hdri_rotation"},
    OptionRow{&RenderOptions::hdriIntensity, Effect::Picture, Renewal::None, "hdri_intensity"},
    OptionRow{&RenderOptions::backgroundBlur, Effect::Picture, Renewal::Scene, "background_blur"},
    OptionRow{&RenderOptions::studio, Effect::Picture, Renewal::Scene, "studio"},
    OptionRow{&RenderOptions::shadowCatcher, Effect::Picture, Renewal::Scene, "shadow_catcher"},
    OptionRow{&RenderOptions::catcherHeight, Effect::Picture},
    OptionRow{&RenderOptions::lineWidth, Effect::Picture, Renewal::Scene},
    OptionRow{&RenderOptions::exposure, Effect::Display},
    OptionRow{&RenderOptions::backgroundColor, Effect::Picture},
    OptionRow{&RenderOptions::background, Effect::Picture, Renewal::None, "background"},
    OptionRow{&RenderOptions::defaultLight, Effect::Picture, Renewal::Scene},
    OptionRow{&RenderOptions::toneMap, Effect::Display},
    OptionRow{&RenderOptions::encoding, Effect::Display},
    OptionRow{&RenderOptions::pixelFilter, Effect::Picture, Renewal::Program},
    OptionRow{&RenderOptions::traversal, Effect::Way, Renewal::Scene},
    OptionRow{&RenderOptions::instancing, Effect::Way, Renewal::Scene},
    OptionRow{&RenderOptions::backend, Effect::Way, Renewal::Program},
    OptionRow{&RenderOptions::bufferReads, Effect::Way, Renewal::Program},
    OptionRow{&RenderOptions::dispatch, Effect::Way, Renewal::Program},
    OptionRow{&RenderOptions::vectorWidth, Effect::Way},
    OptionRow{&RenderOptions::schedule, Effect::Way, Renewal::Program},
    OptionRow{&RenderOptions::aovSamples, Effect::Layers},
    OptionRow{&RenderOptions::aovVariance, Effect::Layers},
    OptionRow{&RenderOptions::aovFeatures, Effect::Layers, Renewal::Program},
    OptionRow{&RenderOptions::denoise, Effect::Display},
    OptionRow{&RenderOptions::debugView, Effect::Picture, Renewal::Program},
    OptionRow{&RenderOptions::treeLevel, Effect::Display},
    OptionRow{&RenderOptions::checkpointSeconds, Effect::Report},
    OptionRow{&RenderOptions::resume, Effect::Report},
    OptionRow{&RenderOptions::sequence, Effect::View},
    OptionRow{&RenderOptions::statsFile, Effect::Report},
    OptionRow{&RenderOptions::shaderFolder, Effect::Way, Renewal::Program},
    OptionRow{&RenderOptions::oidnLibrary, Effect::Display},
    OptionRow{&RenderOptions::selection, Effect::Picture, Renewal::Scene},
    OptionRow{&limit::memoryBytes, Effect::Report, Renewal::Scene},
    OptionRow{&limit::allowExternalFiles, Effect::Report, Renewal::Scene},
    OptionRow{&limit::textureSide, Effect::Picture, Renewal::Scene},
    OptionRow{&limit::drawMissingTextures, Effect::Picture, Renewal::Scene},
    OptionRow{&RenderOptions::quiet, Effect::Report, Renewal::Program},
    OptionRow{&RenderOptions::verbose, Effect::Report},
    OptionRow{&RenderOptions::progress, Effect::Report},
    OptionRow{&RenderOptions::toStandardOutput, Effect::Report},
};

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
