// SPDX-License-Identifier: MIT
#include "gltf/check/schema.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "gltf/check/extensions.h"
#include "gltf/check/use.h"

namespace fragtrace {

namespace {

using nlohmann::json;

constexpr LostObject kLostObjects[] = {
    {"/buffers/*", "the buffer", R"({"byteLength": 0})"},
    {"/bufferViews/*", "the buffer view", R"({"buffer": 0, "byteLength": 0})"},
    {"/accessors/*", "the accessor", R"({"componentType": 5126, "count": 0, "type": "SCALAR"})"},
    {"/images/*", "the picture", "{}"},
    {"/samplers/*", "the sampler", "{}"},
    {"/textures/*", "the texture", "{}"},
    {"/materials/*", "the material", "{}"},
    {"/meshes/*", "the mesh", R"({"primitives": []})"},
    {"/meshes/*/primitives/*", "the primitive", R"({"attributes": {}})"},
    {"/meshes/*/primitives/*/targets/*", "the target", "{}"},
    {"/cameras/*", "the camera", R"({"type": "perspective", "perspective": {"yfov": 1, "znear": 1}})",
     "/camera"},
    {"/extensions/KHR_lights_punctual/lights/*", "the light", R"({"type": "point"})",
     "/extensions/KHR_lights_punctual/light"},
    {"/extensions/KHR_implicit_shapes/shapes/*", "the shape", R"({"type": ""})"},
    {"/extensions/KHR_materials_variants/variants/*", "the variant", R"({"name": ""})"},
    {"/nodes/*", "the node", "{}"},
    {"/skins/*", "the skin", R"({"joints": []})", "/skin"},
    {"/animations/*", "the animation", R"({"channels": [], "samplers": []})"},
    {"/animations/*/samplers/*", "the channel", R"({"interpolation": ""})"},
    {"/animations/*/channels/*", "the channel", R"({"sampler": 0, "target": {"path": ""}})"},
    {"/scenes/*", "the scene", "{}"},
};

}  // namespace

const LostObject* lostObjectAt(std::string_view pattern) {
  const auto* found = std::ranges::find(kLostObjects, pattern, &LostObject::pattern);
  return found == std::end(kLostObjects) ? nullptr : found;
}

void loseObject(json& root, const LostObject& object, const std::string& place, const Loss& loss,
                const IsUsed& isUsed, Diagnostics& diagnostics) {
  const bool isSeen = isUsed(place) && !place.starts_with("/animations/");  // what does not move is drawn
  diagnostics.warnLoss(loss.place, loss.reason, object.name, isSeen);
  diagnostics.noteLost(place);
  root[json::json_pointer(place)] = json::parse(object.empty);
  if (object.reference == nullptr || !root.contains("nodes") || !root["nodes"].is_array()) return;
  const json::json_pointer reference(object.reference);
  const std::string index = place.substr(place.rfind('/') + 1);
  // A light's extension cannot do without the light.
  const json::json_pointer holder = reference.parent_pointer();
  const json::json_pointer erased = holder.empty() ? reference : holder;
  for (json& node : root["nodes"]) {
    if (node.is_object() && node.contains(reference) && node[reference].dump() == index)
      node[erased.parent_pointer()].erase(erased.back());
  }
}

namespace {

/// Members without which what holds them would be read as something else.
bool isIndispensable(std::string_view pattern) {
  return pattern.starts_with("/accessors/*/") || pattern.starts_with("/bufferViews/*/") ||
         pattern == "/animations/*/samplers/*/interpolation" || pattern == "/cameras/*/orthographic" ||
         pattern == "/cameras/*/perspective" ||
         pattern == "/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression";
}

class Checker {
 public:
  Checker(const Rule& rule, json& root, const SchemaContext& context)
      : rule_(rule), root_(root), context_(context) {
    std::string_view pattern = rule.pattern;
    required_ = pattern.ends_with('!');
    if (required_) pattern.remove_suffix(1);
    pattern_ = pattern;
    targetSize_ = rule.kind == Kind::Index ? arraySize(rule.target) : 0;
  }

  void apply() {
    if (!descend(root_, pattern_)) context_.diagnostics.refuse(faultPlace_, fault_);
  }

 private:
  size_t arraySize(const char* target) const {
    const json::json_pointer pointer(target);
    return root_.contains(pointer) && root_[pointer].is_array() ? root_[pointer].size() : 0;
  }

