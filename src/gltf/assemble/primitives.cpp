// SPDX-License-Identifier: MIT
#include "gltf/assemble/primitives.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <glm/gtx/norm.hpp>

#include "base/vectors.h"
#include "gltf/read/accessor.h"
#include "scene/tangents.h"

namespace fragtrace {

namespace {

enum class Topology { List, Strip, Fan };

/// The topology of a glTF primitive mode that has triangles.
std::optional<Topology> topologyOf(int mode) {
  switch (mode) {
    case TINYGLTF_MODE_TRIANGLES:
      return Topology::List;
    case TINYGLTF_MODE_TRIANGLE_STRIP:
      return Topology::Strip;
    case TINYGLTF_MODE_TRIANGLE_FAN:
      return Topology::Fan;
    default:
      return std::nullopt;
  }
}

/// Pairs of line ends, or each point twice, of the other modes; what is left over of a list, or too short for
/// a line, is dropped.
std::vector<glm::uvec2> strokesOf(int mode, std::span<const uint32_t> indices) {
  std::vector<glm::uvec2> strokes;
  if (mode == TINYGLTF_MODE_POINTS) {
    for (const uint32_t index : indices) strokes.emplace_back(index, index);
    return strokes;
  }
  const size_t step = mode == TINYGLTF_MODE_LINE ? 2 : 1;
  for (size_t i = 0; i + 1 < indices.size(); i += step) strokes.emplace_back(indices[i], indices[i + 1]);
  if (mode == TINYGLTF_MODE_LINE_LOOP && indices.size() > 2) strokes.emplace_back(indices.back(), indices[0]);
  return strokes;
}

/// Triangles in the order and with the winding that the specification gives them; what is left over of a
/// list, or too short for a triangle, is dropped.
std::vector<glm::uvec3> trianglesOf(Topology topology, std::span<const uint32_t> indices) {
  std::vector<glm::uvec3> triangles;
  if (indices.size() < 3) return triangles;
  const size_t count = topology == Topology::List ? indices.size() / 3 : indices.size() - 2;
  triangles.reserve(count);
  // glTF 2.0, section 3.7.2.1.
  for (size_t i = 0; i < count; ++i) {
    switch (topology) {
      case Topology::List:
        triangles.emplace_back(indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]);
        break;
      case Topology::Strip:
        triangles.emplace_back(indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]);
        break;
      case Topology::Fan:
        triangles.emplace_back(indices[i + 1], indices[i + 2], indices[0]);
        break;
    }
  }
  return triangles;
}

/// Inverse bind matrices of a skin; none: the identity for all.
std::vector<glm::dmat4> bindMatrices(Document& document, int skin) {
  const Skin& source = document.skins.at(size_t(skin));
  const std::string place = pointerTo("skins", skin, "inverseBindMatrices");
  if (source.inverseBindMatrices < 0) return std::vector<glm::dmat4>(source.joints.size(), glm::dmat4(1.0));
  takeMemory(document, place, accessorCount(document, source.inverseBindMatrices) * sizeof(glm::dmat4));
  std::vector<glm::dmat4> matrices = readMatrices(document, source.inverseBindMatrices, place);
  if (matrices.size() < source.joints.size()) {
    document.diagnostics.lose(place, "has " + std::to_string(matrices.size()) + " matrices for " +
                                         std::to_string(source.joints.size()) + " joints");
  }
  size_t broken = 0;
  for (glm::dmat4& matrix : matrices) {
    for (int column = 0; column < 4; ++column) {
      const double expected = column == 3 ? 1.0 : 0.0;
      broken += matrix[column][3] != expected;
      matrix[column][3] = expected;
    }
  }
  if (broken > 0)
    document.diagnostics.warn(place, "a last row that is not 0, 0, 0, 1 is taken as that", broken);
  return matrices;
}

/// Faults in the weights of a primitive, counted over its vertices.
struct WeightFaults {
  size_t unusable = 0;  ///< negative or not finite, taken as 0
  size_t missing = 0;   ///< all are 0
  size_t sums = 0;      ///< they do not add up to 1
};

/// Makes the weights of one vertex add up to 1.
void normalize(std::span<Influence> influences, WeightFaults& faults) {
  // Four to eight weights in bytes, each off by half of 1 / 255.
  constexpr double kRoundedToBytes = 0.0157;
  double sum = 0.0;
  for (Influence& influence : influences) {
    if (!(influence.weight >= 0.0f) || !std::isfinite(influence.weight)) {
      influence.weight = 0.0f;
      ++faults.unusable;
    }
    sum += double(influence.weight);
  }
  if (sum == 0.0) {
    influences[0].weight = 1.0f;
    ++faults.missing;
    return;
  }
  faults.sums += std::abs(sum - 1.0) > kRoundedToBytes;
  for (Influence& influence : influences) influence.weight = float(double(influence.weight) / sum);
}

