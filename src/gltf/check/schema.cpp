// SPDX-License-Identifier: MIT
#include "gltf/check/schema.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "gltf/check/extensions.h"
#include "gltf/read/json.h"

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

enum class Kind {
  Any,  ///< extras
  Object,
  Array,
  Objects,  ///< an array of objects
  Text,
  Word,  ///< one of those in `target`, "what they are: A B", without regard to case
  Texts,
  Flag,
  Number,
  Numbers,  ///< an array of `size` numbers; 0: of any number of them
  Int,      ///< 0 to 2^31 - 1, what tinygltf keeps in an int
  Size,     ///< 0 to 2^53
  Index,    ///< into the array at `target`
  Hint,     ///< such an index in extras, which are the author's own elsewhere: it is not checked
};

/// A place is a JSON pointer in which * stands for any member or element. Its members are words: NAME is a
/// number or, if it ends in Texture, the use of one; NAME[3] are three numbers, NAME[] any number of them;
/// NAME>ARRAY is an index into that array, and NAME?ARRAY a hint; NAME:KIND is one of the kinds of
/// addMembers(). A ! after NAME stands for "required".
struct Rule {
  std::string_view place;
  std::string_view members;
  std::string_view words = {};  ///< Place::target of Kind::Word
};

/// Rules for what the loader reads. Containers without a rule of their own are objects.
constexpr Rule kRules[] = {
    {"", "asset!:object extensionsUsed:texts extensionsRequired:texts scene>/scenes"},
    {"", "buffers:objects bufferViews:objects accessors:objects images:objects samplers:objects"},
    {"", "textures:objects materials:objects meshes:objects cameras:objects nodes:objects skins:objects"},
    {"", "animations:objects scenes:objects"},
    {"/asset", "version!:text minVersion:text"},

    {"/buffers/*", "byteLength!:size uri:text"},
    {"/bufferViews/*", "buffer!>/buffers byteLength!:size byteOffset:size byteStride:size"},
    {"/accessors/*", "bufferView>/bufferViews byteOffset:size componentType!:int count!:size"},
    {"/accessors/*", "type!:word", "type of an accessor: SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4"},
    {"/accessors/*", "normalized:flag"},
    {"/accessors/*/sparse", "count!:int indices!:object values!:object"},
    {"/accessors/*/sparse/indices", "bufferView!>/bufferViews byteOffset:int componentType!:int"},
    {"/accessors/*/sparse/values", "bufferView!>/bufferViews byteOffset:int"},

    {"/images/*", "uri:text bufferView>/bufferViews"},
    {"/samplers/*", "magFilter:int wrapS:int wrapT:int"},
    {"/textures/*", "source>/images sampler>/samplers"},
    {"/textures/*/extensions/KHR_texture_basisu", "source>/images"},
    {"/textures/*/extensions/EXT_texture_avif", "source>/images"},
    {"/textures/*/extensions/EXT_texture_webp", "source>/images"},

    {"/materials/*", "name:text emissiveFactor[3] alphaCutoff doubleSided:flag extras:any"},
    {"/materials/*", "alphaMode:word", "alpha mode: OPAQUE MASK BLEND"},
    {"/materials/*/pbrMetallicRoughness", "baseColorFactor[4] metallicFactor roughnessFactor"},
    {"/materials/*/pbrMetallicRoughness", "baseColorTexture metallicRoughnessTexture"},
    {"/materials/*", "normalTexture normalTexture/scale occlusionTexture occlusionTexture/strength"},
    {"/materials/*", "emissiveTexture"},
    {"/materials/*/extras/perlinNormal", "frequency amplitude octaves:int"},
    {"/nodes/*", "extras:any"},
    {"/nodes/*/extras", "material?/materials shape?/extensions/KHR_implicit_shapes/shapes"},
    {"/nodes/*/extras/fragtrace_volume",
     "volume!:text position[3] scale density color[3] anisotropy emission"},

    {"/meshes/*", "name:text weights[] primitives!:objects"},
    {"/meshes/*/primitives/*", "attributes!:object attributes/*>/accessors indices>/accessors"},
    {"/meshes/*/primitives/*", "material>/materials mode:int targets:objects targets/*/*>/accessors"},
    {"/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression",
     "bufferView>/bufferViews attributes:object attributes/*:int"},

    {"/extensions/KHR_materials_variants", "variants!:objects variants/*/name!:text"},
    {"/meshes/*/primitives/*/extensions/KHR_materials_variants", "mappings!:objects"},
    {"/meshes/*/primitives/*/extensions/KHR_materials_variants/mappings/*",
     "material!>/materials variants!:array variants/*>/extensions/KHR_materials_variants/variants"},

    {"/cameras/*", "name:text"},
    {"/cameras/*", "type!:word", "kind of camera: perspective orthographic"},
    {"/cameras/*/perspective", "yfov! znear aspectRatio"},
    {"/cameras/*/orthographic", "xmag! ymag! zfar znear"},

    {"/extensions/KHR_lights_punctual", "lights!:objects"},
    {"/extensions/KHR_lights_punctual/lights/*", "type!:word", "kind of light: point spot directional"},
    {"/extensions/KHR_lights_punctual/lights/*", "name:text color[3] intensity range"},
    {"/extensions/KHR_lights_punctual/lights/*/spot", "innerConeAngle outerConeAngle"},
    {"/extensions/KHR_implicit_shapes", "shapes!:objects shapes/*/type!:text shapes/*/sphere/radius"},

    {"/nodes/*", "name:text children:array children/*>/nodes mesh>/meshes camera>/cameras matrix[16]"},
    {"/nodes/*", "translation[3] rotation[4] scale[3] weights[] skin>/skins"},
    {"/nodes/*/extensions", "KHR_node_visibility/visible:flag"},
    {"/nodes/*/extensions", "KHR_lights_punctual/light!>/extensions/KHR_lights_punctual/lights"},
    {"/skins/*", "joints!:array joints/*>/nodes skeleton>/nodes inverseBindMatrices>/accessors"},
    {"/animations/*", "name:text samplers!:objects channels!:objects"},
    {"/animations/*/samplers/*", "input!>/accessors output!>/accessors"},
    {"/animations/*/samplers/*", "interpolation:word", "interpolation: LINEAR STEP CUBICSPLINE"},
    {"/animations/*/channels/*", "sampler!:int target!:object"},
    {"/animations/*/channels/*/target", "node>/nodes extensions/KHR_animation_pointer/pointer!:text"},
    {"/animations/*/channels/*/target", "path!:word",
     "path that can be animated: translation rotation scale weights pointer"},
    {"/nodes/*/extensions/EXT_mesh_gpu_instancing", "attributes:object attributes/*>/accessors"},
    {"/scenes/*", "name:text nodes:array nodes/*>/nodes"},
};