  /// Notes a fault at the place, and returns false.
  bool note(const std::string& reason) {
    fault_ = reason;
    faultPlace_ = place();
    return false;
  }

  /// Of the value that is looked at: its JSON pointer.
  std::string place() const {
    std::string pointer;
    for (const Step& step : steps_)
      pointer += step.name.data() != nullptr ? pointerTo(step.name) : pointerTo(step.index);
    return pointer;
  }

  void warn(const std::string& consequence) { context_.diagnostics.warn(faultPlace_, fault_ + consequence); }

  /// A member or an element on the way from the root. Files have a hundred thousand values, and each rule
  /// looks at them: pointers are made of steps where one is told.
  struct Step {
    std::string_view name;  ///< null: an element
    size_t index = 0;
  };

  bool visit(json& value, Step step, std::string_view rest) {
    steps_.push_back(step);
    const bool stays = rest.empty() ? check(value) : descend(value, rest);
    steps_.pop_back();
    return stays;
  }

  /// Returns false if the value cannot stay.
  bool descend(json& value, std::string_view pattern) {
    const size_t end = std::min(pattern.find('/', 1), pattern.size());
    const std::string_view name = pattern.substr(1, end - 1);
    const std::string_view rest = pattern.substr(end);
    const std::string_view here = pattern_.substr(0, pattern_.size() - rest.size());
    if (name == "*") return value.is_array() ? descendArray(value, rest, here) : descendMembers(value, rest);
    if (!value.is_object()) return true;
    const auto member = value.find(name);
    if (member == value.end())
      return !rest.empty() || !required_ || note(inQuotes(std::string(name)) + " is missing");
    if (visit(*member, {name}, rest)) return true;
    const bool isNeeded = (rest.empty() && required_) || context_.isRequired(here) || isIndispensable(here);
    if (isNeeded) return false;
    value.erase(member);
    warn("; it is taken as absent");
    return true;
  }

  bool descendArray(json& array, std::string_view rest, std::string_view here) {
    const LostObject* object = lostObjectAt(here);
    const bool mayBeLost = object != nullptr && context_.diagnostics.hasLost();
    for (size_t i = 0; i < array.size(); ++i) {
      if (mayBeLost && context_.diagnostics.isLost(place() + pointerTo(i))) continue;
      if (visit(array[i], {{}, i}, rest)) continue;
      if (object != nullptr) {
        loseObject(root_, *object, place() + pointerTo(i), {"", faultPlace_, fault_}, context_.isUsed,
                   context_.diagnostics);
      } else if (mayLoseElements(here)) {
        array.erase(i--);
        warn("; it is taken as absent");
      } else {
        return false;
      }
    }
    return true;
  }

  /// References whose number and order mean nothing.
  static bool mayLoseElements(std::string_view here) {
    return here == "/nodes/*/children/*" || here == "/scenes/*/nodes/*";
  }

  bool descendMembers(json& object, std::string_view rest) {
    if (!object.is_object()) return true;
    for (auto member = object.begin(); member != object.end();) {
      const bool stays = visit(member.value(), {member.key()}, rest);
      if (!stays) warn("; it is taken as absent");
      member = stays ? std::next(member) : object.erase(member);
    }
    return true;
  }

  bool check(json& value) {
    if (value.is_null()) return note("is null");
    switch (rule_.kind) {
      case Kind::Object:
        return value.is_object() || note("is not an object");
      case Kind::Array:
        return value.is_array() || note("is not an array");
      case Kind::Objects:
        return checkObjects(value);
      case Kind::Text:
        return value.is_string() || note("is not a string");
      case Kind::Word:
        return checkWord(value);
      case Kind::Texts:
        return isOfEach(value, &json::is_string) || note("is not an array of strings");
      case Kind::Flag:
        return value.is_boolean() || note("is not true or false");
      case Kind::Number:
        return value.is_number() || note("is not a number");
      case Kind::Numbers:
        if (!isOfEach(value, &json::is_number)) return note("is not an array of numbers");
        return rule_.size == 0 || value.size() == rule_.size ||
               note("does not hold " + std::to_string(rule_.size) + " numbers");
      case Kind::Int:
        return checkWhole(value, uint64_t(std::numeric_limits<int32_t>::max()));
      case Kind::Size:
        return checkWhole(value, uint64_t(1) << 53);
      case Kind::Index:
        return checkIndex(value);
    }
    return true;
  }

