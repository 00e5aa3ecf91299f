// SPDX-License-Identifier: MIT
// Holds what `info` tells of a scene to somebody who has not made it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "bvh/bvh.h"
#include "cli/commands.h"
#include "gl/context.h"
#include "gltf/gltf.h"
#include "image/files/process.h"
#include "options/option_row.h"
#include "options/option_text.h"
#include "options/parse_render.h"
#include "pack/gpu_scene.h"
#include "scene/describe.h"
#include "scene/parts.h"
#include "scene/scene.h"
#include "scene/volume/read_grid.h"
#include "session/environment.h"
#include "session/setup.h"
#include "session/shutter.h"
#include "session/statistics.h"
#include "shader/render_options.h"
#include "shader/traits.h"
#include "shader/variant.h"

namespace fragtrace {

namespace {

struct TextureContents {
  const char* slot;  ///< "base colour"
  std::string name;  ///< the file's, or the place in the scene's file
  int width;
  int height;
};

struct LampContents {
  std::string name;  ///< that of the node
  const char* type;
  double intensity;
  const char* unit;
};

struct FileContents {
  std::string name;
  uint64_t bytes;
};

/// Returns what would light the scene with these options: its own light, or a word of kDefaultLightNames.
struct WhoLights {
  std::string by;    ///< "own", or that word
  std::string text;  ///< a clause
};

/// The costs of drawing the scene.
struct SceneCosts {
  BvhQuality tree;
  double bytesPerTriangle = 0.0;
  size_t volumeBytes = 0;
  TraitSet traits;
};

constexpr std::array kLampTypes{"point", "spot", "directional"};

/// "2 lamps", "1 material that shines"; empty for none.
std::string counted(size_t count, const char* one, const char* more) {
  return count == 0 ? "" : std::to_string(count) + " " + (count == 1 ? one : more);
}

/// Returns true if the picture is a file of its own.
bool isFile(const EncodedImage& image) { return image.name != image.place && !image.place.empty(); }

/// The materials, each once: some stand several times in a scene, for lines, points or open panes.
std::vector<const Material*> materialsOf(const Scene& scene) {
  std::vector<const Material*> once;
  std::set<decltype(Material::number)> numbers;
  for (const Material& material : scene.materials)
    if (numbers.insert(material.number).second) once.push_back(&material);
  return once;
}

/// The textures of a material, in the order of kTextureRefs.
std::vector<TextureContents> texturesOf(const Scene& scene, const Material& material) {
  std::vector<TextureContents> found;
  for (const TextureRefRow& row : kTextureRefs) {
    const TextureRef& reference = material.*row.ref;
    if (!reference.present()) continue;
    const uint32_t index = scene.textures[reference.texture].image;
    if (index == kMissIndex) continue;
    const EncodedImage& image = scene.images[index];
    const std::string file = std::filesystem::path(image.name).filename().string();
    found.push_back({row.name, isFile(image) ? file : image.name, image.width, image.height});
  }
  return found;
}

/// The punctual lights that nodes of the scene place.
std::vector<LampContents> lampsOf(const Scene& scene) {
  std::vector<LampContents> lamps;
  for (const Light& light : scene.lights) {
    const double intensity = scene.lightSources[light.source].intensity;
    lamps.push_back({light.node, kLampTypes[size_t(light.type)], intensity,
                     light.type == LightType::Directional ? "lx" : "cd"});
  }
  return lamps;
}

/// The scene's file and those that it refers to; one that is missing is left out.
std::vector<FileContents> filesOf(const std::filesystem::path& path, const Scene& scene) {
  std::vector<std::filesystem::path> paths{path};
  paths.insert(paths.end(), scene.made.buffers.begin(), scene.made.buffers.end());
  for (const EncodedImage& image : scene.images) {
    if (isFile(image)) paths.emplace_back(image.name);
  }
  std::vector<FileContents> files;
  for (const std::filesystem::path& file : paths) {
    std::error_code error;
    const uint64_t bytes = std::filesystem::file_size(file, error);
    const bool isNew = std::ranges::find(files, file.string(), &FileContents::name) == files.end();
    if (!error && isNew) files.push_back({file.string(), bytes});
  }
  return files;
}

WhoLights whoLights(const RenderOptions& options, const Scene& scene) {
  FileLight file;
  try {
    file = fileLightOf(options, scene, nullptr, nullptr);
  } catch (const InputError&) {  // a texture that shines and is broken
    return {"unknown", "not known, since a texture that shines cannot be decoded"};
  }
  const OwnLight light = countedLight(options, file);
  if (light == OwnLight::Enough) {
    const auto shining =
        std::ranges::count_if(materialsOf(scene), [](const Material* m) { return m->emissive(); });
    std::vector<std::string> own{counted(scene.lights.size(), "lamp", "lamps"),
                                 counted(size_t(shining), "material that shines", "materials that shine")};
    std::erase(own, "");
    return {"own", "its own: " + joined(own, " and ")};
  }
  const bool studio = options.light.defaultLight == DefaultLight::Studio;
  return {std::string(kDefaultLightNames[size_t(options.light.defaultLight)]),
          defaultLightReason(options, file) + ": `render` adds " +
              (studio ? "the studio" : "a white environment") + " (--default-light)"};
}

/// "3.1 MB", "450 kB", "12 bytes"
std::string bytesText(uint64_t bytes) {
  if (bytes < 1000) return countText(size_t(bytes), "byte");
  return bytes < 1'000'000 ? formatted("%.0f kB", double(bytes) / 1e3)
                           : formatted("%.1f MB", double(bytes) / 1e6);
}

constexpr size_t kMostListed = 40;  // materials; --verbose lists all

/// The parts that options may name: how many, and of each its index, its name and a note; nothing where there
/// is none.
void printParts(const char* what, const std::vector<std::string>& names,
                const std::vector<std::string>& notes = {}) {
  if (names.empty()) return;
  std::string list;
  for (size_t i = 0; i < names.size(); ++i) {
    const std::string note = i < notes.size() ? notes[i] : "";
    list +=
        (i == 0 ? "" : ", ") + std::to_string(i) + " " + (names[i].empty() ? "unnamed" : inQuotes(names[i]));
    if (!note.empty()) list += " (" + note + ")";
  }
  std::printf("  %-11s %zu: %s\n", what, names.size(), list.c_str());
}

void printLine(const char* what, const std::string& text) {
  if (!text.empty()) std::printf("  %-11s %s\n", what, withoutControls(text).c_str());
}

void printSize(const BoundsDouble& bounds) {
  if (bounds.empty()) return printLine("size", "nothing is drawn");
  const glm::dvec3& a = bounds.minimum;
  const glm::dvec3& b = bounds.maximum;
  const glm::dvec3 size = b - a;
  printLine("size", formatted("%.4g x %.4g x %.4g m (W x H x D), from (%g, %g, %g) to (%g, %g, %g)", size.x,
                              size.y, size.z, a.x, a.y, a.z, b.x, b.y, b.z));
}

void printMaterials(const Scene& scene, const SceneDescription& s, bool all) {
  std::vector<const Material*> materials = materialsOf(scene);
  std::erase_if(materials,
                [](const Material* m) { return m->place.empty(); });  // that which glTF has by default
  std::printf("  materials   %zu, textures %zu, images %zu (%.1f MB encoded)\n", materials.size(), s.textures,
              s.images, double(s.imageBytes) / 1e6);
  const size_t left = all ? 0 : materials.size() - std::min(materials.size(), kMostListed);
  materials.resize(materials.size() - left);
  for (const Material* material : materials) {
    const Material& m = *material;
    std::vector<std::string> textures;
    for (const TextureContents& texture : texturesOf(scene, m)) {
      const std::string size = texture.width > 0 ? formatted(" %d x %d", texture.width, texture.height) : "";
      textures.push_back(texture.slot + size + " (" + texture.name + ")");
    }
    const std::string name = m.name.empty() ? "unnamed" : inQuotes(m.name);
    std::printf("    %u %s%s\n", m.number - 1, name.c_str(),
                textures.empty() ? "" : withoutControls(": " + joined(textures)).c_str());
  }
  if (left > 0) std::printf("    and %zu more (--verbose)\n", left);
}

void printLight(const RenderOptions& options, const Scene& scene) {
  std::vector<std::string> names;
  std::vector<std::string> notes;
  for (const LampContents& lamp : lampsOf(scene)) {
    names.push_back(lamp.name);
    notes.push_back(std::string(lamp.type) + ", " + shortText(lamp.intensity) + " " + lamp.unit);
  }
  printParts("lamps", names, notes);
  printLine("light", whoLights(options, scene).text);
}

/// A duration, and the pictures of a film that shows all of it once, so that it plays without a seam.
std::string durationText(double seconds) {
  const double pictures = std::ceil(seconds * SequenceOptions{}.fps - kKeyTimeRounding);
  return formatted("%.4g s", seconds) +
         (pictures > 1.0 ? formatted(": --frames 0:%.0f", pictures - 1.0) : "");
}

const char* kindOf(const Camera& camera) { return kCameraTypeNames[size_t(camera.type)].data(); }

void printSelectable(const Scene& scene) {
  std::vector<std::string> cameras;
  std::vector<std::string> kinds;
  for (const Camera& camera : scene.cameras) {
    cameras.push_back(camera.name);
    kinds.emplace_back(kindOf(camera));
  }
  std::vector<std::string> durations;
  for (const std::optional<double>& seconds : scene.animationSeconds) {
    durations.push_back(seconds ? durationText(*seconds) : "of unknown duration");
  }
  if (cameras.empty()) std::printf("  cameras     none\n");
  printParts("cameras", cameras, kinds);
  printParts("scenes", scene.sceneNames);
  printParts("animations", scene.animationNames, durations);
  printParts("variants", scene.materialVariants);
  const VolumeSource& volume = scene.volume.source;
  if (!volume.file.empty())
    printLine("volume", volume.file.string() + (volume.grid ? ":" + *volume.grid : ""));
}

void printFiles(const std::vector<FileContents>& files) {
  std::vector<std::string> others;
  for (size_t i = 1; i < files.size(); ++i)
    others.push_back(std::filesystem::path(files[i].name).filename().string() + " " +
                     bytesText(files[i].bytes));
  printLine("refers to", joined(others));
}

/// The contents of a node, in words.
std::vector<std::string> contentsOf(const SceneNode& node) {
  std::vector<std::string> words;
  if (node.mesh) words.emplace_back("mesh");
  if (node.light) words.emplace_back("light");
  if (node.camera) words.emplace_back("camera");
  return words;
}

/// A line for each node, indented below its parent.
void printNodes(const std::vector<SceneNode>& nodes) {
  std::printf("  nodes       %zu\n", nodes.size());
  for (const SceneNode& node : nodes) {
    std::string notes = node.hidden ? ", hidden" : "";
    for (const std::string& word : contentsOf(node)) notes += ", " + word;
    std::printf("    %*s%u %s%s\n", 2 * node.depth, "", node.index, inQuotes(node.name).c_str(),
                notes.c_str());
  }
}

/// The scene as somebody sees it who has not made it.
void printContents(const RenderOptions& options, const Scene& scene, const SceneDescription& s) {
  const std::vector<FileContents> files = filesOf(options.scene, scene);
  std::printf("%s%s\n", options.scene.string().c_str(),
              files.empty() ? "" : (" (" + bytesText(files.front().bytes) + ")").c_str());
  printSize(s.bounds);
  std::printf("  triangles   %zu (%zu emissive), vertices %zu, spheres %zu\n", s.triangles,
              s.emissiveTriangles, s.vertices, s.spheres);
  if (s.points + s.lines > 0)
    std::printf("  lines       %zu points, %zu line segments (as solids of --line-width pixels)\n", s.points,
                s.lines);
  printMaterials(scene, s, options.output.verbose);
  printLight(options, scene);
  printSelectable(scene);
  printLine("extensions", joined(s.extensionsUsed));
  printLine("made by", scene.made.generator);
  printLine("copyright", scene.made.copyright);
  printFiles(files);
}

void printCosts(const SceneDescription& s, const SceneCosts& costs) {
  const BvhQuality& tree = costs.tree;
  std::printf("  tree        %u nodes, %u leaves, depth %u, %.2f primitives per leaf, SAH cost %.2f\n",
              tree.nodeCount, tree.leafCount, tree.depth, tree.primitivesPerLeaf, tree.sahCost);
  const double geometry = costs.bytesPerTriangle * double(s.triangles);
  if (s.sharedMeshes > 0)
    std::printf(
        "  shared      %zu meshes in %zu instances, %zu triangles drawn; %u nodes are theirs, %u above "
        "them\n",
        s.sharedMeshes, s.sharedInstances, s.trianglesDrawn, tree.meshNodeCount,
        tree.nodeCount - tree.meshNodeCount);
  std::printf("  instancing  %s\n", s.sharing.c_str());
  std::printf("  GPU memory  %.1f MB: geometry %.1f",
              (geometry + double(s.texelBytes) + double(costs.volumeBytes)) / 1e6, geometry / 1e6);
  if (s.triangles > 0) std::printf(" (%.1f bytes per triangle)", costs.bytesPerTriangle);
  std::printf(", textures %.1f", double(s.texelBytes) / 1e6);
  if (costs.volumeBytes > 0) std::printf(", volume %.1f", double(costs.volumeBytes) / 1e6);
  std::printf("\n");
  for (const StageRow& row : stageRows()) {
    const std::string reason = whyOff(row.stage, costs.traits);
    if (!reason.empty()) std::printf("  not needed  %s (%s)\n", row.name, reason.c_str());
  }
}

struct InfoOptions {
  RawRender raw;  ///< read are the file, and the options of reading it
  bool json = false;
  bool nodes = false;
  bool decode = false;
  bool devices = false;
};

/// The bytes a triangle that a scene takes on the device by default, without textures and lights.
double gpuBytesPerTriangle(const Scene& scene, const Bvh& bvh, const TraitSet& traits,
                           Surroundings surroundings) {
  ShaderVariant variant = chooseVariant({}, traits, surroundings, bvh.stackNeed, BufferReads::Auto);
  for (uint32_t slot = 0; slot < layout::kSlotCount; ++slot) variant.traits.reset(size_t(slotTrait(slot)));
  for (const Trait t : {Trait::EmissiveTriangles, Trait::PunctualLights, Trait::Environment})
    variant.traits.reset(size_t(t));
  return double(packScene(scene, bvh, {}, variant).geometryBytes()) / double(scene.triangles.size());
}

/// Adds what the text has of the scene's parts.
void addParts(nlohmann::ordered_json& json, const Scene& scene) {
  json["scene_names"] = scene.sceneNames;
  json["animation_names"] = scene.animationNames;
  json["animations"] = nlohmann::ordered_json::array();
  for (size_t i = 0; i < scene.animationNames.size(); ++i) {
    nlohmann::ordered_json animation = {{"name", scene.animationNames[i]}, {"duration_s", nullptr}};
    if (scene.animationSeconds[i]) animation["duration_s"] = *scene.animationSeconds[i];
    json["animations"].push_back(std::move(animation));
  }
  json["cameras"] = nlohmann::ordered_json::array();
  for (const Camera& camera : scene.cameras)
    json["cameras"].push_back({{"name", camera.name}, {"type", kindOf(camera)}});
  json["material_variants"] = scene.materialVariants;
  if (!scene.volume.source.file.empty()) json["volume"] = scene.volume.source.file.string();
}

SceneCosts costsOf(const Scene& scene) {
  const Bvh tree = buildSceneBvh(scene);
  const Surroundings surroundings = hasOwnLight(scene) ? Surroundings::None : Surroundings::Map;
  SceneCosts costs{.tree = bvhQuality(tree), .traits = traitsOf(scene, surroundings)};
  if (!scene.triangles.empty())
    costs.bytesPerTriangle = gpuBytesPerTriangle(scene, tree, costs.traits, surroundings);
  if (scene.volume.grid) costs.volumeBytes = texelsOf(*scene.volume.grid) * sizeof(glm::uvec2);
  return costs;
}

nlohmann::ordered_json nodesJson(const std::vector<SceneNode>& nodes) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const SceneNode& node : nodes)
    json.push_back({{"index", node.index},
                    {"name", node.name},
                    {"depth", node.depth},
                    {"hidden", node.hidden},
                    {"contents", contentsOf(node)}});
  return json;
}

