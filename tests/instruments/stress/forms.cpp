// SPDX-License-Identifier: MIT
#include "tests/instruments/stress/forms.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>
#include <utility>

#include "tests/instruments/rays/dice.h"

namespace fragtrace {

namespace {

constexpr double kSize = 8.0;  // metres; that of sketches

SceneSketch scaled(SceneSketch sketch, double factor) {
  sketch.root = glm::scale(glm::dmat4(1.0), glm::dvec3(factor)) * sketch.root;
  for (SketchMaterial& m : sketch.materials) {
    m.attenuationDistance *= factor;
    m.thickness *= factor;
  }
  for (SketchLight& light : sketch.lights) light.intensity *= factor * factor;
  return sketch;
}

template <typename Element>
void shuffle(std::vector<Element>& elements, Dice& dice) {
  for (size_t i = elements.size(); i > 1; --i) std::swap(elements[i - 1], elements[dice.below(i)]);
}

std::vector<size_t> shuffledIndices(size_t count, Dice& dice) {
  std::vector<size_t> order(count);
  std::iota(order.begin(), order.end(), size_t(0));
  shuffle(order, dice);
  return order;
}

/// Triangles, meshes and nodes; a node stays behind its parent.
SceneSketch reordered(SceneSketch sketch, Dice& dice) {
  for (SketchMesh& mesh : sketch.meshes) {
    shuffle(mesh.triangles, dice);
    for (glm::uvec3& t : mesh.triangles) {
      for (size_t turns = dice.below(3); turns > 0; --turns) t = {t.y, t.z, t.x};
    }
  }
  const std::vector<size_t> order = shuffledIndices(sketch.meshes.size(), dice);
  std::vector<int> newMesh(order.size());
  std::vector<SketchMesh> meshes;
  for (size_t i = 0; i < order.size(); ++i) {
    newMesh[order[i]] = int(i);
    meshes.push_back(std::move(sketch.meshes[order[i]]));
  }
  sketch.meshes = std::move(meshes);

  std::vector<int> newNode(sketch.nodes.size(), -1);
  std::vector<SketchNode> nodes;
  while (nodes.size() < sketch.nodes.size()) {
    for (const size_t i : shuffledIndices(sketch.nodes.size(), dice)) {
      SketchNode node = sketch.nodes[i];
      if (newNode[i] >= 0 || (node.parent >= 0 && newNode[size_t(node.parent)] < 0)) continue;
      if (node.parent >= 0) node.parent = newNode[size_t(node.parent)];
      if (node.mesh >= 0) node.mesh = newMesh[size_t(node.mesh)];
      newNode[i] = int(nodes.size());
      nodes.push_back(node);
    }
  }
  sketch.nodes = std::move(nodes);
  return sketch;
}

SketchMesh inWorld(const SketchMesh& mesh, const glm::dmat4& world) {
  SketchMesh baked = mesh;
  const glm::dmat3 linear(world);
  for (glm::vec3& p : baked.positions) p = glm::vec3(linear * glm::dvec3(p) + glm::dvec3(world[3]));
  const glm::dmat3 normals = glm::inverseTranspose(linear);
  for (glm::vec3& n : baked.normals) n = glm::vec3(glm::normalize(normals * glm::dvec3(n)));
  const bool mirrored = glm::determinant(linear) < 0.0;
  for (glm::vec4& t : baked.tangents)
    t = glm::vec4(glm::normalize(linear * glm::dvec3(t)), mirrored ? -t.w : t.w);
  if (mirrored) {
    for (glm::uvec3& t : baked.triangles) std::swap(t.y, t.z);
  }
  return baked;
}

SceneSketch flattened(const SceneSketch& sketch) {
  SceneSketch flat = sketch;
  flat.meshes.clear();
  flat.nodes.clear();
  std::vector<glm::dmat4> world;
  for (const SketchNode& node : sketch.nodes) {
    world.push_back(node.parent >= 0 ? world[size_t(node.parent)] * node.local : node.local);
    if (node.radius > 0.0) flat.nodes.push_back({world.back(), -1, -1, node.radius, node.sphereMaterial});
    if (node.mesh < 0) continue;
    flat.nodes.push_back({glm::dmat4(1.0), -1, int(flat.meshes.size())});
    flat.meshes.push_back(inWorld(sketch.meshes[size_t(node.mesh)], world.back()));
  }
  return flat;
}

SceneSketch shared(const SceneSketch& sketch) {
  SceneSketch other = sketch;
  other.instancing = Instancing::Share;
  return other;
}

/// Part k of a mesh: every count-th triangle; all parts keep all vertices.
SketchMesh partOf(const SketchMesh& mesh, size_t k, size_t count) {
  SketchMesh part = mesh;
  part.triangles.clear();
  for (size_t i = k; i < mesh.triangles.size(); i += count) part.triangles.push_back(mesh.triangles[i]);
  return part;
}

SceneSketch split(const SceneSketch& sketch, Dice& dice) {
  SceneSketch parted = sketch;
  parted.meshes.clear();
  std::vector<std::vector<int>> partsOf;
  for (const SketchMesh& mesh : sketch.meshes) {
    const size_t count = std::min(mesh.triangles.size(), 2 + dice.below(3));
    partsOf.emplace_back();
    for (size_t k = 0; k < count; ++k) {
      partsOf.back().push_back(int(parted.meshes.size()));
      parted.meshes.push_back(partOf(mesh, k, count));
    }
  }
  // The first part stays with the node, the others stand below it.
  const size_t nodes = sketch.nodes.size();
  for (size_t i = 0; i < nodes; ++i) {
    if (sketch.nodes[i].mesh < 0) continue;
    const std::vector<int>& parts = partsOf[size_t(sketch.nodes[i].mesh)];
    parted.nodes[i].mesh = parts.front();
    for (size_t k = 1; k < parts.size(); ++k) parted.nodes.push_back({glm::dmat4(1.0), int(i), parts[k]});
  }
  return parted;
}

}  // namespace

SceneSketch inForm(const SceneSketch& sketch, Form form, uint32_t seed) {
  Dice dice(seed * 2654435761u + uint32_t(form) + 1u);
  switch (form) {
    case Form::Scaled:
      return scaled(sketch, std::pow(10.0, dice.between(-6.0, 6.0)));
    case Form::Moved: {
      SceneSketch moved = sketch;
      const glm::dvec3 by = kSize * std::pow(10.0, dice.between(0.0, 6.0)) * dice.direction();
      moved.root = glm::translate(glm::dmat4(1.0), by) * sketch.root;
      return moved;
    }
    case Form::Turned: {
      SceneSketch turned = sketch;
      const double angle = dice.between(0.0, glm::two_pi<double>());
      const glm::dvec3 axis = sketch.sky.width > 0 ? glm::dvec3(0, 1, 0) : dice.direction();
      turned.root = glm::rotate(glm::dmat4(1.0), angle, axis) * sketch.root;
      turned.skyTurn += angle;
      return turned;
    }
    case Form::Reordered:
      return reordered(sketch, dice);
    case Form::Flattened:
      return flattened(sketch);
    case Form::Split:
      return split(sketch, dice);
    case Form::Shared:
      return shared(sketch);
  }
  return sketch;
}

}  // namespace fragtrace