  static bool isOfEach(const json& value, bool (json::*isRight)() const noexcept) {
    return value.is_array() && std::ranges::all_of(value, [&](const json& e) { return (e.*isRight)(); });
  }

  bool checkWord(json& value) {
    if (!value.is_string()) return note("is not a string");
    const std::string given = value;
    const std::string_view rule = rule_.target;
    const size_t colon = rule.find(':');
    const auto words = wordsIn(rule.substr(colon + 2));
    const auto word =
        std::ranges::find_if(words, [&](std::string_view one) { return isSameButForCase(one, given); });
    const std::string is = inQuotes(given) + " is ";
    const std::string isNone = is + "no " + std::string(rule.substr(0, colon));
    const bool isKnown = word != words.end();
    if (!isKnown && (required_ || isIndispensable(pattern_))) return note(isNone);
    value = isKnown ? *word : words.front();
    if (value != given)
      context_.diagnostics.warn(place(),
                                (isKnown ? is : isNone + "; it is ") + "read as " + std::string(value));
    return true;
  }

  /// Elements that are no objects become ones without content.
  bool checkObjects(json& value) {
    if (!value.is_array()) return note("is not an array of objects");
    const LostObject* object = lostObjectAt(std::string(pattern_) + "/*");
    for (size_t i = 0; i < value.size(); ++i) {
      if (value[i].is_object()) continue;
      if (object == nullptr) return note("is not an array of objects");
      const std::string place = this->place() + pointerTo(i);
      const std::string is = value[i].is_null() ? "is null" : "is not an object";
      if (std::string_view(object->empty) == "{}") {
        context_.diagnostics.warn(place, is + ", and taken as one without members");
        context_.diagnostics.noteLost(place);
        value[i] = json::object();
      } else {
        loseObject(root_, *object, place, {"", place, is}, context_.isUsed, context_.diagnostics);
      }
    }
    return true;
  }

  bool checkWhole(json& value, uint64_t largest) {
    if (value.is_number_float()) {
      const double number = value.get<double>();
      if (number >= 0.0 && number <= double(largest) && number == std::floor(number))
        value = uint64_t(number);
    }
    if (!value.is_number_unsigned()) return note("is not a non-negative integer");
    return value.get<uint64_t>() <= largest || note("is too large");
  }

  bool checkIndex(json& value) {
    bool isIndex = checkWhole(value, uint64_t(std::numeric_limits<int32_t>::max()));
    if (isIndex && value.get<uint64_t>() >= targetSize_) {
      isIndex = note("index " + value.dump() + " is past the " + std::to_string(targetSize_) +
                     " elements of " + rule_.target);
    }
    if (!isIndex && context_.isUsed(place())) context_.diagnostics.refuse(faultPlace_, fault_);
    return isIndex;
  }

