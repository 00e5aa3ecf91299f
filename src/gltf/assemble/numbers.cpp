// SPDX-License-Identifier: MIT
#include "gltf/assemble/numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "gltf/read/json.h"
#include "scene/camera.h"

namespace fragtrace {

namespace {

using nlohmann::json;

/// The index that a part of a pointer is, if the array has it.
std::optional<size_t> indexIn(const json& array, std::string_view part) {
  const auto index = numberOfAll<size_t>(part);
  const bool isIndex = index && (part == "0" || part[0] != '0');
  return isIndex && *index < array.size() ? index : std::nullopt;
}

/// A pointer cut at the first part that the document does not have, or else at its last part.
struct CutPointer {
  const json* parent;  ///< the object or array that has the part, or should have it
  bool isMissing;
  std::string place, part, rest;
};

CutPointer cut(const json& root, std::string_view pointer) {
  CutPointer at{&root, false, "", "", ""};
  std::string_view rest = pointer;
  for (const json* value = &root; !rest.empty() && !at.isMissing;) {
    at.parent = value;
    const std::string_view part = cutPart(rest);
    const std::optional<size_t> index = value->is_array() ? indexIn(*value, part) : std::nullopt;
    at.isMissing = !index && (!value->is_object() || !value->contains(part));
    if (!at.isMissing) value = index ? &(*value)[*index] : &(*value)[std::string(part)];
    at.place = pointer.substr(0, pointer.size() - rest.size() - part.size() - 1);
    at.part = part;
  }
  at.rest = rest;
  return at;
}

/// Returns true if all but the last part of the pointer is in the document. A material has
/// pbrMetallicRoughness in any case.
bool isOfSomething(const json& root, std::string_view pointer) {
  const CutPointer at = cut(root, pointer);
  return !at.isMissing || (at.parent->is_object() && (at.rest.empty() || at.part == "pbrMetallicRoughness"));
}

/// Brings a pointer to no number one step nearer to one that may be meant: to a member that is spelled much
/// the same, to one that stands deeper, or to an element by its name. Returns nothing where none is near.
std::string nearerPlace(const json& root, const std::string& pointer) {
  const CutPointer at = cut(root, pointer);
  if (!at.isMissing || at.parent->is_object()) {
    for (const std::string& below : numbersBelow(at.place, pointer.substr(at.place.size()))) {
      if (numberRuleIn(root, below)) return below;
    }
    const std::vector<std::string> members = numberMembersAt(at.place);
    if (std::ranges::find(members, at.part) != members.end()) return "";
    const auto isAlike = [&](const std::string& member) { return isSameButForCase(member, at.part); };
    auto alike = std::ranges::find_if(members, isAlike);
    // The name without its end, as panels and other programs have it.
    const auto begins = [&](const std::string& member) {
      return isSameButForCase(member, at.part + "Factor");
    };
    if (alike == members.end()) alike = std::ranges::find_if(members, begins);
    const std::string nearest = alike != members.end() ? *alike : nearestName(at.part, members);
    return nearest.empty() ? "" : at.place + "/" + nearest + at.rest;
  }
  if (!at.parent->is_array()) return "";
  const std::vector<std::string> names = namesOf(*at.parent);
  std::optional<size_t> index = findPart(at.part, names);
  if (!index) index = findPart(nearestName(at.part, names), names);
  const bool isNamed = index && !names[*index].empty();
  return isNamed ? at.place + "/" + std::to_string(*index) + at.rest : "";
}

/// Returns a place of numbers that may be meant by a pointer, or nothing: the pointer itself, where it is
/// one.
std::string placeMeantBy(const json& root, std::string pointer) {
  constexpr int kMostSteps = 8;  // the number of wrong parts that are still searched
  for (int i = 0; i < kMostSteps && !pointer.empty(); ++i) {
    if (numberRuleIn(root, pointer)) return pointer;
    pointer = nearerPlace(root, pointer);
  }
  return "";
}

/// Says how to set numbers that are only set together, if a pointer names one of them by its index or as a
/// component (x, r); else nothing.
std::string hintAtWhole(const json& root, const std::string& pointer) {
  const size_t end = pointer.rfind('/');
  if (end == std::string::npos) return "";
  const std::string last = pointer.substr(end + 1);
  const bool isComponent = last.size() == 1 && std::string_view("rgbaxyzw").find(last) != std::string::npos;
  if (!isComponent && !numberOfAll<size_t>(last)) return "";
  const std::string whole = placeMeantBy(root, pointer.substr(0, end));
  if (whole.empty()) return "";
  const NumberRule rule = *numberRuleIn(root, whole);
  if (!rule.isArray) return "";
  std::string example = "=1";
  for (size_t i = 1; i < rule.width; ++i) example += ",1";
  return "; set all of " + whole + " together, such as " + whole + example;
}

/// A hint at what may be meant by a pointer to no number.
std::string hintFor(const json& root, const std::string& pointer) {
  if (std::string whole = hintAtWhole(root, pointer); !whole.empty()) return whole;
  if (const std::string meant = placeMeantBy(root, pointer); !meant.empty())
    return "; did you mean " + meant + "?";
  const auto [parent, isMissing, place, part, rest] = cut(root, pointer);
  if (!isMissing) return "";
  if (parent->is_object()) {
    const std::vector<std::string> members = numberMembersAt(place);
    const bool isKnown = std::ranges::find(members, part) != members.end();
    if (isKnown) return ": " + (place.empty() ? "it" : place) + " has no " + part;
    const std::vector<std::string> below = numbersBelow(place, pointer.substr(place.size()));
    return below.empty() ? "" : ": the file has no " + below.front();
  }
  if (!parent->is_array()) return "";
  return ": " + place + " has " + listOfParts(namesOf(*parent), part);
}

/// The mode at a place of a material, and whether it is one that takes the word.
struct Mode {
  bool isFlag;
  bool takes;
};
std::optional<Mode> modeAt(const json& root, const SetNumber& set) {
  const bool isFlag = set.pointer.ends_with("/doubleSided");
  if (!set.pointer.starts_with("/materials/") || !(isFlag || set.pointer.ends_with("/alphaMode")) ||
      !isOfSomething(root, set.pointer))
    return std::nullopt;
  const bool isTruth = set.word == "true" || set.word == "false";
  return Mode{isFlag, !set.word.empty() && isTruth == isFlag};
}

/// A number that each use of a texture may have.
constexpr const char* kTurn = "/extensions/KHR_texture_transform/rotation";

/// Returns true if a texture stands at that place of a material, or may stand there.
bool isTextureAt(std::string_view pointer) {
  return pointer.ends_with("Texture") && numberRuleAt(std::string(pointer) + kTurn);
}

/// The rule of the user's number, which `creates` what holds it; none for a word that is of that place.
/// Throws UsageError for a place without numbers, and for too few or too many.
std::optional<NumberRule> checkedRule(const json& root, const SetNumber& set, bool creates) {
  if (const std::optional<Mode> mode = modeAt(root, set)) {
    if (mode->takes) return std::nullopt;
    throw UsageError("--set: " + set.pointer +
                     (mode->isFlag ? ": is true or false" : ": is OPAQUE, MASK or BLEND"));
  }
  if (set.word == kNoValue && (isTextureAt(set.pointer) || set.pointer.ends_with("/COLOR_0")))
    return std::nullopt;
  if (set.word.empty() && isTextureAt(set.pointer))
    throw UsageError("--set: " + set.pointer + " takes only 'none', which leaves the texture out");
  if (!set.word.empty()) throw UsageError("--set: " + set.pointer + ": '" + set.word + "' is no number");
  const std::optional<NumberRule> rule =
      creates ? numberRuleAt(set.pointer) : numberRuleIn(root, set.pointer);
  if (!rule)
    throw NotInFile("--set: " + set.pointer + " is no number of the file that is read" +
                    hintFor(root, set.pointer));
  const size_t width = rule->width > 0 ? rule->width : std::max<size_t>(set.values.size(), 1);
  if (set.values.size() != width)
    throw UsageError("--set: " + set.pointer + " takes " + countText(width, "number") + ", not " +
                     std::to_string(set.values.size()));
  return *rule;
}

/// Writes a checked value; a word has no rule.
void writeValue(json& root, const SetNumber& set, const std::optional<NumberRule>& rule) {
  if (set.word == kNoValue) {
    const json::json_pointer place(set.pointer);
    if (root.contains(place)) root[place.parent_pointer()].erase(place.back());
    return;
  }
  if (rule) {
    decomposeMatrixAt(root, set.pointer);
    writeNumbers(root, set.pointer, *rule, set.values);
  } else {
    root[json::json_pointer(set.pointer)] =
        set.word == "true" || set.word == "false" ? json(set.word == "true") : json(set.word);
  }
  const std::string extension = extensionIn(set.pointer);
  if (extension.empty()) return;
  json& used = root["extensionsUsed"];
  if (std::ranges::find(used, json(extension)) == used.end()) used.push_back(extension);
}

/// Returns true if the user says which colour the material has, not what its texture is multiplied by.
bool isColorItself(std::string_view name) { return name == "color" || name == "colour"; }

/// The texture that a colour at that place multiplies: baseColorTexture for baseColorFactor.
std::string textureFor(const std::string& place) {
  return place.substr(0, place.size() - std::string_view("Factor").size()) + "Texture";
}

/// Returns true if the user says a material's colour itself, at that place, where a texture is that it
/// multiplies.
bool tintsTexture(const json& root, const SetNumber& set, const std::string& place) {
  return namesMaterials(set) && place.ends_with("Factor") &&
         root.contains(json::json_pointer(textureFor(place))) &&
         isColorItself(set.pointer.substr(set.pointer.rfind(':') + 1));
}

}  // namespace

std::optional<NumberRule> numberRuleIn(const json& root, const std::string& pointer) {
  const std::optional<NumberRule> rule = numberRuleAt(pointer);
  return rule && isOfSomething(root, pointer) ? rule : std::nullopt;
}

bool decomposeMatrixAt(json& root, const std::string& pointer) {
  const size_t end = pointer.rfind('/');
  const std::string_view member = std::string_view(pointer).substr(end + 1);
  if (!pointer.starts_with("/nodes/") ||
      (member != "translation" && member != "rotation" && member != "scale"))
    return false;
  json& node = root[json::json_pointer(pointer.substr(0, end))];
  if (!node.contains("matrix")) return false;
  glm::dmat4 matrix(1.0);
  for (size_t i = 0; i < 16; ++i) matrix[int(i / 4)][int(i % 4)] = node["matrix"][i].get<double>();
  glm::dmat3 axes(matrix);
  glm::dvec3 scale(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
  if (glm::determinant(axes) < 0.0) scale.x = -scale.x;
  // Axes without length, or not at right angles, are replaced by ones that are.
  const auto unit = [](const glm::dvec3& axis, const glm::dvec3& otherwise) {
    const double length = glm::length(axis);
    return length > 0.0 ? axis / length : otherwise;
  };
  const glm::dvec3 z = unit(axes[2], unit(glm::cross(axes[0], axes[1]), {0.0, 0.0, 1.0}));
  const glm::dvec3 across = axes[1] - glm::dot(axes[1], z) * z;
  const glm::dvec3 aside = std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 y = unit(across, glm::normalize(glm::cross(z, aside)));
  const glm::dquat turn = glm::quat_cast(glm::dmat3(glm::cross(y, z), y, z));
  const glm::dvec3 place(matrix[3]);
  node.erase("matrix");
  node["translation"] = {place.x, place.y, place.z};
  node["rotation"] = {turn.x, turn.y, turn.z, turn.w};
  node["scale"] = {scale.x, scale.y, scale.z};
  return true;
}

void writeNumbers(json& root, const std::string& pointer, const NumberRule& rule,
                  const std::vector<double>& values) {
  json& place = root[json::json_pointer(pointer)];
  if (rule.isFlag) {
    place = values[0] != 0.0;
  } else if (rule.isArray) {
    place = values;
  } else {
    place = values[0];
  }
}

void checkNumbers(const json& root, std::span<const SetNumber> set) {
  for (const SetNumber& one : set) {
    for (const SetNumber& placed : placedValues(root, {&one, 1}))
      checkedRule(root, placed, namesMaterials(one));
  }
}

void writeNumbers(json& root, const std::vector<SetNumber>& set, Diagnostics& diagnostics) {
  for (const SetNumber& one : set) {
    const std::vector<SetNumber> all = placedValues(root, {&one, 1});
    for (const SetNumber& placed : all) {
      writeValue(root, placed, checkedRule(root, placed, namesMaterials(one)));
      if (const char* warning = whatIsBright(placed)) diagnostics.warn(placed.pointer, warning);
      diagnostics.noteSet(placed.pointer);
    }
    for (const SetNumber& placed : all)
      if (tintsTexture(root, one, placed.pointer))
        diagnostics.remark(placed.pointer,
                           "multiplies the texture, which may hold the outline (alphaMode); " +
                               one.pointer.substr(0, one.pointer.rfind(':')) + ":texture=none leaves it out");
  }
}

const char* whatIsBright(const SetNumber& set) {
  const bool isLight = set.pointer.starts_with("/extensions/KHR_lights_punctual/");
  const bool isColor = set.pointer.ends_with(isLight ? "/color" : "/emissiveFactor");
  if (!isColor || set.values.empty() || std::ranges::max(set.values) <= 1.0) return nullptr;
  return isLight ? "is above 1, and drawn so, but glTF has the light's intensity for that"
                 : "is above 1, and drawn so, but glTF has KHR_materials_emissive_strength for that";
}

namespace {

/// Words of people for members of glTF.
constexpr auto kWords = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"color", "baseColorFactor"},
    {"colour", "baseColorFactor"},
    {"metalness", "metallicFactor"},
    {"emission", "emissiveFactor"},
    {"emissive", "emissiveFactor"},
    {"strength", "emissiveStrength"},
    {"emissionStrength", "emissiveStrength"},
    {"index", "ior"},
    {"sheen", "sheenColorFactor"},
    {"anisotropy", "anisotropyStrength"},
    {"texture", "baseColorTexture"},
});
/// Members of a material that hold a word or a flag.
constexpr std::array kModes{"alphaMode", "doubleSided"};
/// An older description of materials, whose members have the same names.
constexpr std::string_view kOlder = "/KHR_materials_pbrSpecularGlossiness/";

