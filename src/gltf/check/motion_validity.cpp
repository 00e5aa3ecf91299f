// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "gltf/read/component_types.h"
#include "gltf/read/json_parts.h"
#include "gltf/read/motion.h"

namespace fragtrace {
namespace {

using nlohmann::json;

/// The places of nodes in their trees. A node in a loop, which is refused later, stands alone.
struct Ancestry {
  std::vector<size_t> root;         ///< root of each node
  std::vector<size_t> first, last;  ///< the nodes below a node have the numbers from its first to its last

  bool isAbove(size_t node, size_t other) const {
    return first[node] <= first[other] && first[other] <= last[node];
  }
};

Ancestry ancestryOf(const json& nodes) {
  const size_t count = nodes.size();
  std::vector<bool> isChild(count, false);
  for (const json& node : nodes) {
    for (const json& child : memberOf(node, "children")) isChild[child.get<size_t>()] = true;
  }
  Ancestry ancestry;
  ancestry.first.assign(count, count);
  ancestry.last.assign(count, count);
  for (size_t i = 0; i < count; ++i) ancestry.root.push_back(i);
  size_t number = 0;
  std::vector<std::pair<size_t, size_t>> open;  // a node, and how many of its children have been visited
  const auto enter = [&](size_t node, size_t root) {
    ancestry.first[node] = number++;
    ancestry.root[node] = root;
    open.emplace_back(node, 0);
  };
  for (size_t root = 0; root < count; ++root) {
    if (isChild[root]) continue;
    enter(root, root);
    while (!open.empty()) {
      auto& [node, visited] = open.back();
      const json& children = memberOf(nodes[node], "children");
      if (visited == children.size()) {
        ancestry.last[node] = number - 1;
        open.pop_back();
        continue;
      }
      const auto child = children[visited++].get<size_t>();
      if (ancestry.first[child] == count) enter(child, root);
    }
  }
  return ancestry;
}

/// Returns true if it is a path of a node (glTF 2.0, section 3.11).
bool isPath(std::string_view path) {
  return path == "translation" || path == "rotation" || path == "scale" || path == "weights";
}

class MotionChecker {
 public:
  MotionChecker(const json& root, Diagnostics& diagnostics) : root_(root), diagnostics_(diagnostics) {}

  void check() {
    forEachIn(root_, "nodes", [this](const json& node, const std::string& place) { checkNode(node, place); });
    if (root_.contains("skins")) ancestry_ = ancestryOf(memberOf(root_, "nodes"));
    forEachIn(root_, "skins", [this](const json& skin, const std::string& place) { checkSkin(skin, place); });
    forEachIn(root_, "animations",
              [this](const json& animation, const std::string& place) { checkAnimation(animation, place); });
    forEachIn(root_, "meshes",
              [this](const json& mesh, const std::string& place) { checkVariants(mesh, place); });
  }

 private:
  void warn(const std::string& place, const std::string& reason) { diagnostics_.warn(place, reason); }

  const json& accessorAt(const json& index) const { return elementOf(root_, "accessors", index); }

  /// The number of morph targets of a mesh's first primitive; the others must have as many.
  static size_t targetsOf(const json& mesh) {
    const json& primitives = memberOf(mesh, "primitives");
    return primitives.empty() ? 0 : memberOf(primitives[0], "targets").size();
  }

  void warnStride(const json& accessor, const std::string& place) {
    if (elementOf(root_, "bufferViews", memberOf(accessor, "bufferView")).contains("byteStride"))
      warn(place, "byteStride is for vertex attributes only; it is applied all the same");
  }

  void checkNode(const json& node, const std::string& place) {
    const json& mesh = elementOf(root_, "meshes", memberOf(node, "mesh"));
    if (mesh.empty()) return;
    if (node.contains("weights") && !node["weights"].empty() && node["weights"].size() != targetsOf(mesh))
      warn(place + "/weights",
           "are not as many as the mesh's morph targets; what is missing is 0, the rest is ignored");
    if (!node.contains("skin")) return;
    for (const json& primitive : mesh["primitives"]) {
      if (!primitive["attributes"].contains("JOINTS_0"))
        warn(place + "/skin", "has a mesh without joints, which stands where its node does");
    }
  }

  void checkSkin(const json& skin, const std::string& place) {
    const json& joints = skin["joints"];
    const json& matrices = accessorAt(memberOf(skin, "inverseBindMatrices"));
    if (!matrices.empty()) {
      const std::string there = place + "/inverseBindMatrices";
      if (matrices["type"] != "MAT4" || matrices["componentType"] != kFloat)
        warn(there, "are not floats of type MAT4, which is refused where a node has the skin");
      if (matrices["count"].get<size_t>() < joints.size())
        warn(there, "are fewer than the joints, which is refused where a node has the skin");
      warnStride(matrices, there);
    }
    if (joints.empty()) return;
    std::set<size_t> seen;
    size_t strangers = 0;
    size_t notBelow = 0;
    const json& skeleton = memberOf(skin, "skeleton");
    for (const json& joint : joints) {
      const auto node = joint.get<size_t>();
      if (!seen.insert(node).second)
        warn(place + "/joints", "names a node twice; each is a joint of its own");
      strangers += ancestry_.root[node] != ancestry_.root[joints[0].get<size_t>()];
      notBelow += skeleton.is_number_unsigned() && !ancestry_.isAbove(skeleton.get<size_t>(), node);
    }
    if (strangers > 0) warn(place + "/joints", "have no common root; each is placed where it stands");
    if (notBelow > 0) warn(place + "/skeleton", "is not above all of the joints, and not needed");
  }

