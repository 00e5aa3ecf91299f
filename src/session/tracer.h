// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "pack/gpu_scene.h"
#include "session/setup.h"
#include "shader/render_options.h"

namespace fragtrace {

// A loaded scene on the device, with the programs that draw it.

/// Hashes of the packed arrays, and of all pictures.
using ArrayHashes = std::array<uint64_t, layout::kSceneBufferCount + 1>;

/// The scene on the device, and the variant that the options ask for.
struct Tracer {
  ShaderVariant variant;
  std::vector<ShaderVariant> aovs;  ///< the layers' variants, in the order of options.aovs
  /// The same variants by ray cones, that of the picture first; none unless levels have room.
  std::vector<ShaderVariant> cones;
  std::unique_ptr<Renderer> renderer;
  double programMs = 0.0;     ///< time to build the variant's program
  uint64_t sceneHash = 0;     ///< hash of all that was uploaded; only for .exr and checkpoints, which keep it
  KeptArrays kept;            ///< arrays that the next scene of a sequence need not upload
  ArrayHashes arrayHashes{};  ///< set if sceneHash is
  Words materials;            ///< the packed materials; only with light groups, which scale the light
  Words lights;               ///< the same of punctual lights
  BufferReads reads = BufferReads::Auto;
  TexturePlan textures;
};

/// Options of makeTracer(): a tracer can have more than its pictures need.
struct TracerExtras {
  bool hash = false;
  bool levels = false;  ///< room for mip levels, which addLevels() fills later, if texels are read as words
};

/// Packs and uploads what the variants need; by default with the hash where the options' output keeps it.
/// `programs` may be built already, from the same shader folder. Throws InputError, RenderError.
Tracer makeTracer(const Context& context, const LoadedScene& loaded, const RenderOptions& options,
                  Statistics& stats, TracerExtras extras, std::optional<ProgramCache> programs = {});
Tracer makeTracer(const Context& context, const LoadedScene& loaded, const RenderOptions& options,
                  Statistics& stats, std::optional<ProgramCache> programs = {});

/// The next scene of a sequence: packs and uploads what has changed. `loaded` is of the same file and options
/// but for the time of its animation; or, if surfaces alone have changed, but for numbers of its materials
/// and lights that leave its geometry as it is. Throws as makeTracer().
void replaceScene(Tracer& tracer, const Context& context, const LoadedScene& loaded,
                  const RenderOptions& options, Statistics& stats, bool surfacesAlone = false);

/// Packs and uploads other surroundings of the same kind. Throws RenderError.
void replaceSurroundings(Tracer& tracer, const LoadedScene& loaded);

// The memory that a picture takes while it is drawn, filtered and written.

/// The number of channels of the picture in an .exr; an upper bound for other formats.
size_t channelsOf(const RenderOptions& options);

/// Throws UsageError where the film of a picture of that size would take more than --memory-limit.
void checkFilmMemory(const RenderOptions& options, glm::ivec2 size);

/// The largest film next to a picture of that size within --memory-limit, in pixels, at least 1; as many as
/// the picture has where all of it fits. Throws UsageError where not even a small film does.
uint64_t mostFilmPixels(const RenderOptions& options, glm::ivec2 size);

}  // namespace fragtrace
