// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/random_sketch.h"

#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

namespace fragtrace {

namespace {

enum class Kind : uint32_t { Diffuse, Shiny, Glass, Blended, Mapped, Sky };

void addQuad(SketchMesh& mesh, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
             const glm::vec3& d) {
  const auto first = uint32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {a, b, c, d});
  mesh.triangles.insert(mesh.triangles.end(), {glm::uvec3(0, 1, 2) + first, glm::uvec3(0, 2, 3) + first});
}

SketchMesh box() {
  SketchMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-0.5f, 0.5f}) {
      glm::vec3 n(0.0f);
      glm::vec3 u(0.0f);
      n[axis] = side;
      u[(axis + 1) % 3] = side;
      const glm::vec3 v = glm::cross(n, u) * 2.0f;
      addQuad(mesh, n - u - v, n + u - v, n + u + v, n - u + v);
    }
  }
  return mesh;
}

/// Closed: a sphere of rings and segments, its radius displaced.
SketchMesh ball(Dice& dice, bool smooth) {
  constexpr uint32_t kRings = 6;
  constexpr uint32_t kSegments = 9;
  const double bumps = dice.between(0.0, 0.15);
  SketchMesh mesh;
  mesh.positions.emplace_back(0.0f, 0.5f, 0.0f);
  for (uint32_t ring = 1; ring < kRings; ++ring) {
    for (uint32_t s = 0; s < kSegments; ++s) {
      const double theta = glm::pi<double>() * ring / kRings;
      const double phi = glm::two_pi<double>() * s / kSegments;
      const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
      mesh.positions.emplace_back(d * (0.5 + bumps * dice.between(-1.0, 1.0)));
    }
  }
  mesh.positions.emplace_back(0.0f, -0.5f, 0.0f);
  const auto at = [](uint32_t ring, uint32_t s) { return 1 + (ring - 1) * kSegments + s % kSegments; };
  const auto last = uint32_t(mesh.positions.size() - 1);
  for (uint32_t s = 0; s < kSegments; ++s) {
    mesh.triangles.emplace_back(0, at(1, s), at(1, s + 1));
    for (uint32_t ring = 1; ring + 1 < kRings; ++ring) {
      mesh.triangles.emplace_back(at(ring, s), at(ring + 1, s), at(ring + 1, s + 1));
      mesh.triangles.emplace_back(at(ring, s), at(ring + 1, s + 1), at(ring, s + 1));
    }
    mesh.triangles.emplace_back(at(kRings - 1, s), last, at(kRings - 1, s + 1));
  }
  for (const glm::vec3& p : mesh.positions) {
    if (smooth) mesh.normals.push_back(glm::normalize(p));
  }
  return mesh;
}

SketchMesh soup(Dice& dice) {
  SketchMesh mesh;
  for (uint32_t i = 0; i < 12; ++i) {
    const glm::dvec3 middle = dice.inCube(0.5);
    for (int corner = 0; corner < 3; ++corner) mesh.positions.emplace_back(middle + dice.inCube(0.3));
    mesh.triangles.push_back(glm::uvec3(0, 1, 2) + 3 * i);
  }
  return mesh;
}

/// Triangles that no ray should meet, or none twice: corners that fall together or lie on a line, slivers,
/// copies.
void addDegenerate(Dice& dice, SketchMesh& mesh) {
  const auto corner = [&] { return uint32_t(dice.below(mesh.positions.size())); };
  const uint32_t a = corner();
  const uint32_t b = corner();
  mesh.triangles.emplace_back(a, a, b);
  mesh.triangles.emplace_back(a, a, a);
  mesh.triangles.push_back(mesh.triangles[dice.below(mesh.triangles.size())]);
  const auto middle = uint32_t(mesh.positions.size());
  mesh.positions.push_back(0.5f * (mesh.positions[a] + mesh.positions[b]));
  mesh.positions.push_back(mesh.positions[middle] + glm::vec3(1e-6f, 0.0f, 0.0f));
  if (!mesh.normals.empty()) mesh.normals.insert(mesh.normals.end(), 2, glm::vec3(0, 1, 0));
  mesh.triangles.emplace_back(a, middle, b);
  mesh.triangles.emplace_back(a, b, middle + 1);
}