/// The place of a material's value by the name of a member, or by a word for it.
std::optional<std::string> placeIn(const std::string& material, const std::string& name) {
  if (std::ranges::find(kModes, name) != kModes.end()) return material + "/" + name;
  const auto* word = std::ranges::find(kWords, name, &std::pair<std::string_view, std::string_view>::first);
  const std::string member = word == kWords.end() ? name : std::string(word->second);
  for (const std::string& one : {member, member + "Factor"}) {
    const std::string direct = std::string(material).append("/").append(one);
    if (numberRuleAt(direct) || isTextureAt(direct)) return direct;
    std::vector<std::string> places = numbersBelow(material, "/" + one);
    if (places.empty() && one.ends_with("Texture")) {
      places = numbersBelow(material, "/" + one + kTurn);
      for (std::string& place : places) place.resize(place.size() - std::string_view(kTurn).size());
    }
    std::erase_if(places, [](const std::string& place) { return place.find(kOlder) != std::string::npos; });
    if (!places.empty()) return places.front();
  }
  return std::nullopt;
}

/// The names that placeIn() knows.
std::vector<std::string> knownNames(const std::string& material) {
  std::vector<std::string> names(kModes.begin(), kModes.end());
  for (const auto& [word, member] : kWords) names.emplace_back(word);
  std::vector<std::string> objects{material, material + "/pbrMetallicRoughness"};
  for (const std::string& extension : numberMembersAt(material + "/extensions"))
    objects.push_back(std::string(material).append("/extensions/").append(extension));
  for (const std::string& object : objects) {
    for (std::string name : numberMembersAt(object)) {
      if (name.ends_with("Factor")) name.resize(name.size() - std::string_view("Factor").size());
      if (placeIn(material, name)) names.push_back(name);
    }
  }
  return names;
}

