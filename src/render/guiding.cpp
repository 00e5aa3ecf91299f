// SPDX-License-Identifier: MIT
// The part of the renderer that trains guiding (shaders/caustics/guiding.glsl).
#include <algorithm>

#include "pack/guiding.h"
#include "render/renderer.h"

namespace fragtrace {

namespace {

/// All seeds have the same lobes: random numbers of its own keep it apart from what it guides.
constexpr uint32_t kSeed = 0x6775696du;

/// The lobes for a picture of so many pixels are fitted to this many photons. A larger picture takes longer,
/// and pays for more.
size_t photonsFor(glm::ivec2 picture) {
  return std::clamp(size_t(picture.x) * size_t(picture.y) * 4, size_t(1) << 12, size_t(1) << 17);
}
/// At most this many light paths are traced for each of the photons, where few land.
constexpr size_t kMostPathsPerPhoton = 8;

}  // namespace

bool Renderer::trainGuiding(const Film& film, const View& view, int sample, RenderTimes& times,
                            const GoOn& goOn) {
  const auto start = std::chrono::steady_clock::now();
  guides_ = usesGuiding(pace_->drawn) && film.pixelsPerPath() != kNoLightPaths && view.bounces > 0 &&
            view.sampleOffset + sample > 0;
  const size_t wanted = photonsFor(view.placement ? view.placement->whole : film.size());
  if (!guides_ || guidingPhotons_ == wanted) return true;
  std::vector<Photon> photons;
  const int rows = int(std::min(wanted / kRecordSide, size_t(kRecordSide)));
  const int height = int(wanted * kMostPathsPerPhoton / kRecordSide);
  for (int row = 0; row < height && photons.size() < wanted; row += rows) {
    if (!tracePhotons(view, {{0, row}, {kRecordSide, rows}, 0, 1}, height, photons, goOn)) return false;
  }
  lobes_ = fitGuiding(photons, casters_);
  buffers_.writeLastLights(lobes_);
  guidingPhotons_ = wanted;
  times.guidingMs += millisecondsBetween(start, std::chrono::steady_clock::now());
  return true;
}

bool Renderer::tracePhotons(const View& view, const Work& paths, int height, std::vector<Photon>& photons,
                            const GoOn& goOn) {
  ShaderVariant& variant = drawn(*lightPathVariant(pace_->drawn));
  View seen = view;
  seen.seed = kSeed;
  seen.sampleOffset = 0;
  seen.placement = Placement{{0, height - paths.corner.y - lightPathFilm_->size().y}, {kRecordSide, height}};
  lightPathFilm_->clearCounts();
  if (!drawPass({variant, *lightPathFilm_, seen, {rowsOfPaths(paths.size)}, true}, goOn)) return false;
  const FilmState records = lightPathFilm_->save();
  for (size_t i = 0; i < size_t(paths.size.x) * size_t(paths.size.y) * 4; i += 4) {
    const float* at = &records.sum[i];
    const float* from = &records.compensation[i];
    if (at[3] > 0.0f)
      photons.push_back({{at[0], at[1], at[2]}, {from[0], from[1], from[2]}, at[3], uint32_t(from[3])});
  }
  return true;
}

}  // namespace fragtrace