glm::dmat4 randomTurn(Dice& dice) {
  const double angle = dice.between(0.0, glm::two_pi<double>());
  return glm::rotate(glm::dmat4(1.0), angle, dice.direction());
}

glm::dvec3 randomColor(Dice& dice) {
  const double r = dice.between(0.2, 0.85);
  const double g = dice.between(0.2, 0.85);
  return {r, g, dice.between(0.2, 0.85)};
}

/// Materials 0 and 1 are of floor and lamp.
std::vector<SketchMaterial> randomMaterials(Dice& dice, Kind kind) {
  std::vector<SketchMaterial> materials(5);
  for (SketchMaterial& m : materials) {
    m.color = randomColor(dice);
    m.roughness = dice.between(0.35, 1.0);
    m.doubleSided = true;
  }
  materials[1].emission = glm::dvec3(1.0) * dice.between(0.6, 1.0);
  materials[2].doubleSided = false;
  if (kind == Kind::Shiny) materials[3].metallic = 1.0;
  if (kind == Kind::Glass) {
    materials[3].transmission = 1.0;
    materials[3].thickness = 0.5;
    materials[3].attenuationDistance = dice.between(0.2, 2.0);
  }
  if (kind == Kind::Blended) materials[3].alpha = dice.between(0.2, 0.8);
  if (kind == Kind::Sky) materials[4].metallic = 1.0;
  if (kind == Kind::Mapped) {
    for (const size_t i : {0, 2, 3}) {
      materials[i].color = glm::dvec3(1.0);
      materials[i].colorTexture = 0;
      materials[i].textureScale = {dice.between(0.3, 3.0), dice.between(-3.0, -0.3)};
      materials[i].textureTurn = dice.between(0.0, glm::two_pi<double>());
    }
    for (const size_t i : {2, 3, 4}) materials[i].normalTexture = 1;
  }
  return materials;
}

/// A picture of light and dark colours, and one of normals that lean by up to 40 degrees; of few texels, so
/// that no pattern averages out.
std::vector<SketchTexture> randomTextures(Dice& dice) {
  constexpr std::array kWraps{10497, 33071, 33648};
  std::vector<SketchTexture> textures(2);
  for (SketchTexture& texture : textures) texture.wrap = kWraps[dice.below(kWraps.size())];
  for (int i = 0; i < textures[0].side * textures[0].side; ++i) {
    const double light = dice.coin() ? 0.05 : 1.0;
    textures[0].texels.emplace_back(255.0 * light * randomColor(dice));
    const double x = dice.between(-0.6, 0.6);
    const glm::dvec3 normal = glm::normalize(glm::dvec3(x, dice.between(-0.6, 0.6), 1.0));
    textures[1].texels.emplace_back(255.0 * (0.5 + 0.5 * normal));
  }
  return textures;
}

/// Seen from one side, so that neighbours in a plane have the same tangent. Tangents are given with normals;
/// where those are made, they depend on how triangles hang together, which forms change.
void addTexcoords(Dice& dice, SketchMesh& mesh) {
  const glm::dmat3 turn(randomTurn(dice));
  for (const glm::vec3& p : mesh.positions)
    mesh.texcoords.emplace_back(glm::dot(turn[0], glm::dvec3(p)), glm::dot(turn[1], glm::dvec3(p)));
  const double handedness = dice.coin() ? 1.0 : -1.0;
  for (const glm::vec3& n : mesh.normals) {
    const glm::dvec3 tangent = glm::cross(turn[1], glm::dvec3(n));
    const double length = glm::length(tangent);
    mesh.tangents.emplace_back(length > 1e-3 ? tangent / length : turn[0], handedness);
  }
}

