// SPDX-License-Identifier: MIT
// A search for rays that arrive next to a crease and graze the face that they leave, which
// docs/design/ray-origins.md leaves open: how far behind a neighbour they begin. The point within the plane
// is off by roundings of the ray's length over the cosine between ray and normal.
#include <gtest/gtest.h>

#include "climb_folds.h"

namespace fragtrace {
namespace {

/// In units of eps m (1 + t / m) / cosine for a ray of length t, no ray begins farther behind a neighbour.
/// The worst that searches have found is 5.8.
constexpr double kMostBehind = 12.0;
/// Bands of cosines, each a 16th of the one before.
constexpr int kCosineBands = 6;

struct Graze {
  vec3 origin;
  vec3 direction;
};

/// A ray that arrives next to a crease of the first face with a cosine between these, from in front of all
/// faces.
std::optional<Graze> grazingRay(const Fold& fold, Genes& g, double least, double most) {
  const std::array<vec3, 3>& v = fold.faces[0];
  const dvec3 aim = besideCrease(v, g);
  const dvec3 normal = normalOf(v);
  const dvec3 along = glm::normalize(dvec3(v[1]) - dvec3(v[0]));
  const double angle = glm::two_pi<double>() * g.take();
  const dvec3 flat = std::cos(angle) * along + std::sin(angle) * glm::cross(normal, along);
  const double cosine = g.scale(least, most);
  const double away = g.scale(0x1p-4, 0x1p6) * glm::length(dvec3(v[1]) - dvec3(v[0]));
  Graze ray;
  ray.origin = vec3(aim + away * (std::sqrt(1.0 - cosine * cosine) * flat + cosine * normal));
  ray.direction = glm::normalize(vec3(aim - dvec3(ray.origin)));
  for (const auto& face : fold.faces) {
    if (glm::dot(normalOf(face), dvec3(ray.origin) - dvec3(face[0])) < hitPointError(face))
      return std::nullopt;
  }
  return ray;
}

struct GrazingTrial {
  double height = kImpossible;  ///< least height over a neighbour's plane, in units of eps m
  double share = kImpossible;   ///< the same in units of eps m (1 + t / m) / cosine
};

GrazingTrial grazingTrial(Genes g, double least, double most) {
  const glsl_variant::With spheres(glsl_variant::kSpheres, false);
  const Turn turn(g);
  const Fold fold = g.take() < 0.5 ? wedgeOf(g, turn) : coneOf(g, turn);
  if (!isPromised(fold)) return {};
  const auto error = float(hitPointError(fold.faces[0]) * g.between(1.0, 1.25));
  const std::optional<Graze> ray = grazingRay(fold, g, least, most);
  if (!ray) return {};
  const double cosine = -glm::dot(dvec3(ray->direction), normalOf(fold.faces[0]));
  const std::optional<dvec3> start = startOn(fold, ray->origin, ray->direction, error);
  if (!start || cosine < least || cosine > most) return {};
  const float t = hitOn(fold.faces[0], ray->origin, ray->direction).t;
  GrazingTrial trial;
  for (size_t i = 1; i < fold.faces.size(); ++i) {
    const std::array<vec3, 3>& v = fold.faces[i];
    const float there = hitOn(v, ray->origin, ray->direction).t;
    if (there > 0.0f && there < t) return {};  // the ray does not arrive
    const double unit = std::max(hitPointError(v), hitPointError(fold.faces[0])) / 32.0;
    const double height = glm::dot(normalOf(v), *start - dvec3(v[0])) / unit;
    trial.height = std::min(trial.height, height);
    trial.share = std::min(trial.share, height * cosine / (1.0 + double(t) / (unit * 0x1p24)));
  }
  return trial;
}

TEST(LimitSearch, NoRayBeginsFarBehindANeighbour) {
  Draw draw(uint32_t(numberFrom("FRAGTRACE_ATTACK_SEED", 1)));
  const long cases = numberFrom("FRAGTRACE_ATTACK_RAYS", 6000) * 20;
  long promised = 0;
  double share = kImpossible;
  std::array<double, kCosineBands> lowest;
  for (int band = 0; band < kCosineBands; ++band) {
    double& height = lowest[size_t(band)] = kImpossible;
    const Climbed found = climb(draw, cases / kCosineBands, 4000, [&](const Genes& genes) {
      const GrazingTrial trial = grazingTrial(genes, std::exp2(-4 * band - 4), std::exp2(-4 * band));
      height = std::min(height, trial.height);
      return trial.share;
    });
    promised += found.promised;
    share = std::min(share, found.least);
  }
  std::printf(
      "%ld cases, %ld of them promised, least height %.3f eps m (1 + t / m) / cosine; by sixteenths of the "
      "cosine, in eps m:",
      cases, promised, share);
  for (const double height : lowest) std::printf(" %.0f", height);
  std::printf("\n");
  EXPECT_GT(share, -kMostBehind);
  EXPECT_GT(promised, cases / 4);
}

}  // namespace
}  // namespace fragtrace