/// The indices of the materials that a name or pattern says: those that it fits, else the one whose index it
/// is, else those that it fits but for the case of letters, if all of these have the same name.
std::vector<size_t> materialsCalled(const std::string& pattern, const std::vector<std::string>& names) {
  const auto fitting = [&](const std::string& wanted, const auto& asWritten) {
    std::vector<size_t> found;
    for (size_t i = 0; i < names.size(); ++i)
      if (!names[i].empty() && matchesPattern(wanted, asWritten(names[i]))) found.push_back(i);
    return found;
  };
  std::vector<size_t> found = fitting(pattern, [](const std::string& name) { return name; });
  if (!found.empty()) return found;
  if (const auto index = numberOfAll<size_t>(pattern); index && *index < names.size()) return {*index};
  found = fitting(lowered(pattern), [](const std::string& name) { return lowered(name); });
  const auto differs = [&](size_t i) { return names[i] != names[found.front()]; };
  return std::ranges::any_of(found, differs) ? std::vector<size_t>() : found;
}

/// The value at its place. A colour of three numbers keeps the alpha that is there.
SetNumber valueAt(const json& root, const std::string& place, const SetNumber& set) {
  SetNumber placed{place, set.values, set.word};
  constexpr size_t kColor = 3;
  const std::optional<NumberRule> rule = numberRuleAt(place);
  if (rule && rule->width == kColor + 1 && placed.values.size() == kColor) {
    const json::json_pointer at(place + "/3");
    placed.values.push_back(root.contains(at) && root[at].is_number() ? root[at].get<double>() : 1.0);
  }
  return placed;
}

