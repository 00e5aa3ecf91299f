// SPDX-License-Identifier: MIT
#include "cli/info_text.h"

#include <cmath>
#include <cstdio>

#include "base/text.h"
#include "cli/info_contents.h"
#include "scene/parts.h"
#include "shader/variant.h"

namespace fragtrace {

namespace {

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
  constexpr double kRounding = 1e-4;  // key times are floats
  const double pictures = std::ceil(seconds * SequenceOptions{}.fps - kRounding);
  return formatted("%.4g s", seconds) +
         (pictures > 1.0 ? formatted(": --frames 0:%.0f", pictures - 1.0) : "");
}

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

}  // namespace

const char* kindOf(const Camera& camera) { return kCameraTypeNames[size_t(camera.type)].data(); }

std::vector<std::string> contentsOf(const SceneNode& node) {
  std::vector<std::string> words;
  if (node.mesh) words.emplace_back("mesh");
  if (node.light) words.emplace_back("light");
  if (node.camera) words.emplace_back("camera");
  return words;
}

void printNodes(const std::vector<SceneNode>& nodes) {
  std::printf("  nodes       %zu\n", nodes.size());
  for (const SceneNode& node : nodes) {
    std::string notes = node.hidden ? ", hidden" : "";
    for (const std::string& word : contentsOf(node)) notes += ", " + word;
    std::printf("    %*s%u %s%s\n", 2 * node.depth, "", node.index, inQuotes(node.name).c_str(),
                notes.c_str());
  }
}

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

}  // namespace fragtrace
