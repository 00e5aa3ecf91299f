// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "bvh/bvh.h"
#include "image/image.h"
#include "pack/textures/texture_plan.h"
#include "scene/scene.h"
#include "scene/sky/map_filter.h"
#include "scene/sky/sky.h"
#include "scene/volume/grid.h"
#include "shader/layout.h"
#include "shader/variant.h"

namespace fragtrace {

// The scene as the arrays the shader reads (shaders/layout.glsl), in upload order; no OpenGL here.

using Words = std::vector<uint32_t>;

/// The surroundings of the scene: their kind and, unless there are none, an equirectangular picture with R,
/// G, B.
struct Environment {
  Surroundings kind = Surroundings::None;
  Image image;
  Image backdrop{};  ///< equirectangular, seen by camera rays instead of the image; empty: there is none
  std::optional<SunDisc> sun{};    ///< stands before the image
  std::optional<MapSun> mapSun{};  ///< is a part of the image
};

/// The picture, with the light of the sun in the texels where it stands: that is made in `memory`.
inline const Image& wholeMap(const Environment& environment, Image& memory) {
  if (!environment.sun) return environment.image;
  memory = withDisc(environment.image, *environment.sun);
  return memory;
}

/// The features of the scene in these surroundings.
TraitSet traitsOf(const Scene& scene, const Environment& environment);

/// The powers between which light samples in gi choose, in one unit.
struct LightShare {
  bool samplesEnvironment = false;
  double environment = 0.0;  ///< power at an intensity of 1
  double emitters = 0.0;
  bool anyEmitters = false;
  double sun = 0.0;  ///< the sun's part of the environment's
};

/// The probability that a light sample goes to the environment, whose radiance is multiplied by `intensity`.
float environmentChance(const LightShare& share, double intensity);

/// The probability that a light path begins at the sun.
float sunChance(const LightShare& share, double intensity);

/// A grid of densities in its array.
struct PackedGrid {
  glm::dmat4 fromFile{1.0};  ///< maps the file's space to bricks of the table
  glm::ivec3 bricks{0};      ///< size of the table
  double largest = 0.0;      ///< density
  double brightest = 0.0;    ///< radiance
};

struct GpuScene {
  std::array<Words, layout::kSceneBufferCount>
      buffers;             ///< buffers by binding; empty if the variant never reads one
  glm::vec3 extent{1.0f};  ///< sceneExtent()
  uint32_t leafCount = 0;
  std::vector<bool> cutOut{};       ///< triangles that the tree does without (cutOutTriangles)
  glm::ivec4 segments{1, 0, 0, 0};  ///< layout::Frame::segments
  glm::ivec2 environmentSize{0};
  glm::ivec2 backdropSize{0};
  LightShare lightShare;
  uint32_t emitterCount = 0;
  uint32_t punctualLights = 0;
  std::vector<glm::vec4> casters{};  ///< balls that cast caustics: middle and radius in local space
  bool wideLamps = false;            ///< areLampsWide(), and light paths begin at no sun
  PackedGrid densities{};
  uint32_t energyTableRow = 0;  ///< first row of the energy table among the material rows
  uint32_t objectRow = 0;       ///< row of the numbers of objects
  glm::vec3 upwardIrradiance{
      0.0f};  ///< irradiance by the environment of a plane that faces up, for shadow catchers
  /// The arrays that are the same as packed before: these are empty here.
  std::array<bool, layout::kSceneBufferCount> unchanged{};
  TexturePlan textures{};
  std::vector<PackedPicture> pictures{};      ///< of the plan; none where they are as packed before
  std::vector<std::string> brokenPictures{};  ///< why pictures cannot be decoded, a line for each

  size_t bytes() const;
  /// The part of these that the primitives take: tree, leaves, faces and vertex attributes.
  size_t geometryBytes() const;
};

struct KeptArrays;

/// Packs the arrays that the variant reads, with the pictures of a plan that holds all of them. The tree may
/// be a plain list of leaves without nodes (iterative traversal). Textures that cannot be decoded are lost
/// (settleLostTextures()); throws InputError where none can be. Pictures in `kept` by the same plan are not
/// packed again; those that are packed are added to it.
GpuScene packScene(const Scene& scene, const Bvh& bvh, const Environment& environment,
                   const ShaderVariant& variant, const TexturePlan& plan, KeptArrays* kept = nullptr,
                   const DecodeProgress& progress = {}, const TexelMemory& memory = {});
/// Packs pictures in endless room.
GpuScene packScene(const Scene& scene, const Bvh& bvh, const Environment& environment,
                   const ShaderVariant& variant);

/// Packs the surroundings alone, for a scene that is there: all other arrays are unchanged.
GpuScene packSurroundings(const Bvh& bvh, const Environment& environment, const ShaderVariant& variant,
                          KeptArrays& kept);

// The pictures of textures and environment, which stay on the device and need not be packed again for the
// next picture of a sequence.

struct KeptArrays {
  std::vector<std::pair<std::string, size_t>> images;  ///< names and sizes of the images packed
  TexturePlan textures;
  std::vector<PictureFacts> pictures;  ///< by the index of the scene's image; empty: none was packed
  const VolumeGrid* grid = nullptr;    ///< grid behind the arrays; it is only compared
  PackedGrid densities;
  struct KeptEnvironment {
    glm::ivec2 size{0};
    glm::ivec2 backdropSize{0};
    glm::vec3 upwardIrradiance{0.0f};
    double power = 0.0;
    int draws = 0;            ///< EnvironmentDraws
    bool forCatcher = false;  ///< upwardIrradiance is known
    bool light = false;       ///< appendEnvironmentLight()
    bool suns = false;        ///< appendSuns()
    double sunPower = 0.0;    ///< the part of the power of the sun that light paths begin at
  };
  std::optional<KeptEnvironment> environment;  ///< the environment map; a sequence has only one
  bool geometry = false;     ///< tree, leaves, faces and vertices are as packed before, as are all pictures
  std::vector<bool> cutOut;  ///< the triangles that the tree was packed without (cutOutTriangles)
};

/// Texels of 8 bytes that a grid takes on the device.
size_t texelsOf(const VolumeGrid& grid);

/// Fills an array with the grid's table, which is larger by a brick before the first along each axis, and its
/// bricks (shaders/media/volume.glsl).
PackedGrid packGrid(const VolumeGrid& grid, Words& texels);

}  // namespace fragtrace
