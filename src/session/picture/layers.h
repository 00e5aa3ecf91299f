// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "session/picture/draw_samples.h"
#include "session/tracer.h"

namespace fragtrace {

// Layers of the light of some lamps alone (--aov light:NAME). The picture's own program draws them on the
// same samples. All other lamps are dimmed so much that nothing is seen of them. They still take their light
// samples and shadow rays, so the layers add up to the picture.

/// The group of each light, as an index into OutputOptions::lightGroups; none: no layer shows it.
struct LightGroups {
  std::vector<std::optional<size_t>> ofMaterials;  ///< the group by the index of the material
  std::vector<std::optional<size_t>> ofLights;     ///< the group by the index of the punctual light
  std::optional<size_t> ofSurroundings;
  std::optional<size_t> ofVolume;
};

/// Throws UsageError where the scene has no light of a name.
LightGroups lightGroupsOf(const RenderOptions& options, const Scene& scene);

/// A line for each group that is of several lights of one name: how each of them is chosen.
std::vector<std::string> sharedGroups(const RenderOptions& options, const Scene& scene);

/// Dims all lights of the scene on the device that are not of the group; none: all shine again. Throws
/// RenderError.
void showLights(const Tracer& tracer, const Scene& scene, const LightGroups& groups,
                std::optional<size_t> group);

/// The view with surroundings and volume dimmed in the same way.
View viewOfGroup(const View& view, const LightGroups& groups, size_t group);

/// Sets to 0 what dimmed lights leave in the colours of a group. `picture`: of the same size; its first
/// channels are the colours with all light.
void dropDimmed(Image& layer, const Image& picture);

// Layers of Cryptomatte: each sample of the picture counts for the name of what it meets first.

/// The layer's name in the file.
std::string matteLayer(Aov aov);

/// The names of the scene's nodes that show something, or of its materials. A node without a name has its
/// place in the file; so has a material, and the default one is "default".
std::vector<std::string> namesOfMatte(Aov aov, const Scene& scene);

/// Draws the layer sample by sample, with the samples of the picture. Like drawLayer().
LayerDraw drawMattes(glm::ivec2 size, Renderer& renderer, const ShaderVariant& variant, const View& view,
                     int samples, const Scene& scene,
                     const Renderer::Progress& progress = Renderer::toTheEnd);

}  // namespace fragtrace