void normalizeAll(std::vector<Influence>& influences, size_t perVertex, const std::string& place,
                  Diagnostics& diagnostics) {
  WeightFaults faults;
  for (size_t i = 0; i < influences.size(); i += perVertex)
    normalize(std::span(influences).subspan(i, perVertex), faults);
  const auto warn = [&](size_t count, const char* reason) {
    if (count > 0) diagnostics.warn(place, reason, count);
  };
  warn(faults.unusable, "a weight of a joint that is negative or not finite is taken as 0");
  warn(faults.missing, "a vertex whose joints all weigh 0 follows the first");
  warn(faults.sums, "weights of joints that do not add up to 1 are scaled");
}

/// The sets of JOINTS_n that have their WEIGHTS_n, counted from 0.
size_t influenceSets(const tinygltf::Primitive& primitive) {
  size_t sets = 0;
  while (primitive.attributes.contains("JOINTS_" + std::to_string(sets)) &&
         primitive.attributes.contains("WEIGHTS_" + std::to_string(sets)))
    ++sets;
  return sets;
}

/// The influences of a primitive's vertices, equally many each, whose weights add up to 1; none if it has no
/// joints. Throws a Loss for joints that are not among jointCount.
std::vector<Influence> readInfluences(Document& document, const tinygltf::Primitive& primitive,
                                      size_t jointCount, const std::string& place) {
  constexpr size_t kInASet = 4;
  const size_t sets = influenceSets(primitive);
  const size_t perVertex = sets * kInASet;
  const size_t count = accessorCount(document, primitive.attributes.at("POSITION"));
  takeMemory(document, place,
             count * (perVertex * sizeof(Influence) + sizeof(glm::uvec4) + sizeof(glm::vec4)));
  std::vector<Influence> influences(count * perVertex);
  for (size_t set = 0; set < sets; ++set) {
    const std::string joints = "JOINTS_" + std::to_string(set);
    const std::string weights = "WEIGHTS_" + std::to_string(set);
    for (const std::string& name : {joints, weights}) {
      const size_t elements = accessorCount(document, primitive.attributes.at(name));
      if (elements == count) continue;
      document.diagnostics.lose(
          place + pointerTo("attributes", name),
          "has " + std::to_string(elements) + " elements for " + std::to_string(count) + " positions");
    }
    const std::string jointPlace = place + pointerTo("attributes", joints);
    const auto jointsOf = readJoints(document, primitive.attributes.at(joints), jointPlace);
    const auto weightsOf = readVectors<4>(document, primitive.attributes.at(weights),
                                          place + pointerTo("attributes", weights), Integers::Fractions);
    for (size_t i = 0; i < count; ++i) {
      for (int k = 0; k < int(kInASet); ++k) {
        Influence influence{jointsOf[i][k], weightsOf[i][k]};
        if (influence.joint >= jointCount) {
          if (influence.weight != 0.0f) {
            document.diagnostics.lose(jointPlace, "joint " + std::to_string(influence.joint) +
                                                      " is past the " + std::to_string(jointCount) +
                                                      " of the skin");
          }
          document.diagnostics.warn(jointPlace, "a joint that is none of the skin's weighs 0");
          influence.joint = 0;
        }
        influences[i * perVertex + set * kInASet + size_t(k)] = influence;
      }
    }
  }
  if (sets > 0) normalizeAll(influences, perVertex, place + "/attributes/WEIGHTS_0", document.diagnostics);
  return influences;
}

/// True for what can be normalised: not zero, not NaN, and neither so small nor so large that its square is
/// not a number.
bool hasDirection(const glm::vec3& v) {
  const float squared = glm::length2(v);
  return squared > 0.0f && std::isfinite(squared);
}

/// Three components in bytes may each be off by half of 1 / 127.
bool isUnit(const glm::vec3& v) {
  constexpr float kRoundedToBytes = 0.00683f;
  return std::abs(glm::length(v) - 1.0f) <= kRoundedToBytes;
}