/// Adds what the text has for a reader.
void addContents(nlohmann::ordered_json& json, const RenderOptions& options, const Scene& scene,
                 const BoundsDouble& bounds) {
  json["size"] = nullptr;
  if (!bounds.empty()) {
    const glm::dvec3 size = bounds.maximum - bounds.minimum;
    json["size"] = {size.x, size.y, size.z};
  }
  json["materials"] = nlohmann::ordered_json::array();
  for (const Material* m : materialsOf(scene)) {
    nlohmann::ordered_json textures = nlohmann::ordered_json::array();
    for (const TextureContents& t : texturesOf(scene, *m))
      textures.push_back({{"slot", t.slot}, {"name", t.name}, {"width", t.width}, {"height", t.height}});
    json["materials"].push_back({{"name", m->name}, {"textures", textures}});
  }
  json["lamps"] = nlohmann::ordered_json::array();
  for (const LampContents& lamp : lampsOf(scene))
    json["lamps"].push_back(
        {{"name", lamp.name}, {"type", lamp.type}, {"intensity", lamp.intensity}, {"unit", lamp.unit}});
  json["lit_by"] = whoLights(options, scene).by;
  json["generator"] = scene.made.generator;
  json["copyright"] = scene.made.copyright;
  json["files"] = nlohmann::ordered_json::array();
  for (const FileContents& file : filesOf(options.scene, scene))
    json["files"].push_back({{"name", file.name}, {"bytes", file.bytes}});
}

