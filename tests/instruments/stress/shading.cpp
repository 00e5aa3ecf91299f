// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/rows.h"

#include <algorithm>
#include <array>

#include "base/text.h"
#include "scene/solids.h"
#include "tests/instruments/rays/ball_scene.h"
#include "tests/instruments/rays/dice.h"
#include "tests/instruments/stress/drawn.h"

namespace fragtrace {

namespace {

using glm::dvec3;
using glm::vec3;

/// The largest relative rounding error that is allowed for a path of many reflections that lose nothing.
constexpr double kRounding = 1e-4;

/// Scattered rays alone find the world, so that no sample is brighter than it.
RenderOptions furnaceOptions(const StressSetting& setting) {
  RenderOptions options = optionsOf(setting, Stage::Gi);
  options.stages.reset(size_t(Stage::LightSampling));
  return options;
}

/// Path tracing to the end: no roulette, which would make samples brighter than the world.
View furnaceView(const dvec3& position, const dvec3& towards) {
  View view;
  view.camera.position = position;
  view.camera.forward = glm::normalize(towards - position);
  view.camera.up =
      glm::normalize(glm::cross(glm::cross(view.camera.forward, dvec3(0.2, 1.0, 0.1)), view.camera.forward));
  view.bounces = 256;
  view.rouletteDepth = 1000;
  return view;
}

/// Counts the pixels of a picture of a white world, and as failures those that are not between `least` and
/// `most`.
void judgeFurnace(const FilmPixels& film, double least, double most, const char* what,
                  StressOutcome& outcome) {
  for (const FilmPixel& p : film.pixels) {
    if (p.alpha < double(p.samples)) continue;  // sees the world itself
    ++outcome.cases;
    const double brightest = std::max({p.mean().x, p.mean().y, p.mean().z});
    const double darkest = std::min({p.mean().x, p.mean().y, p.mean().z});
    if (p.nonfinite == 0 && darkest >= least && brightest <= most) continue;
    ++outcome.failures;
    outcome.worst = formatted("%s: a pixel is %.6g, not in %.6g to %.6g", what,
                              darkest < least ? darkest : brightest, least, most);
  }
}

/// Paths in a white world, off white mirrors, that bring back less than all of its light (one each), or more.
void judgeMirrorFurnace(const FilmPixels& film, const char* what, StressOutcome& outcome) {
  size_t lost = 0;
  for (const FilmPixel& p : film.pixels) {
    if (p.alpha < double(p.samples)) continue;  // sees the world itself
    outcome.cases += p.samples;
    const double missing = double(p.samples) - p.sum.x;
    const bool wrong = p.nonfinite > 0 || missing < -kRounding * double(p.samples);
    lost += wrong ? p.samples : size_t(std::lround(std::max(missing, 0.0)));
  }
  if (lost == 0) return;
  outcome.failures += lost;
  outcome.worst = formatted("%s: %zu paths lost or gained light", what, lost);
}

Scene whiteBall() {
  Scene scene = makeBallScene(2000);
  for (Material& m : scene.materials) {
    m.baseColorFactor = glm::vec4(1.0f);
    m.doubleSided = true;
  }
  for (Triangle& t : scene.triangles) t.flat = false;
  scene.vertices.normal.resize(scene.vertices.position.size());
  for (size_t i = 0; i < scene.vertices.normal.size(); ++i)
    scene.vertices.normal[i] = glm::normalize(scene.vertices.position[i]);
  return scene;
}

/// A box of glass; `low` and `high` are its corners.
void addBox(Scene& scene, const dvec3& low, const dvec3& high, uint32_t material) {
  const auto first = uint32_t(scene.vertices.position.size());
  for (uint32_t i = 0; i < 8; ++i) {
    const dvec3 p((i & 1u) != 0 ? high.x : low.x, (i & 2u) != 0 ? high.y : low.y,
                  (i & 4u) != 0 ? high.z : low.z);
    scene.vertices.position.emplace_back(p);
    scene.bounds.include(p);
  }
  constexpr std::array<std::array<uint32_t, 4>, 6> kSides = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& [a, b, c, d] : kSides) {
    scene.triangles.push_back({glm::uvec3(first + a, first + b, first + c), material, true});
    scene.triangles.push_back({glm::uvec3(first + a, first + c, first + d), material, true});
  }
}

void addBall(Scene& scene, const dvec3& center, double radius, uint32_t material) {
  scene.spheres.push_back({vec3(center), float(radius), {1, 0, 0, 0}, material});
  scene.bounds.include(center - dvec3(radius));
  scene.bounds.include(center + dvec3(radius));
}

Scene glassScene() {
  Scene scene;
  scene.materials.resize(4);
  const std::array<float, 4> indices{1.5f, 1.33f, 1.0f, 1.0f};
  for (size_t i = 0; i < indices.size(); ++i) {
    Material& m = scene.materials[i];
    m.ior = indices[i];
    m.transmissionFactor = 1.0f;
    m.thicknessFactor = 1.0f;
    m.metallicFactor = 0.0f;
    m.roughnessFactor = i == 3 ? 0.7f : 0.0f;
  }
  return scene;
}

struct GlassCase {
  const char* name;
  Scene scene;
  dvec3 camera;
  dvec3 towards;
  double brightness;
};

std::vector<GlassCase> glassCases() {
  constexpr uint32_t kGlass = 0;
  constexpr uint32_t kWater = 1;
  constexpr uint32_t kNothing = 2;
  constexpr uint32_t kRoughNothing = 3;
  const dvec3 away(1.5, 1.1, 3.0);
  std::vector<GlassCase> cases;
  const auto add = [&](const char* name, const dvec3& camera, double brightness, const auto& fill) {
    cases.push_back({name, glassScene(), camera, dvec3(0.01, 0.02, 0.0), brightness});
    fill(cases.back().scene);
  };
  add("nested balls", away, 1.0, [&](Scene& s) {
    addBall(s, dvec3(0.0), 1.0, kWater);
    addBall(s, dvec3(0.2, 0.0, 0.1), 0.5, kGlass);
  });
  add("touching boxes", away, 1.0, [&](Scene& s) {
    addBox(s, dvec3(-1.0, -0.5, -0.5), dvec3(0.0, 0.5, 0.5), kWater);
    addBox(s, dvec3(0.0, -0.5, -0.5), dvec3(1.0, 0.5, 0.5), kGlass);
  });
  add("one box in another that it touches", away, 1.0, [&](Scene& s) {
    addBox(s, dvec3(-1.0), dvec3(1.0), kWater);
    addBox(s, dvec3(-0.5, -1.0, -0.5), dvec3(0.5), kGlass);
  });
  add("index 1, box", away, 1.0, [&](Scene& s) { addBox(s, dvec3(-0.7), dvec3(0.7), kNothing); });
  add("index 1, ball", away, 1.0, [&](Scene& s) { addBall(s, dvec3(0.0), 1.0, kNothing); });
  add("index 1, rough ball", away, 1.0, [&](Scene& s) { addBall(s, dvec3(0.0), 1.0, kRoughNothing); });
  add("from inside a ball", dvec3(0.1, 0.2, 0.3), 1.5 * 1.5,
      [&](Scene& s) { addBall(s, dvec3(0.0), 1.0, kGlass); });
  return cases;
}

}  // namespace