/// The members of the use of a texture.
constexpr std::string_view kTextureInfo =
    "index!>/textures texCoord:int extensions/KHR_texture_transform/offset[2] "
    "extensions/KHR_texture_transform/scale[2] extensions/KHR_texture_transform/rotation "
    "extensions/KHR_texture_transform/texCoord:int";

/// The rules as a tree: what the value at a place may be, and what is below it.
struct Place {
  std::string name;  ///< of the member; *: of any member or element
  Kind kind = Kind::Object;
  std::string_view target = {};
  size_t size = 0;
  bool isRequired = false;
  bool isIndispensable = false;  ///< without it, what holds it would be read as something else
  bool holdsNumbers = false;     ///< it is a number, or some are below it
  const LostObject* object = nullptr;
  std::vector<Place> below = {};

  const Place* find(std::string_view member) const {
    const auto found = std::ranges::find(below, member, &Place::name);
    return found == below.end() ? nullptr : &*found;
  }
  /// The rule for that part of a pointer.
  const Place* at(std::string_view part) const {
    const Place* named = find(part);
    return named != nullptr ? named : find("*");
  }
};

bool isIndispensable(std::string_view pattern) {
  return pattern.starts_with("/accessors/*/") || pattern.starts_with("/bufferViews/*/") ||
         pattern == "/animations/*/samplers/*/interpolation" || pattern == "/cameras/*/orthographic" ||
         pattern == "/cameras/*/perspective" ||
         pattern == "/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression";
}