/// The grids of a volume's file.
int informOfVolume(const InfoOptions& options) {
  const std::filesystem::path& path = options.raw.options.scene;
  nlohmann::ordered_json json = {
      {"schema", 1}, {"file", path.string()}, {"grids", nlohmann::ordered_json::array()}};
  if (!options.json) std::printf("%s\n", path.string().c_str());
  for (const GridDescription& grid : listGrids(path, options.raw.options.limits.memoryBytes)) {
    const glm::ivec3& v = grid.voxels;
    if (!options.json)
      std::printf("  grid        %s (%s%s), %d x %d x %d voxels, %s active\n", inQuotes(grid.name).c_str(),
                  grid.type.c_str(), grid.isDensity ? "" : ", no densities", v.x, v.y, v.z,
                  std::to_string(grid.activeVoxels).c_str());
    const glm::dvec3& a = grid.box.minimum;
    const glm::dvec3& b = grid.box.maximum;
    if (!options.json && !grid.box.empty()) {
      std::printf("              (%g, %g, %g) to (%g, %g, %g), values up to %g\n", a.x, a.y, a.z, b.x, b.y,
                  b.z, grid.largest);
    }
    json["grids"].push_back({{"name", grid.name},
                             {"type", grid.type},
                             {"density", grid.isDensity},
                             {"voxels", {v.x, v.y, v.z}},
                             {"active_voxels", grid.activeVoxels},
                             {"largest", grid.largest}});
    if (!grid.box.empty())
      json["grids"].back()["bounds"] = {{"min", {a.x, a.y, a.z}}, {"max", {b.x, b.y, b.z}}};
  }
  if (options.json) std::cout << jsonText(json);
  return 0;
}

