// SPDX-License-Identifier: MIT
#include "session/volume.h"

#include <glm/gtc/matrix_transform.hpp>

#include "scene/volume/read_grid.h"

namespace fragtrace {

namespace {

bool sameGrid(const VolumeSource& a, const VolumeSource& b) {
  return a.file == b.file && a.grid == b.grid && a.emits() == b.emits();
}

}  // namespace

void placeVolume(Scene& scene, const RenderOptions& options, const Volume* before) {
  Volume& volume = scene.volume;
  // Those of the options replace the scene's, its node's place included.
  if (!options.volume.file.empty()) {
    volume = Volume();
    volume.source = options.volume;
  }
  const VolumeSource& source = volume.source;
  if (source.file.empty()) return;
  volume.toWorld = glm::translate(volume.toWorld, source.position.value_or(glm::dvec3(0.0)));
  volume.toWorld = glm::scale(volume.toWorld, glm::dvec3(source.scale.value_or(1.0)));
  volume.grid =
      before != nullptr && before->grid && sameGrid(before->source, source)
          ? before->grid
          : std::make_shared<const VolumeGrid>(readGrid(source, volume.file, options.limits.memoryBytes));
  volume.file = {};
  const VolumeGrid& grid = *volume.grid;
  if (grid.empty()) {
    scene.warnings.push_back(source.file.string() + ": the grid has no density above 0");
    volume.grid.reset();
    return;
  }
  const glm::dmat4 toWorld = volume.toWorld * grid.toWorld;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 side(corner & 1, (corner >> 1) & 1, corner >> 2);
    const glm::dvec3 voxel(grid.minimum + kBrickSide * side * grid.bricks);
    scene.bounds.include(glm::dvec3(toWorld * glm::dvec4(voxel, 1.0)));
  }
}

}  // namespace fragtrace
