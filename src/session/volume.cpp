// SPDX-License-Identifier: MIT
#include "session/setup.h"

#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtx/component_wise.hpp>
#include <limits>

#include "base/errors.h"
#include "base/text.h"
#include "options/option_row.h"
#include "scene/volume/read_grid.h"

namespace fragtrace {

namespace {

bool sameGrid(const VolumeSource& a, const VolumeSource& b) {
  return a.file == b.file && a.grid == b.grid && a.emits() == b.emits();
}

/// Replaces the members that the other sets.
void takeOver(VolumeSource& source, const VolumeSource& other) {
  const auto take = [](auto& value, const auto& from) {
    if (from) value = from;
  };
  if (!other.file.empty()) {
    source.file = other.file;
    source.grid = other.grid;
  }
  take(source.position, other.position);
  take(source.scale, other.scale);
  take(source.density, other.density);
  take(source.color, other.color);
  take(source.anisotropy, other.anisotropy);
  take(source.emission, other.emission);
}

/// The first option that says something of a grid but which; empty: none does.
std::string firstGiven(const RenderOptions& options) {
  for (const char* name : {"--volume-position", "--volume-scale", "--volume-density", "--volume-color",
                           "--volume-anisotropy", "--volume-emission"}) {
    if (!rowOf(name).isDefault(options)) return name;
  }
  return {};
}

/// Warns of grids that are not seen as their numbers promise, or that take long.
void warnOfVolume(const RenderOptions& options, Scene& scene) {
  constexpr double kMostDepth = 100.0;  // mean free paths
  const Volume& volume = scene.volume;
  const std::string name = volume.source.file.string() + ": ";
  if (!has(options.stages, Stage::Gi)) {
    scene.warnings.push_back(name + "only stage gi has grids of densities");
    return;
  }
  const glm::vec3 albedo = volume.source.color.value_or(glm::vec3(1.0f));
  if (volume.source.emits() && glm::compMin(albedo) >= 1.0f)
    scene.warnings.push_back(name + "only what absorbs light glows, and the color 1,1,1 absorbs none");
  const double extinction = volume.source.density.value_or(1.0) * volume.grid->largest;
  const std::array<glm::dvec3, 8> corners = volume.corners();
  double size = std::numeric_limits<double>::infinity();
  for (const size_t side : {1, 2, 4}) size = std::min(size, glm::distance(corners[0], corners[side]));
  if (extinction * size <= kMostDepth) return;
  scene.warnings.push_back(
      name + formatted("light goes %.2g m on average where the grid is densest, and the grid is %.3g m deep: "
                       "paths are long",
                       1.0 / extinction, size));
}

}  // namespace

void placeVolume(Scene& scene, const RenderOptions& options, const Volume* before) {
  Volume& volume = scene.volume;
  // A grid of the options replaces the scene's, its node's place included.
  if (!options.volume.file.empty()) volume = Volume();
  const std::string given = firstGiven(options);
  if (!given.empty() && options.volume.file.empty() && volume.source.file.empty())
    throw UsageError(given + ": goes with --volume, or with a scene that brings a grid");
  takeOver(volume.source, options.volume);
  const VolumeSource& source = volume.source;
  if (source.file.empty()) return;
  if (options.light.shadowCatcher)
    throw UsageError("--shadow-catcher: its plane stands in clear air, but the scene brings a grid: " +
                     source.file.string());
  volume.toWorld = glm::translate(volume.toWorld, source.position.value_or(glm::dvec3(0.0)));
  volume.toWorld = glm::scale(volume.toWorld, glm::dvec3(source.scale.value_or(1.0)));
  volume.grid =
      before != nullptr && before->grid && sameGrid(before->source, source)
          ? before->grid
          : std::make_shared<const VolumeGrid>(readGrid(source, volume.file, options.limits.memoryBytes));
  volume.file = {};
  const bool hasSize = std::abs(glm::determinant(volume.voxelsToWorld())) > 0.0;
  if (volume.grid->empty() || !hasSize) {
    scene.warnings.push_back(source.file.string() + (hasSize ? ": the grid has no density above 0"
                                                             : ": the grid's node has no size"));
    volume.grid.reset();
    return;
  }
  for (const glm::dvec3& corner : volume.corners()) scene.bounds.include(corner);
  warnOfVolume(options, scene);
}

}  // namespace fragtrace