int inform(const InfoOptions& options) {
  const RenderOptions& render = options.raw.options;
  if (render.scene.extension() == ".nvdb") return informOfVolume(options);
  GltfOptions loading;
  loading.selection = render.selection;
  loading.instancing = render.device.instancing;
  loading.limits = render.limits;
  Scene scene = loadGltf(render.scene, loading);
  placeVolume(scene, render, nullptr);
  for (const std::string& odd : {whyEmpty(scene, loading.selection), strayNode(scene)}) {
    if (!odd.empty()) scene.warnings.push_back(render.scene.string() + ": " + odd);
  }
  if (options.decode) {
    std::vector<EncodedPicture> pictures;
    for (const EncodedImage& image : scene.images) pictures.push_back({image.bytes, nameOf(image)});
    for (std::string& error : decodeEach(pictures, [](size_t, const TexelImage&) {})) {
      if (error.empty()) continue;
      if (!loading.limits.drawMissingTextures || loading.limits.strict) throw InputError(error);
      scene.warnings.push_back(std::move(error));
    }
  }
  const SceneDescription description = describe(scene);
  for (const std::string& warning : scene.warnings) std::cerr << "fragtrace: warning: " << warning << '\n';
  if (!options.json) {
    printContents(render, scene, description);
    if (render.output.verbose) printCosts(description, costsOf(scene));
    if (options.nodes) printNodes(scene.nodes);
    return 0;
  }
  const SceneCosts costs = costsOf(scene);
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["file"] = render.scene.string();
  json["scene"] = sceneJson(description);
  json["bvh"] = bvhJson(costs.tree);
  if (costs.bytesPerTriangle > 0.0) json["gpu_bytes_per_triangle"] = costs.bytesPerTriangle;
  json["texture_bytes"] = description.texelBytes;
  if (costs.volumeBytes > 0) json["volume_bytes"] = costs.volumeBytes;
  nlohmann::ordered_json notNeeded = nlohmann::ordered_json::object();
  for (const StageRow& row : stageRows()) {
    const std::string reason = whyOff(row.stage, costs.traits);
    if (!reason.empty()) notNeeded[row.name] = reason;
  }
  json["not_needed"] = notNeeded;
  nlohmann::ordered_json materials = nlohmann::ordered_json::array();
  for (const Material* m : materialsOf(scene)) materials.push_back(m->name);
  json["material_names"] = materials;
  addParts(json, scene);
  addContents(json, render, scene, description.bounds);
  if (options.nodes) json["nodes"] = nodesJson(scene.nodes);
  json["warnings"] = scene.warnings;
  std::cout << jsonText(json);
  return 0;
}