class PrimitiveReader {
 public:
  PrimitiveReader(Document& document, const std::vector<Material>& materials, int mesh, int primitive,
                  const MeshPose& pose)
      : document_(document),
        pose_(pose),
        diagnostics_(document.diagnostics),
        source_(document.model.meshes.at(size_t(mesh)).primitives.at(size_t(primitive))),
        place_(pointerTo("meshes", mesh, "primitives", primitive)),
        materialIndex_(source_.material >= 0 ? uint32_t(source_.material) : uint32_t(materials.size() - 1)),
        material_(materials.at(materialIndex_)) {}

  MeshPrimitive read() {
    diagnostics_.need(place_);
    constexpr int kLastMode = TINYGLTF_MODE_TRIANGLE_FAN;
    if (source_.mode > kLastMode)
      diagnostics_.lose(place_ + "/mode", std::to_string(source_.mode) + " is no mode");
    if (accessorOf("POSITION") < 0 || accessorCount(document_, accessorOf("POSITION")) == 0) {
      diagnostics_.warn(place_, "a primitive without vertices is left out");
      return {};
    }
    readPositions();
    const std::vector<uint32_t> indices = readIndexList();
    const std::optional<Topology> topology = topologyOf(source_.mode);
    if (topology) {
      readTriangles(*topology, indices);
      readNormals();
    } else {
      readStrokes(indices);
    }
    dropBroken();
    readTexcoords();
    readColors();
    if (pose_.jointCount > 0)
      result_.influences = readInfluences(document_, source_, pose_.jointCount, place_);
    if (topology) readTangents();
    return std::move(result_);
  }

 private:
  int accessorOf(const char* attribute) const {
    const auto found = source_.attributes.find(attribute);
    return found != source_.attributes.end() ? found->second : -1;
  }

  std::string placeOf(const char* attribute) const { return place_ + "/attributes/" + attribute; }

  /// The attribute's accessor after checking that it has as many elements as there are positions; -1 if not
  /// given.
  int matchingAccessor(const char* attribute) const {
    const int accessor = accessorOf(attribute);
    if (accessor >= 0 && accessorCount(document_, accessor) != result_.vertices.position.size()) {
      diagnostics_.lose(placeOf(attribute),
                        "has " + std::to_string(accessorCount(document_, accessor)) + " elements for " +
                            std::to_string(result_.vertices.position.size()) + " positions");
    }
    return accessor;
  }

  /// Adds what the morph targets change of an attribute (glTF 2.0, section 3.7.2.2), in double precision. A
  /// target's elements may have fewer components: those of tangents leave the handedness alone.
  template <glm::length_t components, glm::length_t all>
  void morph(const char* attribute, std::vector<glm::vec<all, float>>& values) {
    std::vector<glm::vec<components, double>> sums;
    for (size_t t = 0; t < std::min(pose_.weights.size(), source_.targets.size()); ++t) {
      const auto found = source_.targets[t].find(attribute);
      if (pose_.weights[t] == 0.0 || found == source_.targets[t].end()) continue;
      const std::string place = place_ + pointerTo("targets", t, attribute);
      const size_t count = accessorCount(document_, found->second);
      if (count != values.size()) {
        diagnostics_.lose(place, "has " + std::to_string(count) + " elements for " +
                                     std::to_string(values.size()) + " vertices");
      }
      takeMemory(document_, place,
                 count * sizeof(glm::vec<components, float>) + (sums.empty() ? count * sizeof(sums[0]) : 0));
      sums.resize(count, glm::vec<components, double>(0.0));
      const bool isColor = std::string_view(attribute) == "COLOR_0";
      const auto deltas = readVectors<components>(document_, found->second, place,
                                                  isColor ? Integers::Fractions : Integers::Numbers);
      for (size_t i = 0; i < count; ++i)
        sums[i] += pose_.weights[t] * glm::vec<components, double>(deltas[i]);
    }
    for (size_t i = 0; i < sums.size(); ++i) {
      for (glm::length_t c = 0; c < components; ++c) values[i][c] = float(double(values[i][c]) + sums[i][c]);
    }
  }

  void warnMended(const char* attribute, size_t count, const std::string& reason) {
    if (count > 0) diagnostics_.warn(placeOf(attribute), reason, count);
  }

