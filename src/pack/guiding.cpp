// SPDX-License-Identifier: MIT
#include "pack/guiding.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace fragtrace {

namespace {

using uint = uint32_t;
using glm::ceil;
using glm::clamp;
using glm::dot;
using glm::exp2;
using glm::floor;
using glm::ivec3;
using glm::log2;
using glm::min;
using glm::vec3;
using layout::kGuidingCells;

/// The cells of the shader.
struct Cells {
  std::span<const glm::vec4> casters;
  int casterCount;
#include "caustics/guiding_cell.glsl"
#include "mix_bits.glsl"
};

/// At most about this many photons, evenly chosen, tell where a lobe is aimed.
constexpr size_t kMostFitted = 32;
/// The spread of a lobe is this many times the mean over its photons; a uniform cone has twice the mean.
constexpr double kSpreadOfMean = 3.0;
/// A lobe of one photon is as wide as if a second one came from 0.1 radians next to it.
constexpr double kUnknownSpread = 0.5 * 0.1 * 0.1;
constexpr int kShares = 63;  // shares are multiples of a 63rd
// The distances that are tried first: the power of two of the nearest, between them, and their number.
constexpr double kNearest = -7.0;
constexpr double kCoarse = 0.75;
constexpr int kDistances = 23;
constexpr int kHalvings = 5;           // of the step between distances, next to the best one
constexpr double kWorthMoving = 0.99;  // else rounding errors decide between distances that are as good
constexpr double kLeastSpread = 1e-7;  // 1 minus a cosine; the direction's rounding is about 1e-14

struct FittedLobe {
  glm::vec3 focus{0.0f};
  bool away = false;
  double spread = 0.0;
  double flux = 0.0;
};

struct Placed {
  uint cell;
  const Photon* photon;
};

/// 1 minus the cosine between where a photon came from and where the lobe is aimed, weighted by flux.
double meanSpread(std::span<const Placed> photons, const glm::dvec3& focus, bool away) {
  double sum = 0.0;
  double flux = 0.0;
  for (const Placed& p : photons) {
    const glm::dvec3 towards = focus - glm::dvec3(p.photon->point);
    const glm::dvec3 axis = (away ? -1.0 : 1.0) * towards / std::max(glm::length(towards), 1e-30);
    const glm::dvec3 apart = axis - glm::dvec3(p.photon->wi);
    sum += p.photon->flux * 0.5 * glm::dot(apart, apart);
    flux += p.photon->flux;
  }
  return sum / flux;
}

/// Rounds to a multiple of a power of two.
double rounded(double value, double step) {
  const double power = std::exp2(std::floor(std::log2(step)));
  return std::round(value / power) * power;
}

/// Rounds a lobe, so that photons which differ by rounding errors, as those of another traversal do, make the
/// same lobe, and the same picture. It moves by at most a quarter of its width.
void roundLobe(FittedLobe& lobe, const glm::dvec3& point) {
  lobe.spread = std::exp2(std::ceil(4.0 * std::log2(lobe.spread)) / 4.0);
  const double width = glm::distance(glm::dvec3(lobe.focus), point) * std::sqrt(2.0 * lobe.spread);
  for (int c = 0; c < 3; ++c) lobe.focus[c] = float(rounded(lobe.focus[c], width / 4.0));
}

/// Aims a lobe at the point on the photons' mean ray, ahead or behind, that they agree on best.
FittedLobe fitLobe(std::span<const Placed> photons, double unit) {
  std::vector<Placed> chosen;
  const size_t step = (photons.size() + kMostFitted - 1) / kMostFitted;
  for (size_t i = 0; i < photons.size(); i += step) chosen.push_back(photons[i]);
  glm::dvec3 point(0.0);
  glm::dvec3 wi(0.0);
  double flux = 0.0;
  for (const Placed& p : chosen) {
    point += double(p.photon->flux) * glm::dvec3(p.photon->point);
    wi += double(p.photon->flux) * glm::dvec3(p.photon->wi);
    flux += p.photon->flux;
  }
  point /= flux;
  wi /= std::max(glm::length(wi), 1e-30);
  FittedLobe best;
  best.spread = 1e30;
  double power = 0.0;
  const auto tryAt = [&](double at, bool away) {
    const glm::dvec3 focus = point + (away ? -1.0 : 1.0) * unit * std::exp2(at) * wi;
    const double spread = meanSpread(chosen, focus, away);
    if (spread >= kWorthMoving * best.spread) return;
    best = FittedLobe{glm::vec3(focus), away, spread, 0.0};
    power = at;
  };
  // Distances from a hundredth to a thousand radii of the nearest caster, then finer ones next to the best.
  for (int i = 0; i < kDistances; ++i) {
    for (const bool away : {false, true}) tryAt(kNearest + i * kCoarse, away);
  }
  for (int i = 1; i <= kHalvings; ++i) {
    const double middle = power;
    const double beside = std::ldexp(kCoarse, -i);
    for (const double at : {middle - beside, middle + beside}) tryAt(at, best.away);
  }
  const double count = double(chosen.size());
  best.spread = kSpreadOfMean * (best.spread + kUnknownSpread / (count * count));
  best.spread = std::clamp(best.spread, kLeastSpread, 2.0);
  roundLobe(best, point);
  best.spread = std::min(best.spread, 2.0);
  for (const Placed& p : photons) best.flux += p.photon->flux;
  return best;
}

/// Writes the strongest lobes of a cell. Their shares go with the root of their flux: what they miss weighs
/// by its square. Lobes whose share is rounded to nothing are left out, since the shader ends at such a
/// share.
void placeLobes(std::vector<FittedLobe>& lobes, uint32_t* row) {
  std::ranges::stable_sort(lobes, std::greater(), &FittedLobe::flux);
  lobes.resize(std::min(lobes.size(), size_t(layout::kGuidingLobes)));
  const auto share = [](double sum, const FittedLobe& l) { return sum + std::sqrt(l.flux); };
  const double all = std::accumulate(lobes.begin(), lobes.end(), 0.0, share);
  double sum = 0.0;
  uint32_t before = 0;
  for (const FittedLobe& lobe : lobes) {
    sum = share(sum, lobe);
    const auto upTo = uint32_t(std::lround(sum / all * kShares) * (layout::kGuidingShareMask / kShares));
    if (upTo == before) continue;
    before = upTo;
    const uint32_t spread = std::bit_cast<uint32_t>(float(lobe.spread)) & layout::kGuidingSpreadMask;
    for (int c = 0; c < 3; ++c) *row++ = std::bit_cast<uint32_t>(lobe.focus[c]);
    *row++ = spread | upTo | (lobe.away ? layout::kGuidingAway : 0u);
  }
}

}  // namespace