/// Lists the devices that --device chooses from.
int tellDevices(bool asJson) {
  const std::vector<ListedDevice> devices = listDevices();
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (size_t i = 0; i < devices.size(); ++i) {
    const ListedDevice& device = devices[i];
    const bool works = device.reason.empty();
    json.push_back({{"number", i}, {"name", device.renderer}, {"place", device.name}});
    if (!works) json.back()["error"] = device.reason;
    if (!asJson)
      std::cout << i << ": " << (works ? device.renderer : "does not work: " + device.reason) << " ("
                << device.name << ")\n";
  }
  if (asJson) std::cout << jsonText({{"schema", 1}, {"devices", json}});
  if (devices.empty() && !asJson) std::cout << "EGL has no devices\n";
  return 0;
}

int runInfo(const InfoOptions& options) {
  if (options.devices) return tellDevices(options.json);
  if (options.raw.options.scene.empty()) throw UsageError("file is required");
  try {
    return inform(options);
  } catch (const std::exception& error) {
    if (options.json) {
      const nlohmann::ordered_json json = {
          {"schema", 1}, {"file", options.raw.options.scene.string()}, {"error", error.what()}};
      std::cout << jsonText(json);
    }
    throw;
  }
}

}  // namespace

RunCommand addInfo(CLI::App& app) {
  const auto options = std::make_shared<InfoOptions>();
  addOption(app, "file", options->raw);
  app.add_flag("--json", options->json, "print one JSON object");
  app.add_flag("--nodes", options->nodes, "also list the nodes of the scene");
  app.add_flag("--devices", options->devices, "list the devices that --device chooses from, and no scene");
  app.add_flag("--decode", options->decode, "also decode the textures, so that a broken one is an error");
  for (const OptionRow& row : inputRows()) addOption(app, row.name, options->raw);
  addOption(app, "--instancing", options->raw);
  addOption(app, "--verbose", options->raw,
            "also print the tree and what it costs, and all materials of a file with many");
  return [options] { return runInfo(*options); };
}

}  // namespace fragtrace