  void readPositions() {
    // Elements may take no room in the file: without a buffer view they are zeros.
    constexpr uint64_t kBytesOfAVertex =
        sizeof(glm::vec3) * 2 + sizeof(glm::vec4) * 2 + sizeof(glm::vec2) * 2;
    takeMemory(document_, placeOf("POSITION"),
               kBytesOfAVertex * accessorCount(document_, accessorOf("POSITION")));
    auto& positions = result_.vertices.position;
    positions = readVectors<3>(document_, accessorOf("POSITION"), placeOf("POSITION"));
    morph<3>("POSITION", positions);
    if (positions.size() >= kMissIndex) diagnostics_.lose(placeOf("POSITION"), "has too many elements");
    for (size_t i = 0; i < positions.size(); ++i) {
      if (isFinite(positions[i])) continue;
      positions[i] = glm::vec3(0.0f);
      broken_.push_back(uint32_t(i));
    }
  }

  /// Leaves out what has a vertex that is not finite.
  void dropBroken() {
    if (broken_.empty()) return;
    const auto isBroken = [&](uint32_t vertex) { return std::ranges::binary_search(broken_, vertex); };
    std::erase_if(result_.triangles, [&](const Triangle& t) {
      return isBroken(t.vertex.x) || isBroken(t.vertex.y) || isBroken(t.vertex.z);
    });
    std::erase_if(result_.strokes.ends,
                  [&](const glm::uvec2& ends) { return isBroken(ends.x) || isBroken(ends.y); });
    if (result_.empty())
      diagnostics_.lose(placeOf("POSITION"), "vertex " + std::to_string(broken_[0]) + " is not finite");
    warnMended("POSITION", broken_.size(), "a vertex that is not finite is left out with its triangles");
  }

  /// Returns the indices of the file, or those of all vertices.
  std::vector<uint32_t> readIndexList() {
    const size_t vertexCount = result_.vertices.position.size();
    std::vector<uint32_t> indices;
    if (source_.indices < 0) {
      indices.resize(vertexCount);
      std::iota(indices.begin(), indices.end(), 0u);
      return indices;
    }
    constexpr uint64_t kBytesOfAnIndex = sizeof(uint32_t) + sizeof(Triangle);
    takeMemory(document_, place_ + "/indices", kBytesOfAnIndex * accessorCount(document_, source_.indices));
    indices = readIndices(document_, source_.indices, vertexCount, place_ + "/indices");
    return indices;
  }

  void readStrokes(const std::vector<uint32_t>& indices) {
    result_.strokes.material = materialIndex_;
    result_.strokes.lit = accessorOf("NORMAL") >= 0;
    result_.strokes.ends = strokesOf(source_.mode, indices);
    if (result_.strokes.ends.empty() || (source_.mode == TINYGLTF_MODE_LINE && indices.size() % 2 != 0))
      diagnostics_.warn(place_, "vertices that make no whole line are left out");
  }

  void readTriangles(Topology topology, const std::vector<uint32_t>& indices) {
    const std::vector<glm::uvec3> triangles = trianglesOf(topology, indices);
    if (triangles.empty() || (topology == Topology::List && indices.size() % 3 != 0)) {
      diagnostics_.warn(place_, "vertices that make no whole triangle are left out");
    }
    const bool flat = accessorOf("NORMAL") < 0;
    result_.triangles.reserve(triangles.size());
    for (const glm::uvec3& triangle : triangles)
      result_.triangles.push_back({triangle, materialIndex_, flat});
  }

  /// Returns the triangle's unit normal; zero for a triangle without area.
  glm::vec3 geometricNormal(const Triangle& triangle) const {
    const auto& position = result_.vertices.position;
    const glm::dvec3 a(position[triangle.vertex.x]);
    const glm::dvec3 cross =
        glm::cross(glm::dvec3(position[triangle.vertex.y]) - a, glm::dvec3(position[triangle.vertex.z]) - a);
    const double length = glm::length(cross);
    return length > 0.0 ? glm::vec3(cross / length) : glm::vec3(0.0f);
  }

  void readNormals() {
    const int accessor = matchingAccessor("NORMAL");
    if (accessor < 0) return;
    auto& normals = result_.vertices.normal;
    normals = readVectors<3>(document_, accessor, placeOf("NORMAL"));
    std::vector<bool> broken(normals.size(), false);
    size_t count = 0;
    size_t notUnit = 0;
    for (size_t i = 0; i < normals.size(); ++i) {
      if (hasDirection(normals[i])) {
        notUnit += !isUnit(normals[i]);
        continue;
      }
      broken[i] = true;
      normals[i] = glm::vec3(0.0f);
      ++count;
    }
    warnMended("NORMAL", notUnit, "a normal that is not of unit length is normalized");
    if (count > 0) mendNormals(broken, count);
    morph<3>("NORMAL", normals);
  }

