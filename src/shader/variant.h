// SPDX-License-Identifier: MIT
// The shader variant: what was asked for, cut down to what the scene holds.
#pragma once

#include <compare>
#include <optional>
#include <string>

#include "scene/scene.h"
#include "shader/render_options.h"
#include "shader/traits.h"

namespace fragtrace {

/// Everything the shader text depends on; small and comparable, so it is the key of the program cache.
struct ShaderVariant {
  StageSet stages;
  TraitSet traits;
  TraversalMethod traversal = TraversalMethod::FrontToBack;
  int stackSize = 12;
  BufferReads reads = BufferReads::Ssbo;
  Dispatch dispatch = Dispatch::Fragment;
  PixelFilter pixelFilter = PixelFilter::Box;
  Aov aov = Aov::None;            ///< drawn instead of radiance
  int cameraRays = 1;             ///< per sample; the last alone continues where it scatters (path.glsl)
  bool countsVisits = false;      ///< the nodes that camera rays visit are, too
  bool countsWork = false;        ///< the work of samples is, too (shaders/work/count.glsl)
  bool uniformLights = false;     ///< the light tree chooses all lights alike
  bool lightCandidates = false;   ///< a light sample is one of several (shaders/reuse/candidates.glsl)
  bool storesReservoirs = false;  ///< light samples of first hits are kept (shaders/reuse/neighbours.glsl)
  bool neighbours = false;        ///< pixels take such light samples of others near them
  bool clampIndirect = false;
  bool shadowCatcher = false;
  bool transparentGlass = false;  ///< the camera sees the background through glass
  bool lens = false;              ///< else a pinhole
  bool lensShift = false;
  CameraType camera = CameraType::Perspective;  ///< Perspective stands for orthographic cameras, too
  bool lightPaths = false;     ///< it traces light paths instead of camera paths (shaders/caustics/)
  bool rayCones = false;       ///< textures are read at the levels that ray cones choose (shaders/cones)
  bool gpu = false;            ///< the text suits the compilers of GPUs, else that of llvmpipe
  bool wavefront = false;      ///< else the megakernel
  int waveUnit = -1;           ///< image unit through which it reads its states; -1: a storage buffer
  bool textureArrays = false;  ///< texels are read from array textures, else as words of buffers
  int texelBuffers = 1;
  bool resumable =
      false;  ///< paths can be suspended from draw to draw; only needed by those longer than a draw

  std::string literals;  ///< the scene as shader text, when it is drawn that way

  auto operator<=>(const ShaderVariant&) const = default;  // NOLINT(modernize-use-nullptr): it is none
};

/// The light from outside the scene: an environment map, a constant default light, or nothing.
enum class Surroundings : uint8_t { None, DefaultLight, Map };

/// The sun of the surroundings: before them, where it may have set, or in their map.
enum class SunLight : uint8_t { None, Set, Shines, InMap };

/// The features of the scene, before anything is asked for. backdrop: the surroundings have a backdrop of
/// their own.
TraitSet traitsOf(const Scene& scene, Surroundings surroundings, bool backdrop = false,
                  SunLight sun = SunLight::None);

/// Returns true if the scene has any light of its own: emission or punctual lights.
bool hasOwnLight(const Scene& scene);

/// Reduces any wish to a legal variant: all implications between stages and traits stand here, once.
ShaderVariant chooseVariant(const RenderOptions& options, const TraitSet& present, Surroundings surroundings,
                            uint32_t stackNeed, BufferReads reads);

/// The variant that draws an AOV for the same samples: what radiance alone needs is left out. `wanted` are
/// the options as for chooseVariant, which it calls.
ShaderVariant chooseAovVariant(const RenderOptions& options, const TraitSet& present,
                               Surroundings surroundings, uint32_t stackNeed, BufferReads reads, Aov aov);

/// The variant that draws what the picture shows: radiance, or what the options' debug view needs.
ShaderVariant choosePictureVariant(const RenderOptions& options, const TraitSet& present,
                                   Surroundings surroundings, uint32_t stackNeed, BufferReads reads);

/// The variant that traces the light paths of such a picture, if it has any.
std::optional<ShaderVariant> lightPathVariant(const ShaderVariant& variant);

/// Returns true if camera paths are guided (shaders/caustics/guiding.glsl).
bool usesGuiding(const ShaderVariant& variant);

/// The variant that keeps the light samples that such a picture's pixels take of others, if they do.
std::optional<ShaderVariant> reservoirVariant(const ShaderVariant& variant);

/// Returns true if the environment lights surfaces without sampling, as before gi (integrators/local.glsl).
bool lightsByEnvironment(const ShaderVariant& variant);

/// Returns true if hits keep their barycentric weights, which only vertex attributes need.
bool keepsWeights(const ShaderVariant& variant);

/// Returns true if rays may continue behind what they meet: straight through glass, and guides through alpha.
bool passesSurfaces(const ShaderVariant& variant);

/// Returns true if rays meet no surface that lets them pass by its alpha.
bool testsAlpha(const ShaderVariant& variant);

/// The variant by name: what is on, separated by "+", for the statistics.
std::string variantName(const ShaderVariant& variant);

/// Says why a stage or switch that was asked for is off in a scene of these traits; empty: it is on. `gi`:
/// with stage gi, which alone sends shadow rays to the environment.
std::string whyOff(Stage stage, const TraitSet& present, bool gi = true);

/// The option, or the media of a scene of these traits, that light paths cannot go with; empty when there is
/// none.
std::string whyNoLightPaths(const RenderOptions& options, const TraitSet& present);

/// Returns true if the tables of src/pack/energy_tables.cpp describe the loss. These traits change the
/// facets: then no table fits, and samples would not follow their density.
inline bool usesGlassTables(const ShaderVariant& v) {
  if (!has(v.traits, Trait::RoughGlass) || !has(v.stages, Stage::EnergyCompensation)) return false;
  return !has(v.traits, Trait::Anisotropy) && !has(v.traits, Trait::Iridescence) &&
         !has(v.traits, Trait::GlassSpecular) && !has(v.traits, Trait::Dispersion) &&
         !has(v.stages, Stage::Schlick);
}

}  // namespace fragtrace