void addRule(Place& root, std::string_view pattern, Kind kind, std::string_view target = {},
             size_t size = 0) {
  const bool isRequired = pattern.ends_with('!');
  if (isRequired) pattern.remove_suffix(1);
  Place* place = &root;
  for (std::string_view rest = pattern; !rest.empty();) {
    const std::string_view name = cutPart(rest);
    if (place->find(name) == nullptr) {
      const std::string_view here = pattern.substr(0, pattern.size() - rest.size());
      place->below.push_back({.name = std::string(name)});
      place->below.back().isIndispensable = isIndispensable(here);
      place->below.back().object = lostObjectAt(here);
    }
    place = &*std::ranges::find(place->below, name, &Place::name);
    place->holdsNumbers = place->holdsNumbers || kind == Kind::Number || kind == Kind::Numbers;
  }
  place->kind = kind;
  place->target = target;
  place->size = size;
  place->isRequired = isRequired;
}

/// The rules of the members of the object at a place (Rule).
void addMembers(Place& root, std::string_view place, std::string_view members, std::string_view words = {}) {
  static const std::map<std::string_view, Kind> kinds = {
      {"any", Kind::Any},   {"object", Kind::Object}, {"array", Kind::Array}, {"objects", Kind::Objects},
      {"text", Kind::Text}, {"word", Kind::Word},     {"texts", Kind::Texts}, {"flag", Kind::Flag},
      {"int", Kind::Int},   {"size", Kind::Size},
  };
  for (const std::string_view member : wordsIn(members)) {
    const std::string_view name = member.substr(0, member.find_first_of("[>?:"));
    const std::string_view rest = member.substr(name.size());
    const std::string at = std::string(place) + "/" + std::string(name);
    if (rest.empty() && name.ends_with("Texture"))
      addMembers(root, at, kTextureInfo);
    else if (rest.empty())
      addRule(root, at, Kind::Number);
    else if (rest[0] == '[')
      addRule(root, at, Kind::Numbers, {}, numberOfAll<size_t>(rest.substr(1, rest.size() - 2)).value_or(0));
    else if (rest[0] == ':')
      addRule(root, at, kinds.at(rest.substr(1)), words);
    else
      addRule(root, at, rest[0] == '>' ? Kind::Index : Kind::Hint, rest.substr(1));
  }
}

/// The root of the tree: kRules, and the rules of extensions.
const Place& schema() {
  static const Place root = [] {
    Place made;
    for (const Rule& rule : kRules) addMembers(made, rule.place, rule.members, rule.words);
    for (const std::string name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
      addMembers(made, "/buffers/*/extensions/" + name, "fallback:flag");
      addMembers(made, "/bufferViews/*/extensions/" + name,
                 "buffer!>/buffers byteOffset:size byteLength!:size byteStride!:size count!:size mode!:text "
                 "filter:text");
    }
    for (const Extension& extension : extensions()) {
      if (extension.read == nullptr) continue;
      const std::string place = "/materials/*/extensions/" + std::string(extension.name);
      addRule(made, place, Kind::Object);
      addMembers(made, place, extension.members);
    }
    return made;
  }();
  return root;
}

/// The rule for a JSON pointer; null: nothing there is read.
const Place* placeAt(std::string_view pointer) {
  const Place* place = &schema();
  while (place != nullptr && pointer.starts_with('/')) place = place->at(cutPart(pointer));
  return place;
}

/// The place of the object that holds a place: an element of one of the root's arrays, "/meshes/0" of
/// "/meshes/0/primitives/1", or of an extension's; "" for what is the root's own.
std::string_view ownerOf(std::string_view place) {
  const int parts = place.starts_with("/extensions/") ? 4 : 2;
  size_t end = 0;
  for (int i = 0; i < parts && end < place.size(); ++i)
    end = std::min(place.find('/', end + 1), place.size());
  const std::string_view owner = place.substr(0, end);
  const char last = owner.empty() ? ' ' : owner.back();
  return last >= '0' && last <= '9' ? owner : "";
}

using Owners = std::set<std::string, std::less<>>;
using References = std::map<std::string, std::vector<std::string>, std::less<>>;