/// Returns true if the material's texture, or colours of vertices, may say by alpha where there is something.
bool holdsOutline(const json& material) { return material.value("alphaMode", "OPAQUE") != "OPAQUE"; }

/// Sets the colour itself of the material with that index. What would multiply it, its texture and the
/// colours of vertices, is taken out, unless that may hold an outline.
void appendColor(const json& root, size_t index, const SetNumber& set, std::vector<SetNumber>& placed) {
  const std::string material = "/materials/" + std::to_string(index);
  const std::string older = material + "/extensions" + std::string(kOlder);
  const bool isOlder = root.contains(json::json_pointer(older.substr(0, older.size() - 1)));
  const std::string place = isOlder ? older + "diffuseFactor" : *placeIn(material, "baseColorFactor");
  placed.push_back(valueAt(root, place, set));
  if (holdsOutline(root["materials"][index])) return;
  const auto takeOut = [&](const std::string& at) {
    if (root.contains(json::json_pointer(at))) placed.push_back({at, {}, kNoValue});
  };
  takeOut(textureFor(place));
  const json meshes = root.value("meshes", json::array());
  for (size_t mesh = 0; mesh < meshes.size(); ++mesh) {
    const json primitives = meshes[mesh].value("primitives", json::array());
    for (size_t i = 0; i < primitives.size(); ++i) {
      if (primitives[i].value("material", json()) != index) continue;
      const std::string primitive = formatted("/meshes/%zu/primitives/%zu", mesh, i);
      takeOut(primitive + "/attributes/COLOR_0");
      takeOut(primitive + "/extensions/KHR_draco_mesh_compression/attributes/COLOR_0");
    }
  }
}