  void mendNormals(const std::vector<bool>& broken, size_t count) {
    auto& normals = result_.vertices.normal;
    for (const Triangle& triangle : result_.triangles) {
      const glm::vec3 normal = geometricNormal(triangle);
      for (int corner = 0; corner < 3; ++corner) {
        if (broken[triangle.vertex[corner]]) normals[triangle.vertex[corner]] += normal;
      }
    }
    for (glm::vec3& normal : normals) {
      if (!hasDirection(normal)) normal = glm::vec3(0.0f, 0.0f, 1.0f);
    }
    warnMended("NORMAL", count, "a normal without a direction is replaced by that of its triangles");
  }

  bool needsTexcoord(uint32_t place) const {
    const bool isAskedFor = std::ranges::any_of(kTextureRefs, [&](const TextureRefRow& texture) {
      const TextureRef& ref = material_.*texture.ref;
      return ref.present() && ref.texcoord == place;
    });
    if (isAskedFor) return true;
    const bool tangentsAreMade = material_.anisotropic() && accessorOf("TANGENT") < 0;
    return (place == 0 && hasPerlin()) || (place == tangentTexture().texcoord && tangentsAreMade);
  }

  bool hasPerlin() const { return material_.perlinNormal.amplitude != 0.0f; }

  void readTexcoords() {
    for (uint32_t place = 0; place < material_.texcoordSets.size(); ++place) {
      if (!needsTexcoord(place)) continue;
      const std::string name = "TEXCOORD_" + std::to_string(material_.texcoordSets[place]);
      const int accessor = matchingAccessor(name.c_str());
      auto& texcoords = place == 0 ? result_.vertices.texcoord0 : result_.vertices.texcoord1;
      if (accessor < 0) {
        diagnostics_.warn(place_, name + " is needed and missing, (0, 0) is taken");
        texcoords.assign(result_.vertices.position.size(), glm::vec2(0.0f));
        continue;
      }
      texcoords = readVectors<2>(document_, accessor, placeOf(name.c_str()));
      morph<2>(name.c_str(), texcoords);
      size_t count = 0;
      for (glm::vec2& texcoord : texcoords) {
        if (isFinite(texcoord)) continue;
        texcoord = glm::vec2(0.0f);
        ++count;
      }
      warnMended(name.c_str(), count, "a texture coordinate that is not finite is replaced by (0, 0)");
    }
  }

  void readColors() {
    const int accessor = matchingAccessor("COLOR_0");
    if (accessor < 0) return;
    auto& colors = result_.vertices.color;
    colors = fragtrace::readColors(document_, accessor, placeOf("COLOR_0"));
    size_t count = 0;
    size_t clamped = 0;
    for (glm::vec4& color : colors) {
      if (!isFinite(color)) {
        color = glm::vec4(1.0f);
        ++count;
      }
      const glm::vec4 given = color;
      color = glm::clamp(given, 0.0f, 1.0f);  // glTF 2.0, section 3.7.2.1
      clamped += color != given;
    }
    morphColors();
    warnMended("COLOR_0", clamped, "a vertex colour is clamped to 0..1");
    warnMended("COLOR_0", count, "a vertex colour that is not finite is replaced by white");
  }

  /// Deltas have the components of the colours; sums are clamped (section 3.7.2.2).
  void morphColors() {
    auto& colors = result_.vertices.color;
    const bool hasAlpha =
        document_.model.accessors.at(size_t(accessorOf("COLOR_0"))).type == TINYGLTF_TYPE_VEC4;
    hasAlpha ? morph<4>("COLOR_0", colors) : morph<3>("COLOR_0", colors);
    for (glm::vec4& color : colors) color = isFinite(color) ? glm::clamp(color, 0.0f, 1.0f) : glm::vec4(1.0f);
  }

  void readTangents() {
    if (!tangentTexture().present() && !hasPerlin() && !material_.anisotropic()) return;
    if (result_.vertices.normal.empty()) return makeFlatTangents();
    const int accessor = matchingAccessor("TANGENT");
    if (accessor < 0) return makeTangentsAlongTexture();

    auto& tangents = result_.vertices.tangent;
    tangents = readVectors<4>(document_, accessor, placeOf("TANGENT"));
    size_t count = 0;
    size_t notUnit = 0;
    for (size_t i = 0; i < tangents.size(); ++i) {
      if (!hasDirection(glm::vec3(tangents[i])) || !std::isfinite(tangents[i].w)) {
        tangents[i] = glm::vec4(anyPerpendicular(result_.vertices.normal[i]), 1.0f);
        ++count;
      } else {
        notUnit += !isUnit(glm::vec3(tangents[i])) || std::abs(tangents[i].w) != 1.0f;
      }
      tangents[i].w = tangents[i].w < 0.0f ? -1.0f : 1.0f;
    }
    morph<3>("TANGENT", tangents);
    warnMended("TANGENT", notUnit, "a tangent is not of unit length with 1 or -1 behind it, and made so");
    warnMended("TANGENT", count, "a tangent without a direction is replaced by any that fits");
  }