StressOutcome shadeBadNormals(const StressSetting& setting) {
  const glm::ivec2 size = setting.quick ? glm::ivec2(32) : glm::ivec2(128);
  const int samples = setting.quick ? 256 : 1024;  // so that noise takes no pixel below the bound
  StressOutcome outcome;
  Dice dice(5 + setting.seed * kSeedStride);
  for (const char* kind : {"of zero length", "backwards", "tilted", "all three"}) {
    Scene scene = whiteBall();
    for (Material& m : scene.materials) m.metallicFactor = 0.0f, m.specularFactor = 0.0f;
    for (vec3& n : scene.vertices.normal) {
      const size_t which = kind[0] == 'o' ? 0 : kind[0] == 'b' ? 1 : kind[0] == 't' ? 2 : dice.below(3);
      if (which == 0) n = vec3(0.0f);
      if (which == 1) n = -n;
      if (which == 2) n = glm::normalize(n + vec3(2.0 * dice.direction()));
    }
    SceneDrawing picture = drawingOf(setting, scene, whiteWorld(1.0f), furnaceOptions(setting));
    // Light that would leave below the true surface is lost: a white ball may be grey, but not black.
    judgeFurnace(picture.draw(setting.goOn, furnaceView(dvec3(1.0, 2.0, 3.0), dvec3(0.0)), size, samples),
                 0.2, 1.0 + kRounding, kind, outcome);
  }
  return outcome;
}