/// Spheres of materials 2 and 4.
void addSpheres(Dice& dice, SceneSketch& sketch) {
  for (const size_t material : {2, 4}) {
    SketchNode node;
    node.local = glm::translate(glm::dmat4(1.0), dice.inCube(1.3)) * randomTurn(dice);
    node.local = glm::scale(node.local, glm::dvec3(dice.between(0.5, 1.5)));
    node.radius = dice.between(0.3, 0.6);
    node.sphereMaterial = material;
    sketch.nodes.push_back(node);
  }
}

/// Dim, except for one bright texel.
Image randomSky(Dice& dice) {
  Image sky{16, 8, {"R", "G", "B"}, {}, {}};
  for (int i = 0; i < 3 * sky.width * sky.height; ++i) sky.values.push_back(float(dice.between(0.05, 0.4)));
  const size_t bright = 3 * dice.below(sky.values.size() / 3);
  for (size_t c = 0; c < 3; ++c) sky.values[bright + c] = 8.0f;
  return sky;
}

glm::dmat4 randomCamera(Dice& dice) {
  const glm::dvec3 from(dice.between(-2.5, 2.5), dice.between(0.0, 2.0), 6.0);
  return lookingFrom(from, glm::dvec3(0.0));
}

}  // namespace

SceneSketch randomSketch(uint32_t seed) {
  Dice dice(seed);
  const auto kind = Kind(seed % kSketchKinds);
  SceneSketch sketch;
  sketch.materials = randomMaterials(dice, kind);

  // Floor and lamp.
  SketchMesh floor;
  addQuad(floor, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4});
  SketchMesh lamp;
  addQuad(lamp, {-2, 0, -2}, {2, 0, -2}, {2, 0, 2}, {-2, 0, 2});
  lamp.material = 1;
  sketch.meshes = {floor, lamp};
  sketch.nodes.push_back({glm::translate(glm::dmat4(1.0), glm::dvec3(0, -1.5, 0)), -1, 0});
  sketch.nodes.push_back({glm::translate(glm::dmat4(1.0), glm::dvec3(0, 2.5 + dice.unit(), 0)), -1, 1});

  // Meshes of each material, smooth ones among them in every scene.
  for (size_t material = 2; material < sketch.materials.size(); ++material) {
    const size_t shape = material == 3 ? 1 : dice.below(3);
    SketchMesh mesh = shape == 0 ? box() : shape == 1 ? ball(dice, material == 3) : soup(dice);
    mesh.material = material;
    // Glass that is not closed has no inside.
    if (material != 3) addDegenerate(dice, mesh);
    sketch.meshes.push_back(std::move(mesh));
  }

  // Each is shown by two nodes, most of them below others.
  for (int i = 0; i < 6; ++i) {
    SketchNode node;
    node.mesh = 2 + i % 3;
    const bool below = i > 0 && dice.unit() < 0.6;
    node.parent = below ? 2 + int(dice.below(size_t(i))) : -1;
    const glm::dvec3 place = dice.inCube(below ? 0.8 : 1.3);
    glm::dvec3 scale(dice.between(0.5, 1.2), dice.between(0.5, 1.2), dice.between(0.5, 1.2));
    if (dice.unit() < 0.3) scale.x = -scale.x;
    node.local = glm::scale(glm::translate(glm::dmat4(1.0), place) * randomTurn(dice), scale);
    sketch.nodes.push_back(node);
  }
  if (kind == Kind::Blended) sketch.lights.push_back({{dice.between(-1.5, 1.5), 2.0, 1.5}, 4.0});
  sketch.camera = randomCamera(dice);
  if (kind == Kind::Mapped) {
    sketch.textures = randomTextures(dice);
    for (SketchMesh& mesh : sketch.meshes) addTexcoords(dice, mesh);
  }
  if (kind == Kind::Sky) sketch.sky = randomSky(dice);
  if (kind == Kind::Mapped || kind == Kind::Sky) addSpheres(dice, sketch);
  return sketch;
}

}  // namespace fragtrace