  Rule rule_;
  json& root_;
  const SchemaContext& context_;
  bool required_ = false;
  std::string_view pattern_;
  size_t targetSize_ = 0;
  std::vector<Step> steps_;
  std::string fault_;       ///< the reason why a value cannot stay
  std::string faultPlace_;  ///< its place
};

}  // namespace

void applyRule(const Rule& rule, json& root, const SchemaContext& context) {
  Checker(rule, root, context).apply();
}

std::string_view cutPart(std::string_view& pointer) {
  pointer.remove_prefix(1);
  const size_t end = std::min(pointer.find('/'), pointer.size());
  const std::string_view part = pointer.substr(0, end);
  pointer.remove_prefix(end);
  return part;
}

namespace {

/// Rules for what the loader reads. Containers without a rule of their own are objects.
constexpr Rule kRules[] = {
    {"/asset!", Kind::Object},
    {"/asset/version!", Kind::Text},
    {"/asset/minVersion", Kind::Text},
    {"/extensionsUsed", Kind::Texts},
    {"/extensionsRequired", Kind::Texts},

    {"/buffers", Kind::Objects},
    {"/buffers/*/byteLength!", Kind::Size},
    {"/buffers/*/uri", Kind::Text},
    {"/bufferViews", Kind::Objects},
    {"/bufferViews/*/buffer!", Kind::Index, "/buffers"},
    {"/bufferViews/*/byteLength!", Kind::Size},
    {"/bufferViews/*/byteOffset", Kind::Size},
    {"/bufferViews/*/byteStride", Kind::Size},
    {"/accessors", Kind::Objects},
    {"/accessors/*/bufferView", Kind::Index, "/bufferViews"},
    {"/accessors/*/byteOffset", Kind::Size},
    {"/accessors/*/componentType!", Kind::Int},
    {"/accessors/*/count!", Kind::Size},
    {"/accessors/*/type!", Kind::Word, "type of an accessor: SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4"},
    {"/accessors/*/normalized", Kind::Flag},
    {"/accessors/*/sparse/count!", Kind::Int},
    {"/accessors/*/sparse/indices!", Kind::Object},
    {"/accessors/*/sparse/indices/bufferView!", Kind::Index, "/bufferViews"},
    {"/accessors/*/sparse/indices/byteOffset", Kind::Int},
    {"/accessors/*/sparse/indices/componentType!", Kind::Int},
    {"/accessors/*/sparse/values!", Kind::Object},
    {"/accessors/*/sparse/values/bufferView!", Kind::Index, "/bufferViews"},
    {"/accessors/*/sparse/values/byteOffset", Kind::Int},

    {"/images", Kind::Objects},
    {"/images/*/uri", Kind::Text},
    {"/images/*/mimeType", Kind::Text},
    {"/images/*/bufferView", Kind::Index, "/bufferViews"},
    {"/samplers", Kind::Objects},
    {"/samplers/*/magFilter", Kind::Int},
    {"/samplers/*/wrapS", Kind::Int},
    {"/samplers/*/wrapT", Kind::Int},
    {"/textures", Kind::Objects},
    {"/textures/*/source", Kind::Index, "/images"},
    {"/textures/*/sampler", Kind::Index, "/samplers"},

    {"/materials", Kind::Objects},
    {"/materials/*/name", Kind::Text},
    {"/materials/*/pbrMetallicRoughness/baseColorFactor", Kind::Numbers, nullptr, 4},
    {"/materials/*/pbrMetallicRoughness/metallicFactor", Kind::Number},
    {"/materials/*/pbrMetallicRoughness/roughnessFactor", Kind::Number},
    {"/materials/*/emissiveFactor", Kind::Numbers, nullptr, 3},
    {"/materials/*/alphaMode", Kind::Word, "alpha mode: OPAQUE MASK BLEND"},
    {"/materials/*/alphaCutoff", Kind::Number},
    {"/materials/*/doubleSided", Kind::Flag},
    {"/materials/*/normalTexture/scale", Kind::Number},
    {"/materials/*/occlusionTexture/strength", Kind::Number},
    {"/materials/*/extras/perlinNormal/frequency", Kind::Number},
    {"/materials/*/extras/perlinNormal/amplitude", Kind::Number},
    {"/materials/*/extras/perlinNormal/octaves", Kind::Int},
    {"/nodes/*/extras/fragtrace_volume/volume!", Kind::Text},
    {"/nodes/*/extras/fragtrace_volume/position", Kind::Numbers, nullptr, 3},
    {"/nodes/*/extras/fragtrace_volume/scale", Kind::Number},
    {"/nodes/*/extras/fragtrace_volume/density", Kind::Number},
    {"/nodes/*/extras/fragtrace_volume/color", Kind::Numbers, nullptr, 3},
    {"/nodes/*/extras/fragtrace_volume/anisotropy", Kind::Number},
    {"/nodes/*/extras/fragtrace_volume/emission", Kind::Number},

    {"/meshes", Kind::Objects},
    {"/meshes/*/name", Kind::Text},
    {"/meshes/*/weights", Kind::Numbers},
    {"/meshes/*/primitives!", Kind::Objects},
    {"/meshes/*/primitives/*/attributes!", Kind::Object},
    {"/meshes/*/primitives/*/attributes/*", Kind::Index, "/accessors"},
    {"/meshes/*/primitives/*/indices", Kind::Index, "/accessors"},
    {"/meshes/*/primitives/*/material", Kind::Index, "/materials"},
    {"/meshes/*/primitives/*/mode", Kind::Int},
    {"/meshes/*/primitives/*/targets", Kind::Objects},
    {"/meshes/*/primitives/*/targets/*/*", Kind::Index, "/accessors"},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/bufferView", Kind::Index, "/bufferViews"},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/attributes", Kind::Object},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/attributes/*", Kind::Int},

    {"/extensions/KHR_materials_variants/variants!", Kind::Objects},
    {"/extensions/KHR_materials_variants/variants/*/name!", Kind::Text},
    {"/meshes/*/primitives/*/extensions/KHR_materials_variants/mappings!", Kind::Objects},
    {"/meshes/*/primitives/*/extensions/KHR_materials_variants/mappings/*/material!", Kind::Index,
     "/materials"},
    {"/meshes/*/primitives/*/extensions/KHR_materials_variants/mappings/*/variants!", Kind::Array},
    {"/meshes/*/primitives/*/extensions/KHR_materials_variants/mappings/*/variants/*", Kind::Index,
     "/extensions/KHR_materials_variants/variants"},