void appendPlaced(const json& root, const SetNumber& set, std::vector<SetNumber>& placed) {
  const size_t colon = set.pointer.rfind(':');
  const std::string pattern = set.pointer.substr(0, colon);
  const std::string name = set.pointer.substr(colon + 1);
  const std::vector<std::string> names = namesOf(memberOf(root, "materials"));
  const std::vector<size_t> called = materialsCalled(pattern, names);
  for (const size_t i : called) {
    const std::string material = "/materials/" + std::to_string(i);
    const std::optional<std::string> place = placeIn(material, name);
    if (!place)
      throw UsageError("--set: " + set.pointer + ": '" + name + "' is no value of a material" +
                       didYouMean(name, knownNames(material)));
    isColorItself(name) ? appendColor(root, i, set, placed) : placed.push_back(valueAt(root, *place, set));
  }
  if (!called.empty()) return;
  throw NotInFile(
      "--set: " + set.pointer + ": no material is called '" + pattern + "'" +
      (names.empty() ? ", and the file has none" : "; the file has " + listOfParts(names, pattern)));
}

/// The place after the letter (UTF-8) at that place.
size_t nextLetter(std::string_view text, size_t at) {
  do ++at;
  while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0u) == 0x80u);
  return at;
}

/// The array, for one more element; one of a wrong type is left to the checks, and gets none.
json* arrayOf(json& object, const char* name) {
  if (object[name].is_null()) object[name] = json::array();
  return object[name].is_array() ? &object[name] : nullptr;
}

