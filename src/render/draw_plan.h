// SPDX-License-Identifier: MIT
// Cuts work into draws: small enough that none nears a driver's limits, large enough to keep it busy.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

namespace fragtrace {

/// The largest tile whose paths may be suspended, in pixels. Their states are in one storage buffer of 60 to
/// 104 MiB (kPathRows of layout.glsl; a row has 16 bytes).
inline constexpr int kMaxTilePixels = 1 << 18;
inline constexpr int kMaxTileSide = 1 << 9;
/// The largest tile of a GPU, whose paths end in their draw: all of 1920 x 1080. At 1280 x 720 one draw takes
/// 0.83 (the room with the ball) and 0.66 (FlightHelmet) of the time of six, on an H200.
inline constexpr int kMaxGpuTilePixels = 1 << 21;
/// The sides of a tile of the wavefront: 1,024 lanes on software, 32,768 on a GPU, whose states take 145 MiB.
inline constexpr glm::ivec2 kWaveTile{128, 256};
inline constexpr glm::ivec2 kGpuWaveTile{1024, 1024};

/// A rectangle of the film (from the bottom left) and the samples that its pixels get: [from, to).
struct Work {
  glm::ivec2 corner{0};
  glm::ivec2 size{0};
  int from = 0;
  int to = 0;
  double busy = 1.0;  ///< part of its pixels that will draw (Film::setTargets)
};

/// Samples over all pixels of a work.
inline double pixelSamples(const Work& work) {
  return work.busy * work.size.x * work.size.y * (work.to - work.from);
}

/// Returns the same work in tiles.
inline std::vector<Work> tilesOf(const Work& work, glm::ivec2 tile) {
  std::vector<Work> tiles;
  for (int y = 0; y < work.size.y; y += tile.y) {
    for (int x = 0; x < work.size.x; x += tile.x) {
      const glm::ivec2 corner(x, y);
      tiles.push_back(
          {work.corner + corner, glm::min(tile, work.size - corner), work.from, work.to, work.busy});
    }
  }
  return tiles;
}

/// One round over the picture: each tile of size `tile` gets more samples.
struct DrawPlan {
  glm::ivec2 tile{0};
  int samples = 1;
};

/// The plan whose draws take about targetMs at a measured cost of msPerSample for a sample of a pixel (<= 0:
/// not yet known, a careful start). It has at most `remaining` samples, at most `most` samples per draw, and
/// at most `mostPixels` a tile. Small tiles with several samples are preferred to large tiles with one: a
/// pixel whose path ends early begins its next sample instead of waiting for its neighbours.
inline DrawPlan planDraws(glm::ivec2 picture, int remaining, int most, int mostPixels, double msPerSample,
                          double targetMs) {
  constexpr int kSmallest = 128;  // pixels per side: some tiles of 64 for each core of a software rasteriser
  constexpr double kEnoughSamples = 16.0;
  const double affordable = msPerSample > 0.0 ? targetMs / msPerSample : double(kSmallest) * kSmallest;
  const double pixels = double(picture.x) * picture.y;
  const double mostSamples = std::max(1, std::min(most, remaining));
  DrawPlan plan;
  const double wanted =
      std::clamp(affordable / (double(kSmallest) * kSmallest), 1.0, std::min(mostSamples, kEnoughSamples));
  if (pixels <= mostPixels && affordable >= pixels * wanted) {
    plan.tile = picture;
  } else {
    const double area = std::clamp(affordable / wanted, double(kSmallest) * kSmallest, double(mostPixels));
    const int side = std::max(kSmallest, int(std::sqrt(area)) / 64 * 64);
    plan.tile = {std::min(picture.x, side), std::min(picture.y, side)};
  }
  plan.samples = int(std::clamp(affordable / (double(plan.tile.x) * plan.tile.y), 1.0, mostSamples));
  return plan;
}

/// Does the same for the wavefront, whose draws are limited by steps. Paths continue from draw to draw, so a
/// tile gets many samples before the next one, and only its last paths leave lanes idle. Rounds double, up to
/// 64 samples, so that a picture that is stopped early has about as many samples everywhere.
inline DrawPlan planWaves(glm::ivec2 picture, glm::ivec2 tile, int done, int remaining) {
  return {glm::min(picture, tile), std::min(remaining, std::clamp(done, 1, 64))};
}

}  // namespace fragtrace