    {"/cameras", Kind::Objects},
    {"/cameras/*/name", Kind::Text},
    {"/cameras/*/type!", Kind::Word, "kind of camera: perspective orthographic"},
    {"/cameras/*/perspective/yfov!", Kind::Number},
    {"/cameras/*/perspective/znear", Kind::Number},
    {"/cameras/*/perspective/aspectRatio", Kind::Number},
    {"/cameras/*/orthographic/xmag!", Kind::Number},
    {"/cameras/*/orthographic/ymag!", Kind::Number},
    {"/cameras/*/orthographic/zfar", Kind::Number},
    {"/cameras/*/orthographic/znear", Kind::Number},

    {"/extensions/KHR_lights_punctual/lights!", Kind::Objects},
    {"/extensions/KHR_lights_punctual/lights/*/type!", Kind::Word, "kind of light: point spot directional"},
    {"/extensions/KHR_lights_punctual/lights/*/color", Kind::Numbers, nullptr, 3},
    {"/extensions/KHR_lights_punctual/lights/*/intensity", Kind::Number},
    {"/extensions/KHR_lights_punctual/lights/*/range", Kind::Number},
    {"/extensions/KHR_lights_punctual/lights/*/spot/innerConeAngle", Kind::Number},
    {"/extensions/KHR_lights_punctual/lights/*/spot/outerConeAngle", Kind::Number},
    {"/extensions/KHR_implicit_shapes/shapes!", Kind::Objects},
    {"/extensions/KHR_implicit_shapes/shapes/*/type!", Kind::Text},
    {"/extensions/KHR_implicit_shapes/shapes/*/sphere/radius", Kind::Number},