/// Appends the element, and returns its index.
size_t append(json& object, const char* name, json element) {
  json* array = arrayOf(object, name);
  if (array == nullptr) return 0;
  array->push_back(std::move(element));
  return array->size() - 1;
}

void useExtension(json& root, const char* name) {
  json* used = arrayOf(root, "extensionsUsed");
  if (used != nullptr && std::ranges::find(*used, json(name)) == used->end()) used->push_back(name);
}

/// The matrix of a node at a place of the space that is drawn, whose Z axis has this direction there.
json matrixOf(const glm::dvec3& place, const glm::dvec3& direction, const glm::dvec3& up) {
  const glm::dvec3 z = glm::normalize(direction);
  const glm::dvec3 upward = std::abs(z.y) < 0.999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
  const glm::dvec3 x = glm::normalize(glm::cross(upward, z));
  const glm::dmat3 toFile = glm::transpose(turnToY(up));
  json numbers = json::array();
  for (const glm::dvec3& axis : {x, glm::cross(z, x), z}) {
    const glm::dvec3 turned = toFile * axis;
    for (const double number : {turned.x, turned.y, turned.z, 0.0}) numbers.push_back(number);
  }
  const glm::dvec3 turned = toFile * place;
  for (const double number : {turned.x, turned.y, turned.z, 1.0}) numbers.push_back(number);
  return numbers;
}

/// The bytes of floats as a data URI.
std::string uriOf(std::span<const float> values) {
  std::string text = "data:application/octet-stream,";
  for (const std::byte byte : std::as_bytes(values)) text += formatted("%%%02x", unsigned(byte));
  return text;
}

/// A material that is black but for the light that it sends, the same in all directions of one side.
json shining(const AddedLight& light, const std::string& name) {
  const double most = std::max({light.color.x, light.color.y, light.color.z});
  const double radiance = light.strength / (glm::pi<double>() * light.size.x * light.size.y);
  const glm::dvec3 color = light.color / most;
  return {{"name", name},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
          {"emissiveFactor", {color.x, color.y, color.z}},
          {"extensions",
           {{"KHR_materials_emissive_strength", {{"emissiveStrength", radiance * most}}},
            {"KHR_materials_specular", {{"specularFactor", 0}}}}}};
}

/// The mesh of an area.
size_t addArea(json& root, const AddedLight& light, const std::string& name) {
  const auto x = float(0.5 * light.size.x);
  const auto y = float(0.5 * light.size.y);
  const std::array<float, 18> corners{-x, -y, 0, x, -y, 0, x, y, 0, -x, -y, 0, x, y, 0, -x, y, 0};
  const size_t bytes = sizeof corners;
  const size_t buffer = append(root, "buffers", {{"byteLength", bytes}, {"uri", uriOf(corners)}});
  const size_t view = append(root, "bufferViews", {{"buffer", buffer}, {"byteLength", bytes}});
  const size_t positions = append(root, "accessors",
                                  {{"bufferView", view},
                                   {"componentType", 5126u},
                                   {"count", corners.size() / 3},
                                   {"type", "VEC3"},
                                   {"min", {-x, -y, 0}},
                                   {"max", {x, y, 0}}});
  const size_t material = append(root, "materials", shining(light, name));
  for (const char* used : {"KHR_materials_emissive_strength", "KHR_materials_specular"})
    useExtension(root, used);
  json primitive = {{"attributes", {{"POSITION", positions}}}, {"material", material}};
  return append(root, "meshes", {{"primitives", json::array({primitive})}});
}

