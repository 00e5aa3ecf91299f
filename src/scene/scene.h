// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/vectors.h"
#include "scene/local_space.h"
#include "scene/solids.h"
#include "scene/volume/grid.h"

namespace fragtrace {

// Fog in a ball round the scene (shaders/media/fog.glsl).

/// World space. The extinction is that at `base` and below; above, it falls by e every `height` metres.
struct Fog {
  double extinction = 0.0;                                  ///< 1/m
  glm::vec3 albedo{1.0f};                                   ///< albedo of one scattering
  float anisotropy = 0.0f;                                  ///< mean cosine of a scattering; above 0 forward
  double height = std::numeric_limits<double>::infinity();  ///< metres
  double base = 0.0;                                        ///< Y, metres
  glm::dvec3 center{0.0};                                   ///< middle of the ball
  double radius = 0.0;                                      ///< metres

  bool operator==(const Fog&) const = default;
};

/// The motion of a scene while the shutter is open. Surfaces move in straight pieces of equal time, the
/// segments: there is a pose where each begins and where the last one ends. Vertices and spheres of a scene
/// hold one pose after the other. Triangles and the tree hold one segment after the other, and refer to the
/// pose in which their segment begins (scene/motion/moving_scene.h, bvh/scene_tree.h).
struct ShutterMotion {
  uint32_t segments = 0;   ///< 0: surfaces stand still, and there is one pose
  uint32_t vertices = 0;   ///< number of vertices of one pose
  uint32_t triangles = 0;  ///< number of triangles of one segment
  uint32_t spheres = 0;    ///< number of spheres of one pose
  bool camera = false;     ///< the camera moves
};

// The scene as plain structs joined by indices. Units are metres and radians, colours linear Rec.709. World
// space is y up; shaders see "local" space (LocalSpace).

/// The one value that means "no such index".
inline constexpr uint32_t kMissIndex = 0xffffffffu;

/// An encoded picture (PNG, JPEG, ...) as it was in the file, a buffer view or a data URI. It is decoded when
/// it is packed.
struct EncodedImage {
  std::string name;  ///< a file path, or the place
  std::vector<uint8_t> bytes;
  int width = 0;  ///< the decoded picture is scaled down to this
  int height = 0;
  int texelBits = 8;    ///< bits of a channel on the device: 8 or 16
  std::string place{};  ///< "scene.gltf: /images/0"
};

/// The picture's name for messages: the file, if it has one of its own, and the place.
inline std::string nameOf(const EncodedImage& image) {
  const bool isFile = image.name != image.place && !image.place.empty();
  return isFile ? image.name + " (" + image.place + ")" : image.name;
}

/// The bytes of a picture on the device.
inline size_t texelBytes(const EncodedImage& image) {
  return size_t(image.width) * size_t(image.height) * 4 * size_t(image.texelBits / 8);
}

enum class Wrap : uint8_t { Repeat, ClampToEdge, MirroredRepeat };

/// A glTF texture with its sampler: rays read level 0 with the magnification filter.
struct Texture {
  uint32_t image = kMissIndex;
  Wrap wrapU = Wrap::Repeat;
  Wrap wrapV = Wrap::Repeat;
  bool linear = true;  ///< magnification filter: linear, else nearest
};

/// The transform of texture coordinates: the first two rows of a matrix that multiplies (u, v, 1)
/// (KHR_texture_transform).
struct TextureTransform {
  glm::vec3 u{1.0f, 0.0f, 0.0f};
  glm::vec3 v{0.0f, 1.0f, 0.0f};

