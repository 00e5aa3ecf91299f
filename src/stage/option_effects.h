// SPDX-License-Identifier: MIT
// What each option changes: one table row a member of RenderOptions. Which options a picture, a program of
// the viewer or the attributes of a file depend on follows from it.
#pragma once

#include <functional>
#include <initializer_list>
#include <tuple>

#include "stage/effect.h"
#include "stage/render_options.h"

namespace fragtrace {

/// `member` is a pointer to a member of RenderOptions, or a function that takes the options to a reference.
template <typename Member>
struct OptionRow {
  Member member;
  Effect effect;
  bool program = false;  ///< it decides which program of the viewer draws, and what that reads of the scene
  const char* attribute = nullptr;  ///< its name in the attribute fragtrace:settings, where it stands there
};

template <typename Member>
OptionRow(Member, Effect, bool = false, const char* = nullptr) -> OptionRow<Member>;

/// A member without a row counts as Effect::Picture and decides the program: what is forgotten here costs
/// time, never a wrong picture. Stages have their effects in stageRows().
inline constexpr std::tuple kOptionRows{
    OptionRow{&RenderOptions::scene, Effect::Picture, true},
    OptionRow{&RenderOptions::output, Effect::Report}, OptionRow{&RenderOptions::resolution, Effect::Picture},
    OptionRow{&RenderOptions::region, Effect::Picture}, OptionRow{&RenderOptions::spp, Effect::Count},
    OptionRow{&RenderOptions::sampleOffset, Effect::Noise}, OptionRow{&RenderOptions::seed, Effect::Noise},
    OptionRow{&RenderOptions::bounces, Effect::Picture, false, "bounces"},
    OptionRow{&RenderOptions::rouletteDepth, Effect::Noise, false, "rr_depth"},
    OptionRow{&RenderOptions::clampIndirect, Effect::Picture, true, "clamp_indirect"},
    OptionRow{&RenderOptions::noise, Effect::Count}, OptionRow{&RenderOptions::seconds, Effect::Count},
    OptionRow{&RenderOptions::cameraIndex, Effect::View}, OptionRow{&RenderOptions::camera, Effect::View},
    OptionRow{&RenderOptions::sceneOrigin, Effect::Way},
    OptionRow{&RenderOptions::hdriFile, Effect::Picture, true, "hdri"},
    OptionRow{&RenderOptions::hdriRotationDegrees, Effect::Picture, false, "hdri_rotation"},
    OptionRow{&RenderOptions::backgroundBlur, Effect::Picture, true, "background_blur"},
    OptionRow{&RenderOptions::studio, Effect::Picture, true, "studio"},
    OptionRow{&RenderOptions::shadowCatcher, Effect::Picture, true, "shadow_catcher"},
    OptionRow{&RenderOptions::catcherHeight, Effect::Picture},
    OptionRow{&RenderOptions::exposure, Effect::Display},
    OptionRow{&RenderOptions::backgroundColor, Effect::Picture},
    OptionRow{&RenderOptions::background, Effect::Picture, false, "background"},
    OptionRow{&RenderOptions::defaultLight, Effect::Picture, true},
    OptionRow{&RenderOptions::toneMap, Effect::Display}, OptionRow{&RenderOptions::encoding, Effect::Display},
    OptionRow{&RenderOptions::pixelFilter, Effect::Picture, true},
    OptionRow{&RenderOptions::traversal, Effect::Way, true},
    OptionRow{&RenderOptions::instancing, Effect::Way}, OptionRow{&RenderOptions::backend, Effect::Way, true},
    OptionRow{&RenderOptions::bufferReads, Effect::Way, true},
    OptionRow{&RenderOptions::dispatch, Effect::Way, true},
    OptionRow{&RenderOptions::schedule, Effect::Way, true},
    OptionRow{&RenderOptions::aovSamples, Effect::Layers},
    OptionRow{&RenderOptions::aovVariance, Effect::Layers},
    OptionRow{&RenderOptions::aovFeatures, Effect::Layers},
    OptionRow{&RenderOptions::denoise, Effect::Display},
    OptionRow{&RenderOptions::debugView, Effect::Picture, true},
    OptionRow{&RenderOptions::treeLevel, Effect::Display},
    OptionRow{&RenderOptions::checkpointSeconds, Effect::Report},
    OptionRow{&RenderOptions::resume, Effect::Report}, OptionRow{&RenderOptions::sequence, Effect::View},
    OptionRow{&RenderOptions::statsFile, Effect::Report},
    OptionRow{&RenderOptions::shaderFolder, Effect::Way, true},
    OptionRow{&RenderOptions::oidnLibrary, Effect::Display},
    OptionRow{&RenderOptions::selection, Effect::Picture},
    OptionRow{[](RenderOptions & o) -> auto& {return o.limits.memoryBytes;
}  // namespace fragtrace
, Effect::Report
}
, OptionRow{[](RenderOptions & o) -> auto& {return o.limits.allowExternalFiles;
}
, Effect::Report
}
, OptionRow{[](RenderOptions & o) -> auto& {return o.limits.textureSide;
}
, Effect::Picture
}
, OptionRow{[](RenderOptions & o) -> auto& {return o.limits.drawMissingTextures;
}
, Effect::Picture
}
, OptionRow{&RenderOptions::quiet, Effect::Report, true}, OptionRow{&RenderOptions::verbose, Effect::Report},
    OptionRow{&RenderOptions::progress, Effect::Report},
    OptionRow{&RenderOptions::toStandardOutput, Effect::Report},
}
;

/// Calls use(row, reference to the member) for each row.
template <typename Use>
void forEachOption(RenderOptions& options, const Use& use) {
  std::apply([&](const auto&... rows) { (use(rows, std::invoke(rows.member, options)), ...); }, kOptionRows);
}

/// The options, with all options and stages that have these effects as by default.
RenderOptions withoutEffects(RenderOptions options, std::initializer_list<Effect> effects);

/// The options, with all that decides no program as by default.
RenderOptions programOptions(RenderOptions options);

}  // namespace fragtrace