  void checkAnimation(const json& animation, const std::string& place) {
    const json& samplers = animation["samplers"];
    for (size_t i = 0; i < samplers.size(); ++i)
      checkSampler(samplers[i], place + "/samplers/" + std::to_string(i));
    std::map<std::string, size_t> targets;
    const json& channels = animation["channels"];
    for (size_t i = 0; i < channels.size(); ++i) {
      const std::string there = place + "/channels/" + std::to_string(i);
      const auto sampler = channels[i]["sampler"].get<size_t>();
      if (sampler >= samplers.size()) {
        diagnostics_.refuse(there + "/sampler", "index " + std::to_string(sampler) + " is past the " +
                                                    std::to_string(samplers.size()) + " samplers");
      }
      checkTarget(channels[i]["target"], there + "/target");
      const auto [first, isFirst] = targets.try_emplace(channels[i]["target"].dump(), i);
      if (!isFirst && channels[i]["target"].contains("node"))
        warn(place + pointerTo("channels", first->second, "target"), "is overruled by a later channel");
      checkOutput(channels[i]["target"], samplers[sampler], there + "/sampler");
    }
  }

  void checkSampler(const json& sampler, const std::string& place) {
    const json& input = accessorAt(sampler["input"]);
    const std::string interpolation = sampler.value("interpolation", "LINEAR");
    const bool isCubic = interpolation == "CUBICSPLINE";
    if (!isCubic && interpolation != "LINEAR" && interpolation != "STEP")
      warn(place + "/interpolation",
           inQuotes(interpolation) +
               " is no interpolation, which is refused where the animation is asked for");
    if (input["type"] != "SCALAR" || input["componentType"] != kFloat)
      warn(place + "/input",
           "is not of floats of type SCALAR, which is refused where the animation is asked for");
    if (isCubic && input["count"].get<size_t>() < 2)
      warn(place + "/input",
           "has too few keys for a spline, which needs two; it is refused where the animation is asked for");
    warnStride(input, place + "/input");
    warnStride(accessorAt(sampler["output"]), place + "/output");
  }

  void checkTarget(const json& target, const std::string& place) {
    const json& node = elementOf(root_, "nodes", memberOf(target, "node"));
    const auto& path = target["path"].get_ref<const std::string&>();
    const json& pointer = memberOf(memberOf(target, "extensions"), "KHR_animation_pointer");
    if (!pointer.is_null()) {
      if (path != "pointer")
        warn(place, "has a pointer, for which its path must be \"pointer\"; the pointer is ignored");
      if (target.contains("node")) warn(place, "has both a pointer and a node; the channel is ignored");
      if (pointer["pointer"].get_ref<const std::string&>().empty())
        warn(place, "is nothing that can be animated; the channel is ignored");
      return;
    }
    const bool isKnown = isPath(path);
    if (!isKnown)
      warn(place + "/path", inQuotes(path) + " is nothing that can be animated; the channel is ignored");
    if (!target.contains("node")) {
      if (isKnown) warn(place, "has no node; the channel is ignored");
      return;
    }
    if (node.contains("matrix") && path != "weights")
      warn(place, "has a node with a matrix, which an animation cannot change; the matrix counts");
    if (path == "weights" && targetsOf(elementOf(root_, "meshes", memberOf(node, "mesh"))) == 0)
      warn(place, "has a node without morph targets, which nothing would weigh; it changes nothing");
  }

  /// Checks sizes and types that follow from the channel's path (glTF 2.0, section 3.11).
  void checkOutput(const json& target, const json& sampler, const std::string& place) {
    if (!target.contains("node") || !isPath(target["path"].get_ref<const std::string&>())) return;
    const json& output = accessorAt(sampler["output"]);
    const auto& path = target["path"].get_ref<const std::string&>();
    const std::string type = path == "weights" ? "SCALAR" : path == "rotation" ? "VEC4" : "VEC3";
    const bool mayBeInteger = path == "rotation" || path == "weights";
    if (output["type"] != type ||
        (output["componentType"] != kFloat && !(mayBeInteger && output.value("normalized", false))))
      warn(place,
           "has an output of a type that glTF does not allow for its target; it is refused where the "
           "animation is asked for");
    const json& node = elementOf(root_, "nodes", target["node"]);
    const size_t width =
        path == "weights" ? targetsOf(elementOf(root_, "meshes", memberOf(node, "mesh"))) : 1;
    const size_t keys = accessorAt(sampler["input"])["count"].get<size_t>() *
                        (sampler.value("interpolation", "") == "CUBICSPLINE" ? 3 : 1);
    if (width > 0 && output["count"].get<size_t>() != keys * width)
      warn(place,
           "has an output of another number of elements than its keys need, which is refused where the "
           "animation is asked for");
  }

  void checkVariants(const json& mesh, const std::string& place) {
    const json& primitives = mesh["primitives"];
    for (size_t i = 0; i < primitives.size(); ++i) {
      const json& mappings =
          memberOf(memberOf(memberOf(primitives[i], "extensions"), "KHR_materials_variants"), "mappings");
      std::set<size_t> seen;
      for (size_t m = 0; m < mappings.size(); ++m) {
        for (const json& variant : mappings[m]["variants"]) {
          if (seen.insert(variant.get<size_t>()).second) continue;
          warn(place + pointerTo("primitives", i, "extensions", "KHR_materials_variants", "mappings", m,
                                 "variants"),
               "names a variant twice, and the first material counts");
        }
      }
    }
  }

  const json& root_;
  Diagnostics& diagnostics_;
  Ancestry ancestry_;
};

}  // namespace

void checkMotion(const json& root, Diagnostics& diagnostics) { MotionChecker(root, diagnostics).check(); }

}  // namespace fragtrace