  glm::vec2 of(const glm::vec2& texcoord) const {
    const glm::vec3 place(texcoord, 1.0f);
    return {glm::dot(u, place), glm::dot(v, place)};
  }
  bool operator==(const TextureTransform&) const = default;
};

/// A material's use of a texture; texture == kMissIndex means the factor alone.
struct TextureRef {
  uint32_t texture = kMissIndex;
  uint32_t texcoord = 0;  ///< 0 or 1: place among Material::texcoordSets
  TextureTransform transform{};
  bool lost = false;  ///< its picture could not be read: there is no texture
  bool present() const { return texture != kMissIndex; }
  bool transformed() const { return present() && transform != TextureTransform{}; }
};

enum class AlphaMode : uint8_t { Opaque, Mask, Blend };

/// A procedural smooth Perlin normal map over TEXCOORD_0 (material extras "perlinNormal"); amplitude 0 is
/// none.
struct PerlinNormal {
  float frequency = 8.0f;  ///< lattice cells per texture coordinate unit
  float amplitude = 0.0f;  ///< slope of the height field, dimensionless
  int octaves = 1;
};

/// An index that reflects everything: the reflectance at normal incidence is within 4e-6 of 1.
inline constexpr float kInfiniteIor = 1e6f;

/// Material of glTF 2.0 with the extensions of docs/design/surfaces.md; defaults are the specification's.
struct Material {
  std::string name;
  uint32_t number = 0;                    ///< number of the glTF material, from 1; the default one comes last
  std::string place{};                    ///< JSON pointer; empty: the default one
  std::vector<std::string> extensions{};  ///< extensions that the file gives the material
  std::array<uint32_t, 2> texcoordSets{0, 1};  ///< n of the TEXCOORD_n that its textures have
  glm::vec4 baseColorFactor{1.0f};
  float metallicFactor = 1.0f;
  float roughnessFactor = 1.0f;
  glm::vec3 emissiveFactor{0.0f};
  float emissiveStrength = 1.0f;  ///< radiance = emissiveFactor * emissiveStrength (* texture)
  float normalScale = 1.0f;
  float occlusionStrength = 1.0f;
  AlphaMode alphaMode = AlphaMode::Opaque;
  float alphaCutoff = 0.5f;
  float leastAlpha = 1.0f;  ///< a bound of the alpha of its texture and vertices (settleLeastAlpha)
  bool doubleSided = false;
  bool unlit = false;
  /// The material is of KHR_materials_pbrSpecularGlossiness: the diffuse colour gives way to the specular
  /// one, and specularColorTexture holds the glossiness (1 - roughness) in its alpha.
  bool specularGlossiness = false;
  float ior = 1.5f;  ///< kInfiniteIor: a Fresnel factor of 1 (KHR_materials_ior's 0)
  float transmissionFactor = 0.0f;
  float thicknessFactor = 0.0f;  ///< 0: thin-walled, above: the mesh bounds a solid
  glm::vec3 attenuationColor{1.0f};
  float attenuationDistance = std::numeric_limits<float>::infinity();
  float specularFactor = 1.0f;
  glm::vec3 specularColorFactor{1.0f};
  float clearcoatFactor = 0.0f;
  float clearcoatRoughnessFactor = 0.0f;
  float clearcoatNormalScale = 1.0f;
  glm::vec3 sheenColorFactor{0.0f};
  float sheenRoughnessFactor = 0.0f;
  float anisotropyStrength = 0.0f;
  float anisotropyRotation = 0.0f;  ///< radians, from the tangent towards the bitangent
  float iridescenceFactor = 0.0f;
  float iridescenceIor = 1.3f;
  float iridescenceThicknessMinimum = 100.0f;  ///< nm; where the texture is 0
  float iridescenceThicknessMaximum = 400.0f;  ///< nm; where it is 1, or without one
  float diffuseTransmissionFactor = 0.0f;
  glm::vec3 diffuseTransmissionColorFactor{1.0f};
  float dispersion = 0.0f;  ///< 20 over the Abbe number
  /// KHR_materials_scatter. A solid scatters inside; a thin wall scatters the light that comes through.
  float scatterStrength = 0.0f;
  glm::vec3 multiscatterColor{1.0f};  ///< albedo of a thick layer, all scatterings counted
  float scatterAnisotropy = 0.0f;     ///< mean cosine of a scattering; above 0 forward
  bool scatterOfDraft = false;  ///< the draft KHR_materials_volume_scatter, whose albedo ignores anisotropy
  PerlinNormal perlinNormal;
  TextureRef baseColorTexture;
  TextureRef metallicRoughnessTexture;
  TextureRef normalTexture;
  TextureRef emissiveTexture;
  TextureRef occlusionTexture;
  TextureRef transmissionTexture;
  TextureRef specularTexture;
  TextureRef specularColorTexture;
  TextureRef clearcoatTexture;
  TextureRef clearcoatRoughnessTexture;
  TextureRef clearcoatNormalTexture;
  TextureRef sheenColorTexture;
  TextureRef sheenRoughnessTexture;
  TextureRef anisotropyTexture;
  TextureRef iridescenceTexture;
  TextureRef iridescenceThicknessTexture;
  TextureRef diffuseTransmissionTexture;
  TextureRef diffuseTransmissionColorTexture;
  TextureRef scatterStrengthTexture;
  TextureRef multiscatterColorTexture;

