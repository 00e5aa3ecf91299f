// SPDX-License-Identifier: MIT
// The same picture at any scale and place, and of a small thing in a large scene.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "gl_probe.h"
#include "tests/instruments/stress/random_sketch.h"
#include "tests/instruments/stress/scene_drawing.h"

namespace fragtrace {
namespace {

RenderOptions optionsOf(int spp) {
  RenderOptions options;
  options.sampling.spp = spp;
  options.sampling.bounces = 4;
  options.camera.resolution = glm::ivec2(32);
  options.device.traversal = TraversalMethod::FrontToBack;
  return options;
}

/// Pixels whose depths are more than `share` apart, or of which one is empty.
size_t countOther(const FilmPixels& a, const FilmPixels& b, double scale, double share) {
  size_t count = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const double depth = a.pixels[i].mean().x;
    count += !(std::abs(b.pixels[i].mean().x / scale - depth) <= share * depth);
  }
  return count;
}

size_t countEmpty(const FilmPixels& film) {
  size_t count = 0;
  for (const FilmPixel& p : film.pixels) count += p.mean().x == 0.0;
  return count;
}

double meanOf(const FilmPixels& film) {
  double sum = 0.0;
  for (const FilmPixel& p : film.pixels) sum += p.luminance();
  return sum / double(film.pixels.size());
}

struct Drawn {
  FilmPixels film;
  FilmPixels depth;
};

class Places : public GlProbe {
 protected:
  Drawn draw(const SceneSketch& sketch, int spp) const {
    SceneDrawing drawing(context(), sceneOf(sketch), optionsOf(spp));
    return {drawing.picture([] {}), drawing.depth([] {})};
  }
};

/// Glass that absorbs, a lamp, and everything as far away from 1 as it may be.
TEST_P(Places, TheSamePictureAtAnyScale) {
  const SceneSketch sketch = randomSketch(2);
  const Drawn expected = draw(sketch, 64);
  for (const double factor : {1e-6, 3e-4, 7e2, 1e6}) {
    SceneSketch scaled = sketch;
    scaled.root = glm::scale(glm::dmat4(1.0), glm::dvec3(factor));
    for (SketchMaterial& m : scaled.materials) m.attenuationDistance *= factor;
    const Drawn drawing = draw(scaled, 64);
    EXPECT_EQ(totalsOf(drawing.film).nonfinitePixels, 0u);
    EXPECT_LE(countOther(expected.depth, drawing.depth, factor, 1e-4), 1u) << factor;
    EXPECT_NEAR(meanOf(drawing.film) / meanOf(expected.film), 1.0, 1e-3) << factor;
  }
}

/// In metres, which llvmpipe takes for zero.
TEST_P(Places, DenormalCoordinates) {
  const SceneSketch sketch = randomSketch(0);
  SceneSketch scaled = sketch;
  scaled.root = glm::scale(glm::dmat4(1.0), glm::dvec3(0x1p-140));
  EXPECT_NEAR(meanOf(draw(scaled, 64).film) / meanOf(draw(sketch, 64).film), 1.0, 1e-3);
}

TEST_P(Places, TheSamePictureAtAnyPlace) {
  const SceneSketch sketch = randomSketch(1);
  const Drawn expected = draw(sketch, 64);
  for (const glm::dvec3& by : {glm::dvec3(148376, 1234, -223423), glm::dvec3(8e6, -8e6, 8e6)}) {
    SceneSketch moved = sketch;
    moved.root = glm::translate(glm::dmat4(1.0), by);
    const Drawn drawing = draw(moved, 64);
    EXPECT_LE(countOther(expected.depth, drawing.depth, 1.0, 1e-4), 1u) << by.x;
    EXPECT_NEAR(meanOf(drawing.film) / meanOf(expected.film), 1.0, 1e-3) << by.x;
  }
}

/// A ball of a millimetre, 4 km from the middle of a scene of 10 km, a few millimetres in front of the
/// camera, shows what it would show on its own.
TEST_P(Places, AMillimetreInTenKilometres) {
  SceneSketch sketch = randomSketch(0);
  SketchMesh ball = sketch.meshes[3];
  for (glm::vec3& p : ball.positions) p *= 1e-3f;
  SketchMesh horizon;
  horizon.positions = {{-5000, -5000, -5000}, {5000, -5000, -5000}, {-5000, 5000, -5000}};
  horizon.triangles = {{0, 1, 2}};
  const glm::dvec3 place(3217.123, -1234.567, 4321.987);
  SceneSketch alone;
  alone.materials = sketch.materials;
  alone.meshes = {ball};
  alone.nodes.push_back({glm::translate(glm::dmat4(1.0), place), -1, 0});
  alone.camera = lookingFrom(place + glm::dvec3(0.001, 0.001, 0.002), place);
  const Drawn expected = draw(alone, 1);
  EXPECT_GT(countEmpty(expected.depth), 100u);
  EXPECT_LT(countEmpty(expected.depth), 900u);
  SceneSketch within = alone;
  within.meshes.push_back(horizon);
  within.nodes.push_back({glm::dmat4(1.0), -1, 1});
  Drawn drawing = draw(within, 1);
  // Pixels that were empty may now show the horizon.
  for (size_t i = 0; i < drawing.depth.pixels.size(); ++i) {
    FilmPixel& p = drawing.depth.pixels[i];
    if (expected.depth.pixels[i].mean().x == 0.0 && p.mean().x > 1.0) p.sum = glm::dvec3(0.0);
  }
  EXPECT_LE(countOther(expected.depth, drawing.depth, 1.0, 1e-3), 2u);
}

/// A lamp a million times as bright next to walls that it lights: neither it nor they lose anything.
TEST_P(Places, BrightnessIsNoMatter) {
  SceneSketch sketch = randomSketch(0);
  const Drawn expected = draw(sketch, 16);
  sketch.materials[1].emission *= 0x1p20;
  const Drawn bright = draw(sketch, 16);
  for (size_t i = 0; i < expected.film.pixels.size(); ++i) {
    const double dim = expected.film.pixels[i].luminance();
    EXPECT_NEAR(bright.film.pixels[i].luminance() * 0x1p-20, dim, 1e-5 * dim);
  }
}

INSTANTIATE_TEST_SUITE_P(Backends, Places, bothBackends(), backendName);

}  // namespace
}  // namespace fragtrace