/// Adds the references below a value by their owners; those of variants only `ofVariants`.
void noteReferences(const json& value, const Place& schema, const std::string& place, bool ofVariants,
                    References& references) {
  if ((schema.kind == Kind::Index || schema.kind == Kind::Hint) && value.is_number_unsigned())
    references[std::string(ownerOf(place))].push_back(std::string(schema.target) +
                                                      pointerTo(value.get<uint64_t>()));
  for (const Place& below : schema.below) {
    if (below.name == "mappings" && !ofVariants) continue;
    const auto note = [&](const json& one, const std::string& part) {
      noteReferences(one, below, place + part, ofVariants, references);
    };
    if (below.name != "*") {
      if (const json& member = memberOf(value, below.name.c_str()); !member.is_null())
        note(member, pointerTo(below.name));
    } else if (value.is_array()) {
      for (size_t i = 0; i < value.size(); ++i) note(value[i], pointerTo(i));
    } else if (value.is_object()) {
      for (const auto& member : value.items()) note(member.value(), pointerTo(member.key()));
    }
  }
}

std::vector<std::string> allOf(const json& root, const char* array) {
  std::vector<std::string> places;
  for (size_t i = 0; i < memberOf(root, array).size(); ++i) places.push_back(pointerTo(array, i));
  return places;
}

/// The scene that is drawn; without scenes, all nodes.
std::vector<std::string> rootsOf(const json& root, const SceneSelection& selection) {
  const json& scenes = memberOf(root, "scenes");
  if (!scenes.is_array() || scenes.empty()) return allOf(root, "nodes");
  size_t scene = 0;
  if (memberOf(root, "scene").is_number_unsigned()) scene = root["scene"].get<size_t>();
  if (!selection.scene.empty()) scene = findPart(selection.scene, namesOf(scenes)).value_or(scene);
  return {pointerTo("scenes", scene)};
}

/// The owners that are reached from the selected scene. The document need not have passed the schema.
Owners usedObjects(const json& root, const SceneSelection& selection) {
  References references;
  noteReferences(root, schema(), "", !selection.materialVariant.empty(), references);
  std::vector<std::string> waiting = rootsOf(root, selection);
  if (selection.animationTime) std::ranges::copy(allOf(root, "animations"), std::back_inserter(waiting));
  Owners used = {""};
  while (!waiting.empty()) {
    const std::string place = std::move(waiting.back());
    waiting.pop_back();
    if (!used.insert(place).second) continue;
    if (const auto targets = references.find(place); targets != references.end())
      std::ranges::copy(targets->second, std::back_inserter(waiting));
  }
  return used;
}

/// Walks once over a document along the tree of rules.
class Checker {
 public:
  Checker(json& root, const IsUsed& isUsed, Diagnostics& diagnostics)
      : root_(root), isUsed_(isUsed), diagnostics_(diagnostics) {}

  void check() {
    if (!stays(root_, schema())) diagnostics_.refuse(faultPlace_, fault_);
  }

 private:
  /// Notes a fault of the value that is looked at, and returns false.
  bool note(const std::string& reason) {
    fault_ = reason;
    faultPlace_ = place_;
    return false;
  }

  void warnOfAbsent() { diagnostics_.warn(faultPlace_, fault_ + "; it is taken as absent"); }

  /// Returns false, with a fault, if the value cannot stay. It is the member or element `part` of the one
  /// that is looked at, or the root.
  bool stays(json& value, const Place& rule, const std::string& part = "") {
    const size_t length = place_.size();
    place_ += part;
    const Place* element = value.is_array() ? rule.find("*") : nullptr;
    const bool result = isRight(value, rule) && (!value.is_object() || membersStay(value, rule)) &&
                        (element == nullptr || elementsStay(value, *element));
    place_.resize(length);
    return result;
  }

  bool membersStay(json& object, const Place& rule) {
    static const Place kNone{.name = "extensions", .kind = Kind::Any};
    for (auto member = object.begin(); member != object.end();) {
      const Place* below = rule.at(member.key());
      if (below == nullptr && member.key() == "extensions") below = &kNone;
      const std::string part = pointerTo(member.key());
      bool isKept = true;
      if (member->is_null() && rule.kind == Kind::Object && (below == nullptr || !below->isRequired)) {
        diagnostics_.warn(place_ + part, "is null, and taken as absent");
        isKept = false;
      } else if (below == nullptr) {
        if (rule.name == "extensions") warnOfStranger(member.key(), rule);
      } else if (!stays(*member, *below, part)) {
        if (below->isRequired || below->isIndispensable) return false;
        warnOfAbsent();
        isKept = false;
      }
      member = isKept ? std::next(member) : object.erase(member);
    }
    for (const Place& below : rule.below)
      if (below.isRequired && !object.contains(below.name)) return note(inQuotes(below.name) + " is missing");
    return true;
  }