    {"/nodes", Kind::Objects},
    {"/nodes/*/name", Kind::Text},
    {"/nodes/*/children", Kind::Array},
    {"/nodes/*/children/*", Kind::Index, "/nodes"},
    {"/nodes/*/mesh", Kind::Index, "/meshes"},
    {"/nodes/*/camera", Kind::Index, "/cameras"},
    {"/nodes/*/matrix", Kind::Numbers, nullptr, 16},
    {"/nodes/*/translation", Kind::Numbers, nullptr, 3},
    {"/nodes/*/rotation", Kind::Numbers, nullptr, 4},
    {"/nodes/*/scale", Kind::Numbers, nullptr, 3},
    {"/nodes/*/weights", Kind::Numbers},
    {"/nodes/*/skin", Kind::Index, "/skins"},
    {"/nodes/*/extensions/KHR_node_visibility/visible", Kind::Flag},
    {"/nodes/*/extensions/KHR_lights_punctual/light!", Kind::Index, "/extensions/KHR_lights_punctual/lights"},
    {"/skins", Kind::Objects},
    {"/skins/*/joints!", Kind::Array},
    {"/skins/*/joints/*", Kind::Index, "/nodes"},
    {"/skins/*/skeleton", Kind::Index, "/nodes"},
    {"/skins/*/inverseBindMatrices", Kind::Index, "/accessors"},
    {"/animations", Kind::Objects},
    {"/animations/*/name", Kind::Text},
    {"/animations/*/samplers!", Kind::Objects},
    {"/animations/*/samplers/*/input!", Kind::Index, "/accessors"},
    {"/animations/*/samplers/*/output!", Kind::Index, "/accessors"},
    {"/animations/*/samplers/*/interpolation", Kind::Word, "interpolation: LINEAR STEP CUBICSPLINE"},
    {"/animations/*/channels!", Kind::Objects},
    {"/animations/*/channels/*/sampler!", Kind::Int},
    {"/animations/*/channels/*/target!", Kind::Object},
    {"/animations/*/channels/*/target/node", Kind::Index, "/nodes"},
    {"/animations/*/channels/*/target/path!", Kind::Word,
     "path that can be animated: translation rotation scale weights pointer"},
    {"/animations/*/channels/*/target/extensions/KHR_animation_pointer/pointer!", Kind::Text},
    {"/nodes/*/extensions/EXT_mesh_gpu_instancing/attributes", Kind::Object},
    {"/nodes/*/extensions/EXT_mesh_gpu_instancing/attributes/*", Kind::Index, "/accessors"},
    {"/scenes", Kind::Objects},
    {"/scenes/*/name", Kind::Text},
    {"/scenes/*/nodes", Kind::Array},
    {"/scenes/*/nodes/*", Kind::Index, "/nodes"},
    {"/scene", Kind::Index, "/scenes"},
};

/// The members of glTF's own material that name a texture.
constexpr const char* kTextureSlots[] = {
    "/materials/*/pbrMetallicRoughness/baseColorTexture",
    "/materials/*/pbrMetallicRoughness/metallicRoughnessTexture",
    "/materials/*/normalTexture",
    "/materials/*/emissiveTexture",
    "/materials/*/occlusionTexture",
};

/// The members of such a use of a texture.
constexpr Rule kTextureInfoRules[] = {
    {"/index!", Kind::Index, "/textures"},
    {"/texCoord", Kind::Int},
    {"/extensions/KHR_texture_transform/offset", Kind::Numbers, nullptr, 2},
    {"/extensions/KHR_texture_transform/scale", Kind::Numbers, nullptr, 2},
    {"/extensions/KHR_texture_transform/rotation", Kind::Number},
    {"/extensions/KHR_texture_transform/texCoord", Kind::Int},
};

/// The members of both extensions in buffer views, after their names.
constexpr Rule kMeshoptRules[] = {
    {"/buffer!", Kind::Index, "/buffers"},
    {"/byteOffset", Kind::Size},
    {"/byteLength!", Kind::Size},
    {"/byteStride!", Kind::Size},
    {"/count!", Kind::Size},
    {"/mode!", Kind::Text},
    {"/filter", Kind::Text},
};

/// kRules, and the rules of extensions and of all uses of textures.
const std::vector<Rule>& rules() {
  static std::deque<std::string> patterns;  // the rules point to them
  static const std::vector<Rule> all = [] {
    std::vector<Rule> made;
    std::set<std::string> known = {"/materials/*/extras", "/nodes/*/extras"};  // which may be anything
    const auto add = [&](const std::string& pattern, Rule rule) {
      for (size_t end = pattern.find('/', 1); end != pattern.npos; end = pattern.find('/', end + 1)) {
        const std::string holder = pattern.substr(0, end);
        if (pattern[end + 1] != '*' && !holder.ends_with('*') && known.insert(holder).second)
          made.push_back({patterns.emplace_back(holder).c_str(), Kind::Object});
      }
      known.insert(pattern.substr(0, pattern.find('!')));
      rule.pattern = patterns.emplace_back(pattern).c_str();
      made.push_back(rule);
    };
    for (const Rule& rule : kRules) add(rule.pattern, rule);
    const auto addTexture = [&](const std::string& place) {
      for (const Rule& rule : kTextureInfoRules) add(place + rule.pattern, rule);
    };
    for (const char* place : kTextureSlots) addTexture(place);
    for (const std::string name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
      add("/buffers/*/extensions/" + name + "/fallback", {"", Kind::Flag});
      for (const Rule& rule : kMeshoptRules) add("/bufferViews/*/extensions/" + name + rule.pattern, rule);
    }
    for (const std::string name : {"KHR_texture_basisu", "EXT_texture_avif", "EXT_texture_webp"}) {
      add("/textures/*/extensions/" + name + "/source", {"", Kind::Index, "/images"});
    }
    for (const Extension& extension : extensions()) {
      if (extension.members.empty()) continue;
      const std::string place = "/materials/*/extensions/" + std::string(extension.name);
      for (const std::string_view member : wordsIn(extension.members)) {
        const size_t bracket = member.find('[');
        const std::string at = place + "/" + std::string(member.substr(0, bracket));
        if (bracket != std::string::npos)
          add(at, {"", Kind::Numbers, nullptr, size_t(member[bracket + 1] - '0')});
        else if (member.ends_with("Texture"))
          addTexture(at);
        else
          add(at, {"", Kind::Number});
      }
    }
    return made;
  }();
  return all;
}

/// The part of the pattern after a prefix that matches the whole pointer; none without such a prefix.
std::optional<std::string_view> restOf(std::string_view pattern, std::string_view pointer) {
  if (pattern.ends_with('!')) pattern.remove_suffix(1);
  while (pattern.starts_with('/') && pointer.starts_with('/')) {
    const std::string_view wanted = cutPart(pattern);
    const std::string_view part = cutPart(pointer);
    if (wanted != "*" && wanted != part) return std::nullopt;
  }
  return pointer.empty() ? std::optional(pattern) : std::nullopt;
}

bool matches(std::string_view pattern, std::string_view pointer) {
  const std::optional<std::string_view> rest = restOf(pattern, pointer);
  return rest && rest->empty();
}

}  // namespace

