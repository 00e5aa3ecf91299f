// SPDX-License-Identifier: MIT
// Closed prisms that are made in memory, and paths inside them.
#pragma once

#include <glm/gtc/quaternion.hpp>

#include "tests/instruments/rays/dice.h"
#include "tests/instruments/stress/drawn.h"

namespace fragtrace {

/// A closed prism, turned and moved, and a point inside. Its one material is matt, white and seen from both
/// sides.
struct Prism {
  Prism();

  /// Adds a corner, given before the turn, and returns its index.
  uint32_t add(const glm::dvec3& p);
  /// Adds a triangle, unless two of its corners are one.
  void face(uint32_t a, uint32_t b, uint32_t c);
  void quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d);

  Scene scene;
  glm::dvec3 inside{0.0};
  glm::dquat turn{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 place{0.0};
};

glm::dquat randomRotation(Dice& dice);

/// A skew box of 1 x 1 x length, its sides at an angle, of 12 triangles.
Prism makeBox(double degrees, double length, bool turned, Dice& dice);

/// Traces paths inside in a bright world. Cases are paths, failures pixels that are not black.
void scatterIn(const StressSetting& setting, const Prism& prism, bool literals, StressOutcome& outcome);

}  // namespace fragtrace