  /// The texture that tangents follow, if there is one: the first that is there.
  const TextureRef& tangentTexture() const {
    for (const TextureRef* texture : {&material_.normalTexture, &material_.clearcoatNormalTexture}) {
      if (texture->present()) return *texture;
    }
    return material_.anisotropyTexture;
  }

  void makeTangentsAlongTexture() {
    const TextureRef& texture = tangentTexture();
    makeTangents(result_.vertices, result_.triangles, texture.texcoord, texture.transform);
  }

  /// Without normals each triangle has its own: corners are parted, and given tangents are ignored, as glTF
  /// demands.
  void makeFlatTangents() {
    std::vector<uint32_t> corners;
    corners.reserve(result_.triangles.size() * 3);
    std::vector<glm::vec3> normals;
    normals.reserve(corners.capacity());
    for (Triangle& triangle : result_.triangles) {
      const glm::vec3 normal = geometricNormal(triangle);
      for (int corner = 0; corner < 3; ++corner) {
        normals.push_back(normal);
        corners.push_back(triangle.vertex[corner]);
        triangle.vertex[corner] = uint32_t(corners.size() - 1);
      }
    }
    const auto part = [&corners](auto& attribute) {
      if (attribute.empty()) return;
      auto parted = attribute;
      parted.resize(corners.size());
      for (size_t i = 0; i < corners.size(); ++i) parted[i] = attribute[corners[i]];
      attribute = std::move(parted);
    };
    partInfluences(corners);
    part(result_.vertices.position);
    part(result_.vertices.texcoord0);
    part(result_.vertices.texcoord1);
    part(result_.vertices.color);
    result_.vertices.normal = std::move(normals);
    makeTangentsAlongTexture();
    result_.vertices.normal.clear();
  }

  void partInfluences(const std::vector<uint32_t>& corners) {
    const std::vector<Influence> shared = std::move(result_.influences);
    const size_t perVertex = shared.size() / std::max<size_t>(result_.vertices.position.size(), 1);
    result_.influences.clear();
    result_.influences.reserve(corners.size() * perVertex);
    for (const uint32_t corner : corners) {
      const auto first = shared.begin() + std::ptrdiff_t(corner * perVertex);
      result_.influences.insert(result_.influences.end(), first, first + std::ptrdiff_t(perVertex));
    }
  }

  Document& document_;
  const MeshPose& pose_;
  Diagnostics& diagnostics_;
  const tinygltf::Primitive& source_;
  std::string place_;
  uint32_t materialIndex_;
  const Material& material_;
  MeshPrimitive result_;
  std::vector<uint32_t> broken_;  ///< vertices that are not finite, rising
};

}  // namespace

std::vector<glm::dmat4> jointMatrices(Document& document, int node,
                                      const std::vector<const PlacedNode*>& nodes) {
  const int skin = document.model.nodes.at(size_t(node)).skin;
  std::vector<glm::dmat4> matrices = bindMatrices(document, skin);
  const std::vector<int>& joints = document.skins.at(size_t(skin)).joints;
  matrices.resize(joints.size());
  for (size_t i = 0; i < joints.size(); ++i) {
    const PlacedNode* joint = nodes.at(size_t(joints[i]));
    if (joint == nullptr) {
      document.diagnostics.lose(pointerTo("nodes", node, "skin"),
                                "its joint, node " + std::to_string(joints[i]) + ", is not in the scene");
    }
    matrices[i] = joint->world * matrices[i];
    if (!isMultiplicable(matrices[i]))
      document.diagnostics.lose(pointerTo("skins", skin, "joints", i), "its matrix overflows");
  }
  return matrices;
}

MeshPrimitive decodePrimitive(Document& document, const std::vector<Material>& materials, int mesh,
                              int primitive, const MeshPose& pose) {
  return PrimitiveReader(document, materials, mesh, primitive, pose).read();
}

}  // namespace fragtrace
