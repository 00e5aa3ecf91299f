// SPDX-License-Identifier: MIT
// Are hits right? Comparisons of what measurements found with double precision.
#pragma once

#include <span>
#include <vector>

#include "bvh/exact_tracer.h"
#include "tests/instruments/rays/ray_caster.h"

namespace fragtrace {

/// A hit as the device tells it: primitive, or kMissIndex, and distance.
struct FoundHit {
  uint32_t primitive = kMissIndex;
  float t = 0.0f;
};

/// Returns the hits of the last rays on this tree.
std::vector<FoundHit> foundBy(const RayCaster& caster, const Bvh& bvh);

/// Rays whose nearest hit is another one: a miss for a hit or the other way round, or another primitive at
/// another distance (more than 1e-5 of it and of the size of the scene apart; where two meet, either is
/// right).
size_t countWrongNearest(std::span<const Ray> rays, std::span<const FoundHit> found,
                         std::span<const ExactHit> exact, double sceneSize);

/// Does the same of rays that any hit ends: only whether there is one.
size_t countWrongAny(std::span<const Ray> rays, std::span<const FoundHit> found,
                     std::span<const ExactHit> exact);

/// Returns the number of rays that may be wrong: ties at edges and silhouettes, which rounding decides.
size_t wrongRaysAllowed(size_t rays);

/// Holds nearest() against nearestOfAll() on rays spread evenly over the set, as many as take about a second.
/// Returns how many were compared. Throws RenderError where they differ: the tree is wrong.
size_t proveTree(const ExactTracer& tracer, size_t primitives, std::span<const Ray> rays);

}  // namespace fragtrace