/// The index of the light of a sun.
size_t addSun(json& root, const AddedLight& light, const std::string& name) {
  constexpr const char* kPunctual = "KHR_lights_punctual";
  useExtension(root, kPunctual);
  if (!root["extensions"].is_object()) root["extensions"] = json::object();
  json& punctual = root["extensions"][kPunctual];
  if (!punctual.is_object()) punctual = json::object();
  return append(punctual, "lights",
                {{"name", name},
                 {"type", "directional"},
                 {"color", {light.color.x, light.color.y, light.color.z}},
                 {"intensity", light.strength}});
}

json nodeOf(json& root, const AddedLight& light, const std::string& name, const glm::dvec3& up) {
  if (!light.isSun) {
    const glm::dvec3 faces = light.target ? *light.target - light.at : glm::dvec3(0, -1, 0);
    return {{"name", name}, {"mesh", addArea(root, light, name)}, {"matrix", matrixOf(light.at, faces, up)}};
  }
  const glm::dvec2 angles = glm::radians(light.from);
  const glm::dvec3 towards(std::cos(angles.y) * std::sin(angles.x), std::sin(angles.y),
                           std::cos(angles.y) * std::cos(angles.x));
  json node = {{"name", name}, {"matrix", matrixOf(glm::dvec3(0.0), towards, up)}};
  node["extensions"]["KHR_lights_punctual"]["light"] = addSun(root, light, name);
  return node;
}

}  // namespace

bool namesMaterials(const SetNumber& set) { return !set.pointer.starts_with('/'); }

bool matchesPattern(std::string_view pattern, std::string_view text) {
  size_t at = 0;                         // in the pattern
  size_t star = std::string_view::npos;  // after the last *
  size_t taken = 0;                      // the end of what that one stands for
  for (size_t i = 0; i < text.size() || at < pattern.size();) {
    const bool isQuoted = at + 1 < pattern.size() && pattern[at] == '\\';
    if (at < pattern.size() && pattern[at] == '*') {
      star = ++at;
      taken = i;
    } else if (at < pattern.size() && i < text.size() && pattern[at] == '?') {
      ++at;
      i = nextLetter(text, i);
    } else if (at < pattern.size() && i < text.size() && pattern[at + (isQuoted ? 1 : 0)] == text[i]) {
      at += isQuoted ? 2 : 1;
      ++i;
    } else if (star != std::string_view::npos && taken < text.size()) {
      at = star;
      i = ++taken;
    } else {
      return false;
    }
  }
  return true;
}

std::vector<SetNumber> placedValues(const json& root, std::span<const SetNumber> set) {
  std::vector<SetNumber> placed;
  for (const SetNumber& one : set) {
    if (namesMaterials(one))
      appendPlaced(root, one, placed);
    else
      placed.push_back(one);
  }
  return placed;
}

std::string extensionIn(std::string_view pointer) {
  constexpr std::string_view kExtensions = "/extensions/";
  const size_t at = pointer.rfind(kExtensions);
  if (at == std::string_view::npos || !pointer.starts_with("/materials/")) return "";
  const std::string_view rest = pointer.substr(at + kExtensions.size());
  return std::string(rest.substr(0, rest.find('/')));
}

void addLights(json& root, std::span<const AddedLight> lights, const glm::dvec3& up) {
  for (size_t i = 0; i < lights.size(); ++i) {
    const std::string name = (lights[i].isSun ? "added sun " : "added area ") + std::to_string(i + 1);
    const size_t node = append(root, "nodes", nodeOf(root, lights[i], name, up));
    if (!root.contains("scenes")) continue;  // then all nodes are drawn
    for (json& scene : root["scenes"]) {
      if (scene.is_object()) append(scene, "nodes", node);
    }
  }
}

}  // namespace fragtrace