  /// An extension that is not known may be anywhere, unless its name says that it belongs to materials.
  void warnOfStranger(const std::string& name, const Place& extensions) {
    const bool isOfMaterials =
        name.starts_with("KHR_materials_") && extensions.find("KHR_materials_unlit") == nullptr;
    if (extensionNamed(name) != nullptr || isOfMaterials)
      diagnostics_.warn(place_ + pointerTo(name), "is not expected here, and ignored");
  }

  bool elementsStay(json& array, const Place& element) {
    for (size_t i = 0; i < array.size(); ++i) {
      const std::string part = pointerTo(i);
      if (element.object != nullptr && diagnostics_.hasLost() && diagnostics_.isLost(place_ + part)) continue;
      if (stays(array[i], element, part)) continue;
      if (element.object != nullptr) {
        loseObject(root_, *element.object, place_ + part, {"", faultPlace_, fault_}, isUsed_, diagnostics_);
      } else if (element.kind == Kind::Index && !place_.starts_with("/skins/")) {
        array.erase(i--);  // children and roots, whose number and order mean nothing
        warnOfAbsent();
      } else {
        return false;
      }
    }
    return true;
  }

  bool isRight(json& value, const Place& rule) {
    if (value.is_null()) return rule.kind == Kind::Any || rule.kind == Kind::Hint || note("is null");
    switch (rule.kind) {
      case Kind::Any:
      case Kind::Hint:
        return true;
      case Kind::Object:
        return value.is_object() || note("is not an object");
      case Kind::Array:
        return value.is_array() || note("is not an array");
      case Kind::Objects:
        return areObjects(value, *rule.find("*"));
      case Kind::Text:
        return value.is_string() || note("is not a string");
      case Kind::Word:
        return isWord(value, rule);
      case Kind::Texts:
        return isOfEach(value, &json::is_string) || note("is not an array of strings");
      case Kind::Flag:
        return value.is_boolean() || note("is not true or false");
      case Kind::Number:
        return value.is_number() || note("is not a number");
      case Kind::Numbers:
        if (!isOfEach(value, &json::is_number)) return note("is not an array of numbers");
        return rule.size == 0 || value.size() == rule.size ||
               note("does not hold " + std::to_string(rule.size) + " numbers");
      case Kind::Int:
        return isWhole(value, uint64_t(std::numeric_limits<int32_t>::max()));
      case Kind::Size:
        return isWhole(value, uint64_t(1) << 53);
      case Kind::Index:
        return isIndex(value, rule);
    }
    return true;
  }

  static bool isOfEach(const json& value, bool (json::*isRight)() const noexcept) {
    return value.is_array() && std::ranges::all_of(value, [&](const json& e) { return (e.*isRight)(); });
  }

  bool isWord(json& value, const Place& rule) {
    if (!value.is_string()) return note("is not a string");
    const std::string given = value;
    const size_t colon = rule.target.find(':');
    const auto words = wordsIn(rule.target.substr(colon + 2));
    const auto word =
        std::ranges::find_if(words, [&](std::string_view one) { return isSameButForCase(one, given); });
    const std::string is = inQuotes(given) + " is ";
    const std::string isNone = is + "no " + std::string(rule.target.substr(0, colon));
    const bool isKnown = word != words.end();
    if (!isKnown && (rule.isRequired || rule.isIndispensable)) return note(isNone);
    value = isKnown ? *word : words.front();
    if (value != given)
      diagnostics_.warn(place_, (isKnown ? is : isNone + "; it is ") + "read as " + std::string(value));
    return true;
  }

  /// Elements that are no objects become ones without content.
  bool areObjects(json& value, const Place& element) {
    if (!value.is_array()) return note("is not an array of objects");
    for (size_t i = 0; i < value.size(); ++i) {
      if (value[i].is_object()) continue;
      if (element.object == nullptr) return note("is not an array of objects");
      const std::string place = place_ + pointerTo(i);
      const std::string is = value[i].is_null() ? "is null" : "is not an object";
      if (std::string_view(element.object->empty) == "{}") {
        diagnostics_.warn(place, is + ", and taken as one without members");
        diagnostics_.noteLost(place);
        value[i] = json::object();
      } else {
        loseObject(root_, *element.object, place, {"", place, is}, isUsed_, diagnostics_);
      }
    }
    return true;
  }

