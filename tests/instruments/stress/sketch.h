// SPDX-License-Identifier: MIT
// A small scene as its author would have it, and as a glTF file: what property tests turn into equivalent
// forms.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

#include "image/image.h"
#include "scene/scene.h"

namespace fragtrace {

/// A square picture, rows from the top.
struct SketchTexture {
  int side = 4;
  std::vector<glm::u8vec3> texels;
  int wrap = 10497;  ///< glTF's number, in both directions
};

struct SketchMaterial {
  glm::dvec3 color{0.8};
  double alpha = 1.0;  ///< below 1: blended
  double metallic = 0.0;
  double roughness = 0.5;
  bool doubleSided = false;
  glm::dvec3 emission{0.0};
  double transmission = 0.0;
  double thickness = 0.0;            ///< metres
  double attenuationDistance = 0.0;  ///< metres; 0: none
  int colorTexture = -1;
  int normalTexture = -1;
  glm::dvec2 textureScale{1.0};  ///< scale of KHR_texture_transform for the colour
  double textureTurn = 0.0;      ///< the same, radians
};

struct SketchMesh {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< none: flat
  std::vector<glm::vec4> tangents;
  std::vector<glm::vec2> texcoords;
  std::vector<glm::uvec3> triangles;
  size_t material = 0;
};

/// Nodes stand behind their parents; those without one are children of the sketch's root.
struct SketchNode {
  glm::dmat4 local{1.0};
  int parent = -1;
  int mesh = -1;
  double radius = 0.0;  ///< above 0: shows a sphere instead of a mesh; scaled evenly
  size_t sphereMaterial = 0;
};

struct SketchLight {
  glm::dvec3 position{0.0};
  double intensity = 1.0;
};

struct SceneSketch {
  std::vector<SketchTexture> textures;
  std::vector<SketchMaterial> materials;
  std::vector<SketchMesh> meshes;
  std::vector<SketchNode> nodes;
  std::vector<SketchLight> lights;
  glm::dmat4 camera{1.0};
  double fovY = 0.7;     ///< radians
  glm::dmat4 root{1.0};  ///< transform of nodes, lights and the camera
  Image sky;             ///< the environment map; 0 x 0: none
  double skyTurn = 0.0;  ///< radians about +y
  Instancing instancing = Instancing::Flatten;
};

/// The matrix of a camera at a point that looks at another, +y up.
glm::dmat4 lookingFrom(const glm::dvec3& from, const glm::dvec3& at);

/// Writes sketch.gltf, sketch.bin and a .png for each texture into a folder; the sky has no place in them.
/// Throws RenderError.
void writeSketch(const SceneSketch& sketch, const std::filesystem::path& folder);

}  // namespace fragtrace
