// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <span>

#include "tests/instruments/stress/prism.h"

namespace fragtrace {

namespace {

using glm::dvec3;

/// Random places in [0, 1], sorted, both ends among them.
std::vector<double> cuts(uint32_t count, Dice& dice) {
  std::vector<double> places{0.0, 1.0};
  for (uint32_t i = 0; i < count; ++i) places.push_back(dice.unit());
  std::ranges::sort(places);
  return places;
}

/// The three sides are cut at places along the crease.
void cutAcross(Prism& w, double height, uint32_t count, Dice& dice) {
  std::vector<std::array<uint32_t, 3>> rows;
  for (const double t : cuts(count, dice)) {
    const double z = 2.0 * t - 1.0;
    rows.push_back({w.add({0.0, 0.0, z}), w.add({1.0, -height, z}), w.add({1.0, height, z})});
  }
  for (size_t i = 0; i + 1 < rows.size(); ++i) {
    for (size_t p = 0; p < 3; ++p)
      w.quad(rows[i][p], rows[i][(p + 1) % 3], rows[i + 1][(p + 1) % 3], rows[i + 1][p]);
  }
  w.face(rows[0][0], rows[0][2], rows[0][1]);
  w.face(rows.back()[0], rows.back()[1], rows.back()[2]);
}

/// Cuts the two sides at the crease, and the ends, at distances from the crease.
void cutAlong(Prism& w, double height, uint32_t count, Dice& dice) {
  struct Row {
    std::array<uint32_t, 2> low;  // at both ends
    std::array<uint32_t, 2> high;
  };
  std::vector<Row> rows;
  for (const double x : cuts(count, dice)) {
    Row r;
    for (size_t end = 0; end < 2; ++end) {
      const double z = end == 0 ? -1.0 : 1.0;
      r.low[end] = w.add({x, -height * x, z});
      r.high[end] = x == 0.0 ? r.low[end] : w.add({x, height * x, z});
    }
    rows.push_back(r);
  }
  for (size_t i = 0; i + 1 < rows.size(); ++i) {
    const Row& a = rows[i];
    const Row& b = rows[i + 1];
    w.quad(a.low[0], b.low[0], b.low[1], a.low[1]);
    w.quad(a.high[1], b.high[1], b.high[0], a.high[0]);
    w.quad(b.low[0], a.low[0], a.high[0], b.high[0]);
    w.quad(a.low[1], b.low[1], b.high[1], a.high[1]);
  }
  const Row& last = rows.back();
  w.quad(last.low[1], last.low[0], last.high[0], last.high[1]);
}

/// A prism from z = -1 to 1 with its crease along z and its back at x = 1, turned and moved.
Prism makeWedge(double degrees, bool across, uint32_t count, Dice& dice) {
  Prism w;
  w.turn = randomRotation(dice);
  w.place = dice.inCube(0.5);
  const double height = std::tan(glm::radians(degrees) / 2.0);
  w.inside = w.turn * dvec3(dice.between(0.1, 0.9), 0.0, dice.between(-0.9, 0.9)) + w.place;
  if (across) cutAcross(w, height, count, dice);
  if (!across) cutAlong(w, height, count, dice);
  return w;
}

/// Winds every other triangle or so the other way.
void flipSome(Prism& prism, Dice& dice) {
  for (Triangle& t : prism.scene.triangles) {
    if (dice.between(0.0, 1.0) < 0.5) std::swap(t.vertex.y, t.vertex.z);
  }
}

/// A see-through surface that lies on the walls, or inside of them by a share of the way to the middle.
struct Skin {
  AlphaMode mode;
  float alpha;
  double gap;
};

/// Two more triangles for each, in front of or behind those of the walls in the scene's order.
void addSkin(Prism& box, const Skin& skin, bool first, bool flipped) {
  Scene& scene = box.scene;
  Material material = scene.materials[0];
  material.alphaMode = skin.mode;
  material.baseColorFactor.w = skin.alpha;
  scene.materials.push_back(material);
  const auto corners = uint32_t(scene.vertices.position.size());
  const dvec3 middle = scene.bounds.center();
  for (uint32_t i = 0; i < corners; ++i) {
    const dvec3 p(scene.vertices.position[i]);
    scene.vertices.position.emplace_back(p + skin.gap * (middle - p));
  }
  std::vector<Triangle> triangles = scene.triangles;
  for (Triangle& t : triangles) {
    t.vertex += corners;
    t.material = 1;
    if (flipped) std::swap(t.vertex.y, t.vertex.z);
  }
  scene.triangles.insert(first ? scene.triangles.begin() : scene.triangles.end(), triangles.begin(),
                         triangles.end());
}

}  // namespace

StressOutcome scatterInStrips(const StressSetting& setting) {
  constexpr std::array kDegrees{5.0, 20.0, 1.0, 2.0, 60.0};
  const size_t angles = setting.quick ? 2 : kDegrees.size();
  Dice dice(60 + setting.seed * kSeedStride);
  StressOutcome outcome;
  for (const bool flipping : {false, true}) {
    for (const double degrees : std::span(kDegrees).first(angles)) {
      for (const bool across : {true, false}) {
        for (const bool literals : {false, true}) {
          Prism prism = makeWedge(degrees, across, literals ? 6 : 60, dice);
          if (flipping) flipSome(prism, dice);
          scatterIn(setting, prism, literals, outcome);
        }
      }
    }
  }
  return outcome;
}

StressOutcome scatterInBoxes(const StressSetting& setting) {
  Dice dice(90 + setting.seed * kSeedStride);
  StressOutcome outcome;
  for (const double degrees : {90.0, 89.0, 91.0}) {
    for (const double length : {1.0, 30.0, 1000.0}) {
      if (setting.quick && length != 1000.0) continue;
      for (const bool turned : {false, true}) {
        for (const bool literals : {false, true}) {
          const Prism box = makeBox(degrees, length, turned, dice);
          scatterIn(setting, box, literals, outcome);
        }
      }
    }
  }
  return outcome;
}

StressOutcome scatterInSkinnedBoxes(const StressSetting& setting) {
  // Some of what an opaque point of a skin scatters away from the inside begins behind the wall unless the
  // gap is above both offsets or far below them; what lets everything pass scatters nothing.
  const std::array<Skin, 5> skins{Skin{AlphaMode::Blend, 0.3f, 0.0},
                                  {AlphaMode::Blend, 0.3f, 4e-7},
                                  Skin{AlphaMode::Mask, 0.0f, 0.0},
                                  {AlphaMode::Mask, 0.0f, 1e-6},
                                  Skin{AlphaMode::Mask, 0.0f, 4e-6}};
  Dice dice(120 + setting.seed * kSeedStride);
  StressOutcome outcome;
  for (const Skin& skin : skins) {
    for (const bool first : {false, true}) {
      for (const bool flipped : {false, true}) {
        for (const bool literals : {false, true}) {
          if (setting.quick && first != flipped) continue;
          Prism box = makeBox(90.0, 1.0, true, dice);
          addSkin(box, skin, first, flipped);
          scatterIn(setting, box, literals, outcome);
        }
      }
    }
  }
  return outcome;
}

}  // namespace fragtrace