  bool isWhole(json& value, uint64_t largest) {
    if (value.is_number_float()) {
      const double number = value.get<double>();
      if (number >= 0.0 && number <= double(largest) && number == std::floor(number))
        value = uint64_t(number);
    }
    if (!value.is_number_unsigned()) return note("is not a non-negative integer");
    return value.get<uint64_t>() <= largest || note("is too large");
  }

  bool isIndex(json& value, const Place& rule) {
    bool isRight = isWhole(value, uint64_t(std::numeric_limits<int32_t>::max()));
    if (isRight && value.get<uint64_t>() >= sizeOf(rule.target)) {
      isRight = note("index " + value.dump() + " is past the " + std::to_string(sizeOf(rule.target)) +
                     " elements of " + std::string(rule.target));
    }
    if (!isRight && isUsed_(place_)) diagnostics_.refuse(faultPlace_, fault_);
    return isRight;
  }

  /// The size of the array that indices refer to.
  size_t sizeOf(std::string_view array) {
    const auto [known, isNew] = sizes_.try_emplace(array, 0);
    if (!isNew) return known->second;
    const json::json_pointer pointer{std::string(array)};
    return known->second = root_.contains(pointer) && root_[pointer].is_array() ? root_[pointer].size() : 0;
  }

  json& root_;
  const IsUsed& isUsed_;
  Diagnostics& diagnostics_;
  std::map<std::string_view, size_t> sizes_;
  std::string place_;       ///< JSON pointer of the value that is looked at
  std::string fault_;       ///< the reason why a value cannot stay
  std::string faultPlace_;  ///< its place
};

}  // namespace

std::string_view cutPart(std::string_view& pointer) {
  pointer.remove_prefix(1);
  const size_t end = std::min(pointer.find('/'), pointer.size());
  const std::string_view part = pointer.substr(0, end);
  pointer.remove_prefix(end);
  return part;
}

IsUsed applySchema(json& root, const SceneSelection& selection, Diagnostics& diagnostics) {
  if (!root.is_object()) diagnostics.refuse("", "is not glTF: the JSON is not an object");
  IsUsed isUsed = [&root, selection, used = std::make_shared<Owners>()](std::string_view place) {
    if (used->empty()) *used = usedObjects(root, selection);  // few documents ask for it
    return used->contains(ownerOf(place));
  };
  Checker(root, isUsed, diagnostics).check();
  return isUsed;
}

std::optional<NumberRule> numberRuleAt(std::string_view pointer) {
  const Place* place = placeAt(pointer);
  if (place == nullptr) return std::nullopt;
  if (place->kind == Kind::Number) return NumberRule{};
  if (place->kind == Kind::Numbers) return NumberRule{place->size, true, false};
  // The one flag that glTF's object model lets animations change.
  if (place->kind == Kind::Flag && place->name == "visible") return NumberRule{1, false, true};
  return std::nullopt;
}

std::vector<std::string> numberMembersAt(std::string_view pointer) {
  std::set<std::string> members;
  if (const Place* place = placeAt(pointer)) {
    for (const Place& below : place->below)
      if (below.holdsNumbers && below.name != "*") members.insert(below.name);
  }
  return {members.begin(), members.end()};
}

std::vector<std::string> numbersBelow(std::string_view pointer, std::string_view end) {
  std::vector<std::string> places;
  std::vector<std::string> waiting{std::string(pointer)};
  for (size_t i = 0; i < waiting.size(); ++i) {
    const Place* place = placeAt(waiting[i]);
    for (size_t k = 0; place != nullptr && k < place->below.size(); ++k) {
      const Place& below = place->below[k];
      if (!below.holdsNumbers || below.name == "*") continue;
      waiting.push_back(waiting[i] + "/" + below.name);
      const std::string number = waiting.back() + std::string(end);
      const Place* found = placeAt(number);
      if (found != nullptr && (found->kind == Kind::Number || found->kind == Kind::Numbers))
        places.push_back(number);
    }
  }
  return places;
}

}  // namespace fragtrace