StressOutcome shadeBadTangents(const StressSetting& setting) {
  const glm::ivec2 size = setting.quick ? glm::ivec2(32) : glm::ivec2(128);
  StressOutcome outcome;
  Dice dice(6 + setting.seed * kSeedStride);
  for (const char* kind : {"of zero length", "along the normal", "anywhere"}) {
    Scene scene = whiteBall();
    for (Material& m : scene.materials) {
      m.metallicFactor = 1.0f;
      m.roughnessFactor = 0.0f;
      m.perlinNormal = {4.0f, 8.0f, 3};
    }
    Vertices& v = scene.vertices;
    v.texcoord0.resize(v.position.size());
    v.tangent.resize(v.position.size());
    for (size_t i = 0; i < v.position.size(); ++i) {
      v.texcoord0[i] = glm::vec2(v.position[i].x + 0.3f * v.position[i].z, v.position[i].y);
      const vec3 tangent = kind[0] == 'o'   ? vec3(0.0f)
                           : kind[1] == 'l' ? v.normal[i]
                                            : vec3(dice.direction());
      v.tangent[i] = glm::vec4(tangent, dice.coin() ? 1.0f : -1.0f);
    }
    SceneDrawing picture = drawingOf(setting, scene, whiteWorld(1.0f), furnaceOptions(setting));
    judgeMirrorFurnace(picture.draw(setting.goOn, furnaceView(dvec3(1.0, 2.0, 3.0), dvec3(0.0)), size, 64),
                       kind, outcome);
  }
  return outcome;
}

StressOutcome lookThroughGlass(const StressSetting& setting) {
  const glm::ivec2 size = setting.quick ? glm::ivec2(32) : glm::ivec2(128);
  StressOutcome outcome;
  for (const GlassCase& c : glassCases()) {
    SceneDrawing picture = drawingOf(setting, c.scene, whiteWorld(1.0f), furnaceOptions(setting));
    View view = furnaceView(c.camera, c.towards);
    view.cameraSolids = cameraSolids(solidsOf(c.scene), c.camera);
    // A few paths go round inside for longer than they are followed.
    judgeFurnace(picture.draw(setting.goOn, view, size, 64), 0.95 * c.brightness,
                 c.brightness * (1.0 + kRounding), c.name, outcome);
  }
  return outcome;
}

StressOutcome lookAtContactShadow(const StressSetting& setting) {
  const glm::ivec2 size = setting.quick ? glm::ivec2(64) : glm::ivec2(512);
  StressOutcome outcome;
  for (const double scale : {1e-3, 1.0, 1e3}) {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].metallicFactor = 0.0f;
    scene.materials[0].doubleSided = true;
    addBox(scene, scale * dvec3(-4.0, -1.0, -4.0), scale * dvec3(4.0, 0.0, 4.0), 0);
    addBox(scene, scale * dvec3(-3.0, 0.0, -1.0), scale * dvec3(3.0, 2.0, 0.0), 0);
    Light sun;
    sun.type = LightType::Directional;
    sun.direction = glm::normalize(vec3(0.1f, -1.0f, 1.0f));
    scene.lights.push_back(sun);
    RenderOptions options = optionsOf(setting, Stage::Shadows);
    SceneDrawing picture = drawingOf(setting, scene, {}, options);
    // Close to the line where the wall meets the floor, which lies in the wall's shadow; ambient light is
    // 0.03.
    View view = furnaceView(scale * dvec3(0.3, 0.01, 0.02), scale * dvec3(0.31, 0.0, 0.0));
    view.showEnvironment = false;
    const FilmPixels film = picture.draw(setting.goOn, view, size, 4);
    for (const FilmPixel& p : film.pixels) {
      ++outcome.cases;
      if (p.nonfinite == 0 && p.mean().x <= 0.0301) continue;
      ++outcome.failures;
      outcome.worst = formatted("at a scale of %g a pixel in the shadow is %.6g", scale, p.mean().x);
    }
  }
  return outcome;
}

}  // namespace fragtrace