  bool transmissive() const { return transmissionFactor > 0.0f; }
  /// Light of any kind passes through, so rays see the back.
  bool passesLight() const { return transmissive() || diffuseTransmissionFactor > 0.0f; }
  /// Returns true if the surface, judged by its roughness factor without the texture, is so smooth that it
  /// scatters light in single directions (kMirrorAlpha of shaders/bsdf.glsl).
  bool mirrorLike() const { return roughnessFactor * roughnessFactor < 0.001f; }
  /// Returns true if alpha may let a ray pass.
  bool testsAlpha() const {
    const float least = baseColorFactor.a * leastAlpha;
    return alphaMode == AlphaMode::Blend ? least < 1.0f : alphaMode == AlphaMode::Mask && least < alphaCutoff;
  }
  /// No ray sees the back.
  bool culled() const { return !doubleSided && !passesLight(); }
  bool clearcoated() const { return clearcoatFactor > 0.0f; }
  bool hasSheen() const { return sheenColorFactor != glm::vec3(0.0f); }
  /// Returns true if clearcoat or sheen lies over the base.
  bool layered() const { return clearcoated() || hasSheen(); }
  bool anisotropic() const { return anisotropyStrength > 0.0f; }
  bool iridescent() const { return iridescenceFactor > 0.0f; }
  bool scalesSpecular() const {
    return specularFactor != 1.0f || specularColorFactor != glm::vec3(1.0f) || specularTexture.present() ||
           specularColorTexture.present();
  }
  bool solid() const { return thicknessFactor > 0.0f; }
  /// Light on its way through the solid is lost, at least in one channel.
  bool attenuates() const {
    return passesLight() && solid() && attenuationColor != glm::vec3(1.0f) &&
           std::isfinite(attenuationDistance);
  }
  bool scattersAtAll() const { return scatterStrength > 0.0f && multiscatterColor != glm::vec3(0.0f); }
  bool scattersInside() const { return attenuates() && scattersAtAll(); }
  /// Returns true if also the boundary does not bend light (kEqualIndices of shaders/bsdf.glsl).
  bool scattersMatched() const { return scattersInside() && transmissive() && std::abs(ior - 1.0f) < 0.001f; }
  /// A thin wall whose light comes through diffusely, at least a part of it.
  bool scattersThinly() const { return transmissive() && !solid() && scatterStrength > 0.0f; }
  bool passesDiffusely() const { return diffuseTransmissionFactor > 0.0f || scattersThinly(); }
  bool disperses() const { return transmissive() && thicknessFactor > 0.0f && dispersion > 0.0f; }
  bool emissive() const {
    return !unlit && emissiveStrength > 0.0f &&
           (emissiveFactor.x > 0 || emissiveFactor.y > 0 || emissiveFactor.z > 0);
  }
};

/// The encoding of a texture's colour channels.
enum class TransferCurve : uint8_t { Linear, Srgb };

struct TextureRefRow {
  TextureRef Material::*ref;
  TransferCurve curve;
  const char* name;
  bool (Material::*effect)() const = nullptr;  ///< materials without it do not show the texture
  bool tangentSpace = false;                   ///< its texels are normals
};

/// All textures of a material; those that are drawn, in the order of their slots (shaders/layout.glsl).
inline constexpr std::array kTextureRefs = std::to_array<TextureRefRow>({
    {&Material::baseColorTexture, TransferCurve::Srgb, "base colour"},  // colour and alpha
    {&Material::metallicRoughnessTexture, TransferCurve::Linear,        // G roughness, B metallic
     "metal and roughness"},
    {&Material::normalTexture, TransferCurve::Linear, "normals", nullptr, true},
    {&Material::emissiveTexture, TransferCurve::Srgb, "emission", &Material::emissive},
    {&Material::transmissionTexture, TransferCurve::Linear, "transmission", &Material::transmissive},  // R
    {&Material::specularTexture, TransferCurve::Linear, "specular"},                                   // A
    {&Material::specularColorTexture, TransferCurve::Srgb, "specular colour"},
    {&Material::clearcoatTexture, TransferCurve::Linear, "clearcoat", &Material::clearcoated},  // R
    {&Material::clearcoatRoughnessTexture, TransferCurve::Linear,                               // G
     "clearcoat roughness", &Material::clearcoated},
    {&Material::clearcoatNormalTexture, TransferCurve::Linear, "clearcoat normals", &Material::clearcoated,
     true},
    {&Material::sheenColorTexture, TransferCurve::Srgb, "sheen", &Material::hasSheen},
    {&Material::sheenRoughnessTexture, TransferCurve::Linear, "sheen roughness", &Material::hasSheen},  // A
    {&Material::anisotropyTexture, TransferCurve::Linear,  // RG direction, B strength
     "anisotropy", &Material::anisotropic},
    {&Material::iridescenceTexture, TransferCurve::Linear, "iridescence", &Material::iridescent},  // R
    {&Material::iridescenceThicknessTexture, TransferCurve::Linear,                                // G
     "iridescence thickness", &Material::iridescent},
    {&Material::diffuseTransmissionTexture, TransferCurve::Linear,  // A
     "diffuse transmission", &Material::passesDiffusely},
    {&Material::diffuseTransmissionColorTexture, TransferCurve::Srgb, "diffuse transmission colour",
     &Material::passesDiffusely},
    {&Material::scatterStrengthTexture, TransferCurve::Linear, "scattering", &Material::scattersThinly},  // A
    {&Material::multiscatterColorTexture, TransferCurve::Srgb, "scattering colour",
     &Material::scattersThinly},
    {&Material::occlusionTexture, TransferCurve::Linear, "occlusion"},  // R; not traced
});

/// Settles a material whose textures are lost (TextureRef::lost): it is magenta where colours are, and matt
/// where it is unknown what is metal. Effects that a lost texture would have bounded are left out.
inline void settleLostTextures(Material& m) {
  constexpr glm::vec3 kMagenta{1.0f, 0.0f, 1.0f};
  const auto settle = [](const TextureRef& texture, auto& factor, const auto& value) {
    if (texture.lost) factor = value;
  };
  settle(m.baseColorTexture, m.baseColorFactor, glm::vec4(kMagenta, m.baseColorFactor.a));
  settle(m.metallicRoughnessTexture, m.metallicFactor, 0.0f);
  settle(m.emissiveTexture, m.emissiveFactor, glm::vec3(0.0f));
  settle(m.transmissionTexture, m.transmissionFactor, 0.0f);
  settle(m.clearcoatTexture, m.clearcoatFactor, 0.0f);
  settle(m.sheenColorTexture, m.sheenColorFactor, glm::vec3(0.0f));
  settle(m.anisotropyTexture, m.anisotropyStrength, 0.0f);
  settle(m.iridescenceTexture, m.iridescenceFactor, 0.0f);
  settle(m.diffuseTransmissionTexture, m.diffuseTransmissionFactor, 0.0f);
  settle(m.diffuseTransmissionColorTexture, m.diffuseTransmissionColorFactor, kMagenta);
  settle(m.scatterStrengthTexture, m.scatterStrength, 0.0f);
  settle(m.multiscatterColorTexture, m.multiscatterColor, kMagenta);
  if (!m.specularGlossiness) return;
  settle(m.specularColorTexture, m.specularColorFactor, glm::vec3(0.04f));  // a dielectric's
  settle(m.specularColorTexture, m.roughnessFactor, 1.0f);                  // its glossiness is lost, too
}

/// Three vertex indices, counter-clockwise seen from the front, and the material.
struct Triangle {
  glm::uvec3 vertex;
  uint32_t material = 0;
  bool flat = false;  ///< no vertex normals were given: the geometric normal shades
  /// Exponent, as in the bits of a float, of the reach of coincidence (scene/coincidence.h); 0: it has none.
  uint8_t reach = 0;
};

/// A KHR_implicit_shapes sphere, placed by a node; rotation turns its texture coordinates.
struct Sphere {
  glm::vec3 center;     ///< local space
  float radius = 1.0f;  ///< local space
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
  uint32_t material = 0;
  std::string node{};      ///< as in PrimitiveOrigin
  uint32_t nodeIndex = 0;  ///< as in PrimitiveOrigin
};

enum class LightType : uint8_t { Point, Spot, Directional };

/// A punctual light; intensity is taken as radiometric, after Scene::lampScale.
struct Light {
  LightType type = LightType::Point;
  glm::vec3 intensity{1.0f};  ///< irradiance on a facing surface 1 away in local space; directional: anywhere
  glm::vec3 position{0.0f};   ///< local space
  glm::vec3 direction{0, 0, -1};                         ///< unit, the way the light shines
  float range = std::numeric_limits<float>::infinity();  ///< local space
  float innerConeAngle = 0.0f;
  float outerConeAngle = 0.7853981634f;
  uint32_t source = 0;  ///< index into Scene::lightSources
  std::string node{};   ///< the name of the node that places it, or else its JSON pointer
  std::string place{};  ///< that pointer
};

/// A punctual light as the file describes it; nodes place it.
struct LightSource {
  std::string name;
  LightType type = LightType::Point;
  glm::dvec3 color{1.0};
  double intensity = 1.0;  ///< intensity in the file's units
  bool added = false;      ///< by the user, so that its units are known
};

/// The largest radiance of a surface and intensity of a light that a file can ask for: sums of them over
/// samples stay numbers.
inline constexpr float kBrightest = 1e20f;

/// Light::intensity of such a light, with Scene::lampScale.
inline glm::vec3 intensityOf(const LightSource& source, const LocalSpace& space, double lampScale = 1.0) {
  const double scale = source.type == LightType::Directional ? 1.0 : 1.0 / (space.unit * space.unit);
  return glm::vec3(source.color * (source.intensity * (source.added ? 1.0 : lampScale)) * scale);
}

/// The two kinds that glTF has, then an equirectangular panorama and an equidistant fisheye.
enum class CameraType : uint8_t { Perspective, Orthographic, Panorama, Fisheye };
inline constexpr std::array<std::string_view, 4> kCameraTypeNames{"perspective", "orthographic", "panorama",
                                                                  "fisheye"};

/// Returns true if straight lines are straight in the picture.
constexpr bool isRectilinear(CameraType type) { return type <= CameraType::Orthographic; }

/// A camera in world space, in double precision, so that it loses no digits before recentring.
struct Camera {
  std::string name;
  CameraType type = CameraType::Perspective;
  glm::dvec3 position{0.0};
  glm::dvec3 forward{0.0, 0.0, -1.0};  ///< unit
  glm::dvec3 up{0.0, 1.0, 0.0};        ///< unit, orthogonal to forward
  double fovY = 0.7853981633974483;  ///< view angle, radians: vertical (perspective), of the circle (fisheye)
  double halfHeight = 1.0;           ///< half of the vertical extent, metres (orthographic)
  glm::dvec2 shift{0.0};             ///< shift of the lens to the right and up, in parts of width and height
  double aspectRatio = 0.0;          ///< width / height; 0: not given
};

/// Meshes that appear several times are copied or shared; Auto shares them where that saves much memory.
enum class Instancing : uint8_t { Auto, Flatten, Share };
inline constexpr std::array<std::string_view, 3> kInstancingNames{"auto", "flatten", "share"};

/// Triangles that instances show, in a space of their own: recentred, with coordinates of at most 1.
struct SharedMesh {
  uint32_t firstTriangle = 0;
  uint32_t triangleCount = 0;
};

/// A shared mesh as a node places it.
struct Instance {
  glm::dmat4 toLocal{1.0};  ///< maps the mesh's space into local space; affine, invertible
  uint32_t mesh = 0;        ///< index into Scene::sharedMeshes
  std::string node{};       ///< as in PrimitiveOrigin
  uint32_t nodeIndex = 0;   ///< as in PrimitiveOrigin
};

/// The origin of triangles in the file: one entry for each (node, mesh primitive), in order of firstTriangle.
/// Triangles of shared meshes have no node.
struct PrimitiveOrigin {
  std::string node;
  std::string mesh;
  uint32_t firstTriangle = 0;
  uint32_t triangleCount = 0;
  uint32_t nodeIndex = 0;  ///< the node's place in the file
};

/// Points and lines of a mesh primitive, as a node places it; triangles replace them (scene/strokes.h).
struct Strokes {
  std::string node{};      ///< as in PrimitiveOrigin
  std::string mesh{};      ///< as in PrimitiveOrigin
  uint32_t nodeIndex = 0;  ///< as in PrimitiveOrigin
  uint32_t material = 0;
  bool lit = false;              ///< normals were given
  std::vector<glm::uvec2> ends;  ///< vertices; twice the same: a point
};

/// A node of the scene that is shown.
struct SceneNode {
  std::string name;           ///< its name, or else its JSON pointer
  uint32_t index = 0;         ///< its place in the file
  int depth = 0;              ///< ancestors
  bool hidden = false;        ///< the node or an ancestor is hidden, by the file or by the user
  bool hiddenInFile = false;  ///< hidden by the file alone
  bool mesh = false;          ///< true for a mesh, false for a sphere
  bool light = false;
  bool camera = false;
};

/// Vertex attributes, one entry a vertex; an array other than position is empty when no primitive needs it.
struct Vertices {
  std::vector<glm::vec3> position;  ///< local space
  std::vector<glm::vec3> normal;    ///< unit; (0,0,0) where a primitive has none
  std::vector<glm::vec4>
      tangent;  ///< xyz unit, w handedness (+1/-1); only where a normal map or anisotropy needs them
  std::vector<glm::vec2> texcoord0;
  std::vector<glm::vec2> texcoord1;
  std::vector<glm::vec4> color;  ///< linear, multiplies base colour; (1,1,1,1) where a primitive has none
};

/// What a file says of its making, and the files of its buffers.
struct Making {
  std::string generator{};
  std::string copyright{};
  std::vector<std::filesystem::path> buffers{};
};

/// Everything the renderer knows of a glTF file. Primitive indices count triangles first, then spheres.
struct Scene {
  LocalSpace space;
  Vertices vertices;
  std::vector<Triangle> triangles;
  std::vector<uint32_t> insets;  ///< one per triangle, or none (creaseInsets of creases.h)
  std::vector<Sphere> spheres;
  std::vector<Strokes> strokes;
  uint32_t strokeTriangles = 0;  ///< triangles that addStrokes() made of them: the last ones, in local space
  std::vector<Material> materials;  ///< never empty: the default material is appended when something needs it
  std::vector<Texture> textures;
  std::vector<EncodedImage> images;
  std::vector<Light> lights;
  std::vector<LightSource> lightSources;  ///< all of the file
  double lampScale = 1.0;                 ///< by which the file's intensities are multiplied (--lamp-units)
  std::vector<Camera> cameras;            ///< cameras in the order in which nodes are visited; world space
  std::vector<PrimitiveOrigin> origins;
  std::vector<SceneNode> nodes;          ///< a parent stands before its children
  std::vector<SharedMesh> sharedMeshes;  ///< their triangles and vertices stand behind all others
  std::vector<Instance> instances;
  std::string sharing;  ///< why meshes are shared or are not, in a few words
  std::vector<std::string> extensionsUsed;
  bool refersToFiles = false;  ///< its file does: to buffers or pictures
  Making made;
  std::vector<std::string> sceneNames;  ///< all that SceneSelection may name; "" for one without a name
  std::vector<std::string> animationNames;
  std::vector<std::optional<double>> animationSeconds;  ///< time of the last key; none: it is not said
  std::vector<std::string> materialVariants;
  std::vector<std::string> warnings;  ///< one line each, for stderr; names the file and the place
  Volume volume;                      ///< its grid is read after the scene's file
  BoundsDouble bounds;                ///< world space
  ShutterMotion motion;
  Solids solids;
};

/// A triangle's vertices, in local space or that of its shared mesh.
template <typename Vector = glm::vec3>
std::array<Vector, 3> cornersOf(const Scene& scene, const Triangle& t) {
  const std::vector<glm::vec3>& p = scene.vertices.position;
  return {Vector(p[t.vertex.x]), Vector(p[t.vertex.y]), Vector(p[t.vertex.z])};
}

/// Triangles in local space: all that no instance shows.
inline uint32_t flatTriangleCount(const Scene& scene) {
  return scene.sharedMeshes.empty() ? uint32_t(scene.triangles.size()) : scene.sharedMeshes[0].firstTriangle;
}

}  // namespace fragtrace
