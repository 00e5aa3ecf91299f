// SPDX-License-Identifier: MIT
#include "gltf/gltf.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <new>
#include <set>
#include <utility>

#include "base/errors.h"
#include "base/text.h"
#include "bvh/contacts.h"
#include "gltf/assemble/animation.h"
#include "gltf/assemble/materials.h"
#include "gltf/assemble/meshes.h"
#include "gltf/assemble/nodes.h"
#include "gltf/assemble/numbers.h"
#include "gltf/assemble/textures.h"
#include "gltf/check/extensions.h"
#include "gltf/check/repairs.h"
#include "gltf/check/schema.h"
#include "gltf/codecs/compression.h"
#include "gltf/read/accessor.h"
#include "gltf/read/container.h"
#include "gltf/read/document.h"
#include "gltf/read/json.h"
#include "scene/camera.h"
#include "scene/creases.h"
#include "scene/parts.h"
#include "scene/strokes.h"

namespace fragtrace {

struct KeptDocument {
  Document document;  ///< the file as it stands, not posed; its model is empty until it is needed
  std::vector<Animation> animations;
  std::vector<float> keyTimes = {};  ///< key times of the latest pose, in any order
};

namespace {

using nlohmann::json;

/// The array of that name; an empty one is made where there is none.
json& arrayIn(json& root, const char* name) {
  json& array = root[name];
  if (array.is_null()) array = json::array();
  return array;
}

void checkExtensions(json& root, const std::vector<std::string>& ignored, Diagnostics& diagnostics) {
  const json& required = arrayIn(root, "extensionsRequired");
  for (size_t i = 0; i < required.size(); ++i) {
    const auto& name = required[i].get_ref<const std::string&>();
    if (extensionNamed(name) == nullptr && std::ranges::find(ignored, name) == ignored.end()) {
      diagnostics.refuse(pointerTo("extensionsRequired", i),
                         "the extension " + inQuotes(name) +
                             " is required and not supported (--ignore-required draws the scene without it)");
    }
  }
  const json& used = arrayIn(root, "extensionsUsed");
  for (size_t i = 0; i < used.size(); ++i) {
    const auto& name = used[i].get_ref<const std::string&>();
    if (extensionNamed(name) == nullptr) {
      diagnostics.warn(pointerTo("extensionsUsed", i), "the extension " + inQuotes(name) + " is ignored");
    }
  }
}

/// Tells how far files have been read, as a part of the load from one to another.
ReadProgress tellReading(const GltfProgress& progress, const std::string& what, double from, double to) {
  if (!progress) return {};
  return [progress, what, from, to](uint64_t read, uint64_t size) {
    constexpr uint64_t kMegabyte = 1'000'000;
    constexpr uint64_t kWorthCounting = 32 * kMegabyte;
    std::string text = what;
    if (std::max(read, size) >= kWorthCounting) {
      text += ", " + std::to_string(read / kMegabyte);
      if (size > 0) text += " of " + std::to_string(size / kMegabyte);
      text += " MB";
    }
    progress(text, from + (to - from) * (size > 0 ? std::min(double(read) / double(size), 1.0) : 0.0));
  };
}

// Parts of a load, whose second half is the tree's (session/setup.cpp).
constexpr double kContainerPart = 0.2;
constexpr double kBuffersPart = 0.4;

/// The bytes of a buffer's URI.
std::vector<uint8_t> readBuffer(const std::string& uri, size_t index, size_t count, Document& document) {
  const std::string place = pointerTo("buffers", index, "uri");
  document.refersToFiles = document.refersToFiles || !isDataUri(uri);
  if (!isDataUri(uri)) document.made.buffers.push_back(pathOfUri(document.access, uri));
  const double step = (kBuffersPart - kContainerPart) / double(count);
  const double from = kContainerPart + double(index) * step;
  document.access.progress = tellReading(
      document.progress, "reading buffer " + std::to_string(index + 1) + " of " + std::to_string(count), from,
      from + step);
  std::vector<uint8_t> bytes =
      document.diagnostics.attempt(place, [&] { return readUri(document.access, uri, document.memory); });
  if (const std::string odd = oddityOf(document.access, uri); !odd.empty())
    document.diagnostics.warn(place, odd);
  takeMemory(document, place, bytes.size());
  return bytes;
}

/// The URIs of all buffers and pictures.
std::vector<std::string> urisOf(json& root) {
  std::vector<std::string> uris;
  for (const char* array : {"buffers", "images"}) {
    for (const json& one : arrayIn(root, array)) uris.push_back(one.value("uri", std::string()));
  }
  std::erase(uris, "");
  return uris;
}

/// Brings every buffer into memory, at most as long as the document says; one without URI stays empty, and so
/// does one that is lost.
Buffers readBuffers(json& root, Container& container, Worker& codecs, const IsUsed& isUsed,
                    Document& document) {
  Diagnostics& diagnostics = document.diagnostics;
  Buffers buffers;
  json& described = arrayIn(root, "buffers");
  for (size_t i = 0; i < described.size(); ++i) {
    json& buffer = described[i];
    const auto length = buffer["byteLength"].get<uint64_t>();
    std::vector<uint8_t>& bytes = buffers.emplace_back();
    if (length == 0 || (isFallback(buffer) && codecs.works())) continue;
    const std::string place = pointerTo("buffers", i);
    if (buffer.contains("uri")) {
      const auto& uri = buffer["uri"].get_ref<const std::string&>();
      try {
        bytes = readBuffer(uri, i, described.size(), document);
      } catch (const InputError& error) {
        if (isUsed(place)) throw InputError(error.what() + alsoMissing(document.access, urisOf(root), uri));
        diagnostics.warn(place + "/uri", "cannot be read, and nothing uses it");
        diagnostics.noteLost(place);
        continue;
      }
    } else if (i == 0 && container.hasBinary) {
      bytes = std::move(container.binary);
    } else {
      continue;  // an extension may bring it; bytesOf() loses what uses it
    }
    if (bytes.empty()) {
      const std::string than =
          length < kToTheEnd ? ", fewer than its byteLength of " + buffer["byteLength"].dump() : "";
      diagnostics.warnLoss(place, "holds 0 bytes" + than, "the buffer", isUsed(place));
      diagnostics.noteLost(place);
    }
    if (length == kToTheEnd) buffer["byteLength"] = bytes.size();
    bytes.resize(std::min<uint64_t>(bytes.size(), length));
  }
  return buffers;
}

/// Takes buffers with less data than the document says as they are.
void takeShortBuffers(json& root, const Buffers& data, const std::map<size_t, bool>& losesUsedView,
                      Diagnostics& diagnostics) {
  for (size_t i = 0; i < data.size(); ++i) {
    json& length = root["buffers"][i]["byteLength"];
    if (data[i].empty() || data[i].size() == length) continue;
    const std::string reason =
        "holds " + std::to_string(data[i].size()) + " bytes, fewer than its byteLength of " + length.dump();
    const auto loses = losesUsedView.find(i);
    if (loses == losesUsedView.end())
      diagnostics.warn(pointerTo("buffers", i), reason + "; what lies within them is read");
    else
      diagnostics.warnLoss(pointerTo("buffers", i), reason, "what lies past them", loses->second);
    length = data[i].size();
  }
}

/// Buffer views that reach past their buffer are lost. Takes out strides, of which tinygltf refuses some.
void checkBufferViews(json& root, const Buffers& data, const IsUsed& isUsed, Document& document) {
  Diagnostics& diagnostics = document.diagnostics;
  json& views = arrayIn(root, "bufferViews");
  const json& buffers = arrayIn(root, "buffers");
  std::map<size_t, bool> losesUsedView;  // by short buffer
  for (size_t i = 0; i < views.size(); ++i) {
    json& view = views[i];
    document.strides.push_back(view.value("byteStride", size_t(0)));
    view.erase("byteStride");
    const std::string place = pointerTo("bufferViews", i);
    const uint64_t offset = view.value("byteOffset", uint64_t(0));
    const auto buffer = view["buffer"].get<size_t>();
    const auto size = buffer < buffers.size() ? buffers[buffer]["byteLength"].get<uint64_t>() : 0;
    const uint64_t there = buffer < data.size() && !data[buffer].empty() ? data[buffer].size() : size;
    if (view["byteLength"] == kToTheEnd) view["byteLength"] = there - std::min(offset, there);
    const auto length = view["byteLength"].get<uint64_t>();
    const auto reachesPast = [&](uint64_t end) { return offset > end || length > end - offset; };
    const bool isTold = diagnostics.isLost(place) || diagnostics.isLost(pointerTo("buffers", buffer));
    if (!isTold && !reachesPast(there)) continue;
    if (!isTold && reachesPast(size))
      diagnostics.warnLoss(place,
                           std::to_string(length) + " bytes from byte " + std::to_string(offset) +
                               " reach past the " + std::to_string(size) + " of its buffer",
                           "the buffer view", isUsed(place));
    else if (!isTold)
      losesUsedView[buffer] = losesUsedView[buffer] || isUsed(place);
    diagnostics.noteLost(place);
    view["byteLength"] = 0;
    view["byteOffset"] = 0;
  }
  takeShortBuffers(root, data, losesUsedView, diagnostics);
}

/// Notes who made the file, and the names that the user may choose from.
void noteNames(json& root, Document& document) {
  const auto said = [&](const char* member) {
    const json& asset = root["asset"];
    return asset.contains(member) && asset[member].is_string() ? asset[member].get<std::string>() : "";
  };
  document.made.generator = said("generator");
  document.made.copyright = said("copyright");
  const json::json_pointer variants("/extensions/KHR_materials_variants/variants");
  document.sceneNames = namesOf(arrayIn(root, "scenes"));
  document.animationNames = namesOf(arrayIn(root, "animations"));
  for (const json& animation : arrayIn(root, "animations"))
    document.animationSeconds.push_back(durationOf(animation, arrayIn(root, "accessors")));
  if (root.contains(variants)) document.materialVariants = namesOf(root[variants]);
}

/// Takes out what tinygltf need not see: pictures, buffers, and bounds of accessors. It wants a buffer view
/// for indices, which glTF does not (they are all 0, or sparse): the last view stands for none.
void hideBytes(json& root, FileBytes& bytes) {
  for (const json& image : arrayIn(root, "images")) {
    bytes.images.push_back({image.value("uri", std::string()), image.value("bufferView", -1)});
  }
  root.erase("images");
  root.erase("buffers");
  json& views = arrayIn(root, "bufferViews");
  for (json& accessor : arrayIn(root, "accessors")) {
    accessor.emplace("bufferView", views.size());
    accessor.erase("min");
    accessor.erase("max");
  }
  views.push_back({{"buffer", 0}, {"byteLength", 0}});
}

/// Gives tinygltf what is read from its model.
void parseModel(Document& document) {
  constexpr const char* kParts[] = {
      "asset",     "extensionsUsed", "extensionsRequired", "scene",    "scenes",  "nodes", "meshes",
      "accessors", "cameras",        "bufferViews",        "textures", "samplers"};
  std::string text;
  for (const char* part : kParts) {
    const json& member = memberOf(*document.root, part);
    if (!member.is_null())
      text.append(text.empty() ? "{" : ",").append(json(part).dump() + ":" + member.dump());
  }
  text += "}";
  if (text.size() > std::numeric_limits<int32_t>::max())
    document.diagnostics.refuse("", "the JSON is too large");
  tinygltf::TinyGLTF parser;
  std::string error;
  std::string warning;
  document.model = {};
  if (!parser.LoadASCIIFromString(&document.model, &error, &warning, text.data(), unsigned(text.size()),
                                  "")) {
    while (!error.empty() && error.back() == '\n') error.pop_back();
    std::replace(error.begin(), error.end(), '\n', ' ');
    document.diagnostics.refuse("", error.empty() ? "tinygltf cannot parse it" : error);
  }
}

/// Returns true if the value at a pointer is read from the model.
bool isOfModel(const std::string& pointer) {
  return !pointer.starts_with("/materials/") && pointer.find("/extensions/") == std::string::npos;
}

/// The animations that the options play; says what is not played.
std::vector<const Animation*> playedAnimations(const KeptDocument& read, const SceneSelection& selection,
                                               Document& document) {
  std::vector<const Animation*> played;
  for (const size_t index : chosenAnimations(selection.animation, document.animationNames))
    played.push_back(&read.animations[index]);
  if (played.empty()) document.diagnostics.remark("", "has no animation that a time could be of");
  if (!played.empty() && selection.animation.empty() && read.animations.size() > 1)
    document.diagnostics.remark("/animations",
                                "not played: " + std::to_string(read.animations.size() - 1) + " of " +
                                    std::to_string(read.animations.size()) +
                                    " (--animation all plays all at once, --animation NAME another one)");
  return played;
}

/// Makes the chosen scene the default one and gives primitives the materials of the chosen variant
/// (KHR_materials_variants). Throws UsageError.
void applySelection(json& root, const SceneSelection& selection, Document& document) {
  if (!selection.scene.empty()) root["scene"] = indexOfPart("--scene", selection.scene, document.sceneNames);
  if (selection.materialVariant.empty()) return;
  const size_t variant =
      indexOfPart("--material-variant", selection.materialVariant, document.materialVariants);
  if (!root.contains("meshes")) return;
  const json::json_pointer mappings("/extensions/KHR_materials_variants/mappings");
  bool isMapped = false;
  for (json& mesh : root["meshes"]) {
    for (json& primitive : mesh["primitives"]) {
      if (!primitive.contains(mappings)) continue;
      for (const json& mapping : primitive[mappings]) {
        const json& variants = mapping["variants"];
        if (std::find(variants.begin(), variants.end(), variant) == variants.end()) continue;
        primitive["material"] = mapping["material"];
        isMapped = true;
        break;
      }
    }
  }
  if (!isMapped)
    document.diagnostics.warn("/extensions/KHR_materials_variants/variants/" + std::to_string(variant),
                              "no primitive has a material for this variant; all keep their own");
}

/// Reads and checks the document; pictures next to it are not read yet. Throws InputError.
KeptDocument readDocument(const std::filesystem::path& path, const GltfOptions& options) {
  Document document(path.string(), options.limits);
  document.access = {path.parent_path(), options.limits.allowExternalFiles};
  document.progress = options.progress;
  Diagnostics& diagnostics = document.diagnostics;
  Container container =
      readContainer(path, options.limits.memoryBytes, diagnostics,
                    tellReading(options.progress, "reading the scene", 0.0, kContainerPart));
  takeMemory(document, "", container.binary.size());
  document.root = std::make_shared<json>(parseJson(container.json, document.memory, diagnostics));
  json& root = *document.root;
  container.json = std::string();
  checkVersions(root, diagnostics);
  supplyMembers(root, diagnostics);
  addLights(root, options.selection.lights, options.selection.up);
  const IsUsed isUsed = applySchema(root, options.selection, diagnostics);
  mendValues(root, isUsed, diagnostics);
  checkExtensions(root, options.limits.ignoredExtensions, diagnostics);
  noteNames(root, document);
  applySelection(root, options.selection, document);
  Worker codecs(kGeometryCodecs);
  Buffers& buffers = document.bytes->buffers;
  buffers = readBuffers(root, container, codecs, isUsed, document);
  checkBufferViews(root, buffers, isUsed, document);
  document.access.progress = tellReading(options.progress, "reading textures", kBuffersPart, kBuffersPart);
  if (options.progress) options.progress("unpacking", kBuffersPart);
  decompressViews(root, buffers, codecs, document);
  decompressPrimitives(root, buffers, codecs, document);
  for (const json& skin : arrayIn(root, "skins"))
    document.skins.push_back({skin["joints"].get<std::vector<int>>(), skin.value("inverseBindMatrices", -1)});
  std::vector<Animation> animations = takeAnimations(root);
  hideBytes(root, *document.bytes);
  return {std::move(document), std::move(animations)};
}

/// The document in the pose of the options: a copy, which shares its bytes, of one that is kept for other
/// poses. Throws InputError and UsageError.
Document posed(KeptDocument& read, bool isKept, const GltfOptions& options) {
  const SceneSelection& selection = options.selection;
  const bool plays = selection.animationTime || !selection.animation.empty();
  // A colour of a material takes colours of vertices out.
  bool parses = std::ranges::any_of(
      selection.set, [](const SetNumber& set) { return namesMaterials(set) || isOfModel(set.pointer); });
  const auto isParsed = [](const Document& one) { return !one.model.bufferViews.empty(); };
  if ((plays || isKept) && !isParsed(read.document)) parseModel(read.document);
  Document document = isKept ? read.document : std::move(read.document);
  document.keepsPictures = isKept;
  const auto played = plays ? playedAnimations(read, selection, document) : std::vector<const Animation*>();
  bool changes = !selection.set.empty();
  for (const Animation* animation : played) {
    for (const Channel& channel : animation->channels) {
      if (channel.target.empty() || isMemberOfNode(channel.target, *document.root)) continue;
      changes = true;
      parses = parses || isOfModel(channel.target);
    }
  }
  if (changes && isKept) document.root = std::make_shared<json>(*document.root);
  writeNumbers(*document.root, selection.set, document.diagnostics);
  // An animation that is named without a time is at time 0.
  const double seconds = selection.animationTime.value_or(0.0);
  for (const Animation* animation : played)
    applyAnimation(document, *animation, seconds, options.shutter, !parses);
  if (parses || !isParsed(document)) parseModel(document);
  return document;
}

/// Refuses what 32-bit indices or the memory limit do not allow.
void takeMeshes(Document& document, const PlacedMeshes& placed) {
  size_t vertexCount = 0;
  size_t triangleCount = 0;
  const auto count = [&](const MeshPrimitive& primitive) {
    vertexCount += primitive.vertices.position.size();
    triangleCount += primitive.triangles.size();
    vertexCount += primitive.strokes.ends.size() * kMostStrokeVertices;
    triangleCount += trianglesOf(primitive.strokes);
  };
  for (const PrimitiveInstance& instance : placed.flat) count(*instance.primitive);
  for (const MeshToShare& shared : placed.shared) {
    for (const MeshPrimitive& primitive : *shared.mesh) count(primitive);
  }
  if (std::max(vertexCount, triangleCount) >= kMissIndex) {
    document.diagnostics.refuse("", std::to_string(triangleCount) + " triangles with " +
                                        std::to_string(vertexCount) +
                                        " vertices are too many for 32-bit indices");
  }
  takeMemory(document, "", placed.bytes);
}

BoundsDouble boundsOf(const std::vector<PlacedSphere>& spheres) {
  BoundsDouble bounds;
  for (const PlacedSphere& sphere : spheres) {
    bounds.include(sphere.center - glm::dvec3(sphere.radius));
    bounds.include(sphere.center + glm::dvec3(sphere.radius));
  }
  return bounds;
}

/// The place of the camera, if it is known; none: the camera frames the scene.
std::optional<glm::dvec3> cameraFor(const GltfOptions& options, const Scene& scene) {
  if (options.cameraPosition) return options.cameraPosition;
  const std::optional<int> named = cameraIndexOf({}, options.selection.camera, scene.cameras);
  const auto index = size_t(named.value_or(std::max(options.cameraIndex, 0)));
  return index < scene.cameras.size() ? std::optional(scene.cameras[index].position) : std::nullopt;
}

/// Chooses local space.
void recentre(const GltfOptions& options, const Diagnostics& diagnostics, Scene& scene) {
  const BoundsDouble& bounds = scene.bounds;
  LocalSpace& space = scene.space;
  space.origin =
      options.recenterOn ? *options.recenterOn : recentringPoint(cameraFor(options, scene), bounds);
  if (bounds.empty()) return;
  const glm::dvec3 farthest =
      glm::max(glm::abs(bounds.minimum - space.origin), glm::abs(bounds.maximum - space.origin));
  const double reach = std::max({farthest.x, farthest.y, farthest.z});
  if (!(reach <= kFarthest)) {
    diagnostics.refuse("",
                       "the scene is more than 1e30 m in size, or as far from the point it is recentred on");
  }
  // Shaders multiply up to five lengths. If the scene's largest coordinate is within these limits, triangles
  // of a ten millionth of it, and cameras a million times as far away, stay within what floats can hold.
  constexpr double kLeastReach = 0x1p-4;
  constexpr double kMostReach = 0x1p16;
  constexpr int kReachBits = 10;
  if (reach == 0.0 || (reach >= kLeastReach && reach <= kMostReach)) return;
  int exponent = 0;
  std::frexp(reach, &exponent);
  space.unit = std::ldexp(1.0, std::max(exponent, -900) - kReachBits);
}

/// Says which parts have no inside.
void warnThinned(const std::map<std::string, size_t>& thinned, Diagnostics& diagnostics) {
  for (const auto& [place, count] : thinned)
    diagnostics.warn(place,
                     "has a thickness, and is on a part that bounds no solid; such a part is drawn as a "
                     "thin wall",
                     count);
}

/// The default material was appended last, and goes again if nothing uses it.
void dropUnusedDefaultMaterial(Scene& scene, uint32_t last) {
  if (last + 1 != scene.materials.size()) return;
  const auto usesLast = [last](const auto& part) { return part.material == last; };
  if (last > 0 && std::ranges::none_of(scene.triangles, usesLast) &&
      std::ranges::none_of(scene.spheres, usesLast) && std::ranges::none_of(scene.strokes, usesLast)) {
    scene.materials.pop_back();
  }
}

std::vector<SceneNode> namedNodes(const Document& document, const std::vector<PlacedNode>& placed) {
  std::vector<SceneNode> nodes;
  nodes.reserve(placed.size());
  for (const PlacedNode& node : placed) {
    const tinygltf::Node& source = document.model.nodes[size_t(node.index)];
    const nlohmann::json& json = jsonOf(document, "nodes", node.index);
    nodes.push_back({nameOrPlace(source.name, "nodes", node.index), uint32_t(node.index), node.depth,
                     node.hidden, node.hiddenInFile,
                     source.mesh >= 0 || !memberOf(memberOf(json, "extras"), "shape").is_null(),
                     extensionOf(json, "KHR_lights_punctual").is_object(), source.camera >= 0});
  }
  return nodes;
}

/// Gives the scene its cameras and its volume, and returns its spheres: all in world space.
std::vector<PlacedSphere> takeParts(Document& document, const std::vector<PlacedNode>& nodes,
                                    bool readsVolume, Scene& scene) {
  std::vector<PlacedSphere> spheres;
  for (const PlacedNode& node : nodes) {
    Diagnostics& diagnostics = document.diagnostics;
    const auto camera = diagnostics.keepRest("the camera", [&] { return cameraAt(document, node); });
    if (camera && *camera) scene.cameras.push_back(**camera);
    if (node.hidden) continue;
    const auto sphere = diagnostics.keepRest("the sphere", [&] { return sphereAt(document, node); });
    if (sphere && *sphere) spheres.push_back(**sphere);
    std::optional<Volume> volume;
    if (readsVolume) volume = volumeAt(document, node);
    if (volume && !scene.volume.source.file.empty())
      document.diagnostics.warn(pointerTo("nodes", node.index, "extras", "fragtrace_volume"),
                                "a scene has one volume; this one is left out");
    else if (volume)
      scene.volume = std::move(*volume);
  }
  return spheres;
}

/// Takes over the warnings. Refuses a scene of which losses leave nothing, and with --strict any warning.
void settle(const Diagnostics& diagnostics, const GltfOptions& options, Scene& scene) {
  const bool isEmpty = scene.triangles.empty() && scene.spheres.empty() && scene.strokes.empty() &&
                       scene.volume.source.file.empty();
  if (isEmpty && diagnostics.firstLoss() && options.selection.hiddenNodes.empty())
    throw InputError(*diagnostics.firstLoss());
  scene.warnings = diagnostics.warnings();
  const std::vector<std::string> faults = diagnostics.warnings(true);
  if (!options.limits.strict || faults.empty()) return;
  const size_t others = faults.size() - 1;
  const std::string more = others > 0 ? ", and " + countText(others, "other warning") : "";
  throw InputError(faults[0] + " (--strict refuses it" + more + ")");
}

/// Settles what follows from where surfaces are in local space: panes, solids, what lies at one place,
/// creases.
void settleSurfaces(const std::vector<PlacedSphere>& spheres, Diagnostics& diagnostics, Scene& scene) {
  std::vector<SolidPart> parts = solidParts(scene, 0, flatTriangleCount(scene));
  warnThinned(thinOpenPanes(scene, parts), diagnostics);
  partSolids(scene, parts);
  partFromGlass(scene);
  markLampsInSurfaces(scene);
  if (scene.strokes.empty()) settleCreases(scene);  // else addStrokes() does it
  for (const PlacedSphere& sphere : spheres) {
    scene.spheres.push_back({glm::vec3(scene.space.localOf(sphere.center)),
                             float(sphere.radius / scene.space.unit), glm::quat(sphere.rotation),
                             sphere.material, sphere.node, sphere.nodeIndex});
  }
  scene.solids = solidsOf(scene);
  settleLeastAlpha(scene);
}

Scene buildScene(const std::filesystem::path& path, const GltfOptions& options,
                 std::shared_ptr<KeptDocument>* kept) {
  std::shared_ptr<KeptDocument> read = kept != nullptr ? std::move(*kept) : nullptr;
  if (!read) read = std::make_shared<KeptDocument>(readDocument(path, options));
  const bool keeps = kept != nullptr && !read->animations.empty();
  Document document = posed(*read, keeps, options);
  Scene scene;
  scene.extensionsUsed = document.root->at("extensionsUsed").get<std::vector<std::string>>();
  scene.refersToFiles = document.refersToFiles;
  scene.made = document.made;
  scene.sceneNames = document.sceneNames;
  scene.animationNames = document.animationNames;
  scene.animationSeconds = document.animationSeconds;
  scene.materialVariants = document.materialVariants;
  scene.lightSources = lightSources(document);
  const auto suns = std::ranges::count_if(options.selection.lights, &AddedLight::isSun);
  for (LightSource& source : std::span(scene.lightSources).last(size_t(suns))) source.added = true;

  // World space.
  const std::vector<PlacedNode> nodes = placeNodes(document, options.selection);
  addMaterials(document, nodes, scene);
  makeDoubleSided(options.selection.doubleSided, scene);
  scene.nodes = namedNodes(document, nodes);
  if (options.progress) options.progress("building the meshes", 0.45);
  ShownMeshes shown = showMeshes(document, scene.materials, nodes);
  if (keeps) {
    read->keyTimes = std::move(document.keyTimes);
    // The document outlives this load, so it must not keep the progress.
    read->document.progress = {};
    read->document.access.progress = {};
    *kept = std::move(read);
  } else {
    document.bytes->buffers.clear();
  }
  const std::vector<PlacedSphere> spheres = takeParts(document, nodes, options.readsVolume, scene);

  // Local space.
  const PlacedMeshes meshes =
      chooseSharing(std::move(shown.instances), options.instancing, scene.materials, document.memory.left());
  takeMeshes(document, meshes);
  scene.sharing = meshes.reason + (meshes.copies.empty() ? "" : "; always copied: " + meshes.copies);
  const bool isAsked = options.instancing == Instancing::Share;
  if (isAsked && (meshes.shared.empty() || !meshes.copies.empty()))
    document.diagnostics.warn(
        "", (meshes.shared.empty() ? "nothing is shared: " : "not all is shared: ") + scene.sharing);
  scene.bounds = boundsOf(meshes.flat, meshes.shared);
  scene.bounds.include(boundsOf(spheres));
  recentre(options, document.diagnostics, scene);
  flatten(meshes.flat, meshes.shared, scene);
  const auto defaultMaterial = uint32_t(scene.materials.size() - 1);
  settleSurfaces(spheres, document.diagnostics, scene);
  for (const PlacedNode& node : nodes) {
    if (node.hidden) continue;
    const auto light =
        document.diagnostics.keepRest("the light", [&] { return lightAt(document, node, scene.space); });
    if (light && *light) scene.lights.push_back(**light);
  }
  dropUnusedDefaultMaterial(scene, defaultMaterial);
  settle(document.diagnostics, options, scene);
  return scene;
}

}  // namespace

std::vector<double> keyTimesOf(const KeptDocument& document) {
  const std::set<double> times(document.keyTimes.begin(), document.keyTimes.end());
  return {times.begin(), times.end()};
}

Scene loadGltf(const std::filesystem::path& path, const GltfOptions& options,
               std::shared_ptr<KeptDocument>* kept) {
  try {
    return buildScene(path, options, kept);
  } catch (const InputError&) {
    throw;
  } catch (const UsageError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(path.string() + ": not enough memory to load it");
  } catch (const std::exception& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

}  // namespace fragtrace