namespace {

/// Adds the names of all extensions that are used somewhere in a value.
void noteExtensions(const json& value, std::set<std::string, std::less<>>& names) {
  if (value.is_array())
    for (const json& element : value) noteExtensions(element, names);
  if (!value.is_object()) return;
  for (const auto& [name, member] : value.items()) {
    if (name == "extensions" && member.is_object())
      for (const auto& [extension, content] : member.items()) names.insert(extension);
    noteExtensions(member, names);
  }
}

/// The extension that a pattern leads into; empty: none.
std::string_view extensionOfPattern(std::string_view pattern) {
  constexpr std::string_view kExtensions = "/extensions/";
  const size_t at = pattern.find(kExtensions);
  if (at == std::string_view::npos) return {};
  const std::string_view name = pattern.substr(at + kExtensions.size());
  return name.substr(0, name.find_first_of("/!"));
}

}  // namespace

IsUsed applySchema(json& root, const SceneSelection& selection, Diagnostics& diagnostics) {
  if (!root.is_object()) diagnostics.refuse("", "is not glTF: the JSON is not an object");
  IsUsed isUsed = [&root, selection, used = std::make_shared<Owners>()](std::string_view place) {
    if (used->empty()) *used = usedObjects(root, rules(), selection);  // few documents ask for it
    return used->contains(ownerOf(place));
  };
  const SchemaContext context{diagnostics, isRequiredAt, isUsed};
  std::set<std::string, std::less<>> extensions{""};
  noteExtensions(root, extensions);
  for (const Rule& rule : rules())
    if (extensions.contains(extensionOfPattern(rule.pattern))) applyRule(rule, root, context);
  return isUsed;
}

bool isRequiredAt(std::string_view pattern) {
  return std::ranges::any_of(rules(), [&](const Rule& rule) {
    const std::string_view one = rule.pattern;
    return one.ends_with('!') && one.substr(0, one.size() - 1) == pattern;
  });
}

std::optional<NumberRule> numberRuleAt(std::string_view pointer) {
  // The one flag that glTF's object model lets animations change.
  if (matches("/nodes/*/extensions/KHR_node_visibility/visible", pointer)) return NumberRule{1, false, true};
  for (const Rule& rule : rules()) {
    const bool isArray = rule.kind == Kind::Numbers;
    if ((isArray || rule.kind == Kind::Number) && matches(rule.pattern, pointer))
      return NumberRule{isArray ? rule.size : 1, isArray, false};
  }
  return std::nullopt;
}

std::vector<std::string> numberMembersAt(std::string_view pointer) {
  std::set<std::string> members;
  for (const Rule& rule : rules()) {
    if (rule.kind != Kind::Number && rule.kind != Kind::Numbers) continue;
    std::optional<std::string_view> rest = restOf(rule.pattern, pointer);
    if (rest && !rest->empty()) members.emplace(cutPart(*rest));
  }
  members.erase("*");
  return {members.begin(), members.end()};
}

std::vector<std::string> numbersBelow(std::string_view pointer, std::string_view end) {
  std::vector<std::string> places;
  for (const Rule& rule : rules()) {
    if (rule.kind != Kind::Number && rule.kind != Kind::Numbers) continue;
    const std::optional<std::string_view> rest = restOf(rule.pattern, pointer);
    if (!rest || rest->empty()) continue;
    for (size_t at = rest->find('/', 1); at < rest->size(); at = rest->find('/', at + 1)) {
      const std::string_view between = rest->substr(0, at);
      if (between.find('*') == between.npos && matches(rest->substr(at), end))
        places.push_back(std::string(pointer).append(between).append(end));
    }
  }
  return places;
}

}  // namespace fragtrace