std::vector<uint32_t> fitGuiding(std::span<const Photon> photons, std::span<const glm::vec4> casters) {
  std::vector<uint32_t> rows(kGuidingRows * 4);
  Cells cells{casters, int(casters.size())};
  std::vector<Placed> placed;
  for (const Photon& p : photons) {
    if (p.flux > 0.0f) placed.push_back({cells.guidingCell(p.point), &p});
  }
  const auto group = [](const Placed& p) { return uint64_t(p.cell) << 32 | p.photon->chain; };
  std::ranges::stable_sort(placed, {}, group);
  const auto to = [&](auto from, const auto& key) {
    return std::find_if(from, placed.end(), [&](const Placed& p) { return key(p) != key(*from); });
  };
  const auto cell = [](const Placed& p) { return p.cell; };
  for (auto first = placed.begin(); first != placed.end();) {
    const auto last = to(first, cell);
    double unit = 1e30;
    for (const glm::vec4& ball : casters)
      unit = std::min(unit, double(std::max(ball.w, glm::distance(first->photon->point, glm::vec3(ball)))));
    std::vector<FittedLobe> lobes;
    for (auto from = first; from != last;) {
      const auto end = to(from, group);
      lobes.push_back(fitLobe({from, end}, unit));
      from = end;
    }
    placeLobes(lobes, &rows[size_t(first->cell) * layout::kGuidingLobes * 4]);
    first = last;
  }
  return rows;
}

}  // namespace fragtrace
