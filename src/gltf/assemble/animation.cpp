// SPDX-License-Identifier: MIT
#include "gltf/assemble/animation.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "gltf/assemble/numbers.h"
#include "gltf/read/accessor.h"
#include "gltf/read/json.h"

namespace fragtrace {
namespace {

using nlohmann::json;

double lengthOf(const std::vector<double>& v) {
  double squared = 0.0;
  for (const double x : v) squared += x * x;
  return std::sqrt(squared);
}

/// Unit, or as it is where it has no direction.
void normalize(std::vector<double>& quaternion) {
  const double length = lengthOf(quaternion);
  if (!(length > 0.0) || !std::isfinite(length)) return;
  for (double& x : quaternion) x /= length;
}

/// Weights of two unit quaternions at `part` of the shorter way between them (glTF 2.0, appendix C.4).
struct Blend {
  double a, b;
};

Blend sphericalBlend(double dot, double part) {
  constexpr double kNearlyOne = 1.0 - 1e-9;  // there the sine is the angle
  const double sign = dot < 0.0 ? -1.0 : 1.0;
  const double cosine = std::min(std::abs(dot), 1.0);
  if (cosine > kNearlyOne) return {1.0 - part, sign * part};
  const double angle = std::acos(cosine);
  return {std::sin(angle * (1.0 - part)) / std::sin(angle), sign * std::sin(angle * part) / std::sin(angle)};
}

std::vector<double> numbersAt(const Keyframes& keys, size_t first) {
  const auto begin = keys.values.begin() + std::ptrdiff_t(first);
  return {begin, begin + std::ptrdiff_t(keys.width)};
}

std::vector<double> valueOfKey(const Keyframes& keys, size_t key) {
  const bool isCubic = keys.interpolation == Interpolation::CubicSpline;
  return numbersAt(keys, isCubic ? (3 * key + 1) * keys.width : key * keys.width);
}

/// glTF 2.0, appendix C.5.
std::vector<double> splineAt(const Keyframes& keys, size_t key, double part, double duration) {
  const std::vector<double> from = valueOfKey(keys, key);
  const std::vector<double> to = valueOfKey(keys, key + 1);
  const std::vector<double> out = numbersAt(keys, (3 * key + 2) * keys.width);
  const std::vector<double> in = numbersAt(keys, (3 * key + 3) * keys.width);
  const double s = part, s2 = s * s, s3 = s2 * s;
  std::vector<double> result(keys.width);
  for (size_t i = 0; i < keys.width; ++i) {
    result[i] = (2 * s3 - 3 * s2 + 1) * from[i] + duration * (s3 - 2 * s2 + s) * out[i] +
                (-2 * s3 + 3 * s2) * to[i] + duration * (s3 - s2) * in[i];
  }
  return result;
}

std::vector<double> blended(std::vector<double> from, std::vector<double> to, double part, bool isRotation) {
  Blend blend{1.0 - part, part};
  if (isRotation) {
    normalize(from);
    normalize(to);
    double dot = 0.0;
    for (size_t i = 0; i < from.size(); ++i) dot += from[i] * to[i];
    blend = sphericalBlend(dot, part);
  }
  for (size_t i = 0; i < from.size(); ++i) from[i] = blend.a * from[i] + blend.b * to[i];
  return from;
}

Interpolation interpolationNamed(const std::string& name) {
  if (name == "STEP") return Interpolation::Step;
  return name == "CUBICSPLINE" ? Interpolation::CubicSpline : Interpolation::Linear;
}

/// Times of the keys, checked.
std::vector<float> readTimes(Document& document, const Channel& channel) {
  const std::string place = channel.sampler + "/input";
  Diagnostics& diagnostics = document.diagnostics;
  const tinygltf::Accessor& accessor = document.model.accessors.at(size_t(channel.input));
  if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
    diagnostics.lose(place, "is not of floats of type SCALAR");
  const size_t count = accessorCount(document, channel.input);
  if (count == 0) diagnostics.lose(place, "has no keys");
  takeMemory(document, place, count * sizeof(float));
  std::vector<float> times = readComponents(document, channel.input, 1, place);
  size_t equal = 0;
  for (size_t i = 0; i < times.size(); ++i) {
    const std::string key = "key " + std::to_string(i);
    if (!std::isfinite(times[i])) diagnostics.lose(place, key + " is not finite");
    if (i > 0 && times[i] < times[i - 1]) diagnostics.lose(place, key + " is not later than the one before");
    equal += i > 0 && times[i] == times[i - 1];
  }
  if (equal > 0) diagnostics.warn(place, "a key at the time of the one before replaces it", equal);
  return times;
}

/// Values of a channel that drives `width` numbers; a width of 0 is any.
Keyframes readKeyframes(Document& document, const Channel& channel, const NumberRule& rule) {
  const bool isArray = rule.width == 0;
  Diagnostics& diagnostics = document.diagnostics;
  const std::string place = channel.place + "/sampler";
  diagnostics.need(channel.sampler);
  if (channel.input < 0) diagnostics.lose(place, "is past the samplers of its animation");
  Keyframes keys;
  keys.interpolation = rule.isFlag ? Interpolation::Step : interpolationNamed(channel.interpolation);
  keys.times = readTimes(document, channel);
  const size_t count = accessorCount(document, channel.output);
  const bool isStill = keys.interpolation == Interpolation::CubicSpline && keys.times.size() < 2;
  if (isStill && count % 3 != 0) keys.interpolation = Interpolation::Linear;  // a value without tangents
  const bool isCubic = keys.interpolation == Interpolation::CubicSpline;
  const size_t perKey = keys.times.size() * (isCubic ? 3 : 1);
  keys.width = isArray ? count / perKey : rule.width;
  if (count != perKey * (isArray ? keys.width : 1) || keys.width == 0) {
    diagnostics.lose(place, std::to_string(count) + " elements do not fit its " +
                                std::to_string(keys.times.size()) + " keys");
  }
  if (isStill)
    diagnostics.warn(channel.sampler + "/input",
                     "is the only key of a spline, which therefore does not move");
  takeMemory(document, place, count * (isArray ? 1 : rule.width) * sizeof(float));
  keys.isRotation = channel.target.starts_with("/nodes/") && channel.target.ends_with("/rotation");
  keys.isScale = channel.target.starts_with("/nodes/") && channel.target.ends_with("/scale");
  const bool isFraction = keys.isRotation || channel.target.ends_with("/weights");
  keys.values = readComponents(document, channel.output, isArray ? 1 : int(rule.width), place,
                               rule.isFlag  ? Integers::Whole
                               : isFraction ? Integers::Fractions
                                            : Integers::Numbers);
  if (!std::all_of(keys.values.begin(), keys.values.end(), [](float v) { return std::isfinite(v); }))
    diagnostics.lose(place, "holds a number that is not finite");
  return keys;
}

/// Warns of rotations that are far from unit; they are normalized wherever they are read.
void checkRotations(const Keyframes& keys, const Channel& channel, Diagnostics& diagnostics) {
  constexpr double kRoundedToBytes = 0.00788;  // four components, each off by half of 1 / 127
  size_t count = 0;
  for (size_t key = 0; key < keys.times.size(); ++key) {
    const double length = lengthOf(valueOfKey(keys, key));
    count += length != 0.0 && !(std::abs(length - 1.0) <= kRoundedToBytes);
  }
  if (count > 0)
    diagnostics.warn(channel.place + "/sampler", "a rotation that is no unit quaternion is normalized",
                     count);
}

/// The keys from the last cut before a moment to the next one after it.
Keyframes pieceAt(const Keyframes& keys, double moment) {
  const auto isCut = [&](size_t key) {
    return keys.interpolation == Interpolation::Step || keys.times[key] == keys.times[key - 1];
  };
  const auto next = std::upper_bound(keys.times.begin(), keys.times.end(), moment);
  size_t first = size_t(std::max<std::ptrdiff_t>(next - keys.times.begin(), 1)) - 1;
  size_t end = first + 1;
  while (first > 0 && !isCut(first)) --first;
  while (end < keys.times.size() && !isCut(end)) ++end;
  const size_t perKey = keys.width * (keys.interpolation == Interpolation::CubicSpline ? 3 : 1);
  Keyframes piece{keys.interpolation, keys.isRotation, keys.width, {}, {}, keys.isScale};
  piece.times.assign(keys.times.begin() + std::ptrdiff_t(first), keys.times.begin() + std::ptrdiff_t(end));
  piece.values.assign(keys.values.begin() + std::ptrdiff_t(first * perKey),
                      keys.values.begin() + std::ptrdiff_t(end * perKey));
  return piece;
}

/// Returns the value that lies as far from `at` as `value` does, the other way. A scale keeps its sign.
std::vector<double> mirroredAt(const Keyframes& keys, const std::vector<double>& at,
                               std::vector<double> value) {
  if (keys.isRotation) {
    const glm::dquat q(at[3], at[0], at[1], at[2]);
    const glm::dquat turned = q * glm::conjugate(glm::dquat(value[3], value[0], value[1], value[2])) * q;
    return {turned.x, turned.y, turned.z, turned.w};
  }
  for (size_t i = 0; i < value.size(); ++i) {
    value[i] = 2.0 * at[i] - value[i];
    if (keys.isScale && value[i] * at[i] <= 0.0) value[i] = at[i];
  }
  return value;
}

/// The number of weights that a mesh has targets for; none where the target is no weights.
std::optional<size_t> weightsAt(const json& root, const std::string& target) {
  if (!target.ends_with("/weights")) return std::nullopt;
  const json& holder = root[json::json_pointer(target).parent_pointer()];
  const json& mesh =
      target.starts_with("/nodes/") ? elementOf(root, "meshes", memberOf(holder, "mesh")) : holder;
  size_t most = 0;
  for (const json& primitive : memberOf(mesh, "primitives"))
    most = std::max(most, memberOf(primitive, "targets").size());
  return most;
}

/// The numbers of a node that the loader reads at this member of its JSON; null: another member.
std::vector<double>* numbersOfNode(tinygltf::Node& node, std::string_view member) {
  if (member == "translation") return &node.translation;
  if (member == "rotation") return &node.rotation;
  if (member == "scale") return &node.scale;
  return member == "weights" ? &node.weights : nullptr;
}

/// A member of a node, "/nodes/3/scale"; none: the pointer leads elsewhere.
struct NodeMember {
  size_t node;
  std::string_view member;
};

std::optional<NodeMember> nodeMemberAt(std::string_view pointer) {
  if (!pointer.starts_with("/nodes/")) return std::nullopt;
  cutPart(pointer);
  const std::string_view index = cutPart(pointer);
  NodeMember found{};
  if (std::from_chars(index.data(), index.data() + index.size(), found.node).ec != std::errc())
    return std::nullopt;
  found.member = pointer.substr(std::min<size_t>(pointer.size(), 1));
  return found;
}

void applyChannel(Document& document, const Channel& channel, double seconds,
                  const std::optional<OpenShutter>& shutter, bool inModel) {
  json& root = *document.root;
  document.diagnostics.need(channel.place);
  const std::optional<NumberRule> rule =
      channel.target.empty() ? std::nullopt : numberRuleIn(root, channel.target);
  const std::string place = channel.place + "/target";
  if (!rule) {
    const std::string named = channel.target.empty() ? "" : ": " + inQuotes(channel.target);
    document.diagnostics.warn(place, "is nothing that can be animated" + named + "; the channel is ignored");
    return;
  }
  const Keyframes keys = readKeyframes(document, channel, *rule);
  if (const size_t targets = weightsAt(root, channel.target).value_or(keys.width); targets < keys.width)
    document.diagnostics.warn(place, "drives " + countText(keys.width, "weight") + " of a mesh with " +
                                         countText(targets, "morph target"));
  document.keyTimes.insert(document.keyTimes.end(), keys.times.begin(), keys.times.end());
  if (keys.isRotation) checkRotations(keys, channel, document.diagnostics);
  std::vector<double> values = shutter ? valuesWhileOpen(keys, seconds, *shutter) : valuesAt(keys, seconds);
  if (keys.isRotation && lengthOf(values) == 0.0) {
    document.diagnostics.warn(channel.place + "/sampler", "a quaternion of zeros is read as no rotation");
    values = {0.0, 0.0, 0.0, 1.0};
  }
  if (inModel && isMemberOfNode(channel.target, root)) {
    const NodeMember driven = *nodeMemberAt(channel.target);
    *numbersOfNode(document.model.nodes.at(driven.node), driven.member) = std::move(values);
    return;
  }
  if (decomposeMatrixAt(root, channel.target))
    document.diagnostics.warn(place, "has a node with a matrix, which is taken apart to be animated");
  writeNumbers(root, channel.target, *rule, values);
}

/// The paths of nodes are short forms of pointers (KHR_animation_pointer).
std::string targetOf(const json& target) {
  const json::json_pointer pointer("/extensions/KHR_animation_pointer/pointer");
  const auto& path = target["path"].get_ref<const std::string&>();
  if (path == "pointer")
    return target.contains(pointer) && !target.contains("node") ? target[pointer].get<std::string>() : "";
  return target.contains("node") ? pointerTo("nodes", target["node"].get<size_t>(), path) : "";
}

Channel channelOf(const json& channel, const json& samplers, const std::string& animation,
                  const std::string& place) {
  const auto index = channel["sampler"].get<size_t>();
  Channel result;
  result.place = place;
  result.target = targetOf(channel["target"]);
  result.sampler = animation + "/samplers/" + std::to_string(index);
  if (index >= samplers.size()) return result;
  const json& sampler = samplers[index];
  result.interpolation = sampler.value("interpolation", std::string("LINEAR"));
  result.input = sampler.value("input", -1);
  result.output = sampler.value("output", -1);
  return result;
}

}  // namespace

std::vector<Animation> takeAnimations(json& root) {
  std::vector<Animation> animations;
  for (const json& animation : root["animations"]) {
    const std::string place = pointerTo("animations", animations.size());
    Animation result{animation.value("name", std::string()), {}};
    const json& channels = animation["channels"];
    for (size_t i = 0; i < channels.size(); ++i) {
      result.channels.push_back(
          channelOf(channels[i], animation["samplers"], place, place + "/channels/" + std::to_string(i)));
    }
    animations.push_back(std::move(result));
  }
  root.erase("animations");
  return animations;
}

std::optional<double> durationOf(const json& animation, const json& accessors) {
  std::optional<double> duration;
  for (const json& sampler : animation["samplers"]) {
    if (!sampler.contains("input")) continue;  // it is lost
    const json& times = accessors[sampler["input"].get<size_t>()];
    if (!times.contains("max") || times["max"].empty() || !times["max"][0].is_number()) return std::nullopt;
    duration = std::max(duration.value_or(0.0), times["max"][0].get<double>());
  }
  return duration;
}

std::vector<double> valuesAt(const Keyframes& keys, double seconds) {
  const auto next = std::upper_bound(keys.times.begin(), keys.times.end(), seconds);
  std::vector<double> values;
  if (next == keys.times.begin()) {
    values = valueOfKey(keys, 0);
  } else {
    const size_t key = size_t(next - keys.times.begin()) - 1;
    const bool isLast = next == keys.times.end();
    const double duration = isLast ? 0.0 : double(*next) - double(keys.times[key]);
    const double part = isLast ? 0.0 : (seconds - double(keys.times[key])) / duration;
    if (isLast || keys.interpolation == Interpolation::Step) {
      values = valueOfKey(keys, key);
    } else if (keys.interpolation == Interpolation::CubicSpline) {
      values = splineAt(keys, key, part, duration);
    } else {
      values = blended(valueOfKey(keys, key), valueOfKey(keys, key + 1), part, keys.isRotation);
    }
  }
  if (keys.isRotation) normalize(values);
  return values;
}

std::vector<double> valuesWhileOpen(const Keyframes& keys, double seconds, const OpenShutter& shutter) {
  constexpr double kSame = 1e-6;  // as near as the time of a picture and a key of floats are
  const Keyframes piece = pieceAt(keys, shutter.moment);
  const double first = piece.times.front();
  const double last = piece.times.back();
  const bool isCutBefore = first != keys.times.front() || first <= shutter.firstKey + kSame;
  const bool isCutAfter = last != keys.times.back() || last >= shutter.lastKey - kSame;
  const bool isBefore = isCutBefore && seconds < first && shutter.moment >= first - kSame;
  const bool isAfter = isCutAfter && seconds > last && shutter.moment <= last + kSame;
  if (!isBefore && !isAfter) return valuesAt(piece, seconds);
  const double at = isBefore ? first : last;
  return mirroredAt(keys, valuesAt(piece, at), valuesAt(piece, 2.0 * at - seconds));
}

bool isMemberOfNode(const std::string& pointer, const json& root) {
  tinygltf::Node none;
  const std::optional<NodeMember> driven = nodeMemberAt(pointer);
  return driven && numbersOfNode(none, driven->member) != nullptr &&
         !elementOf(root, "nodes", json(driven->node)).contains("matrix");
}

void applyAnimation(Document& document, const Animation& animation, double seconds,
                    const std::optional<OpenShutter>& shutter, bool inModel) {
  for (const Channel& channel : animation.channels) {
    document.diagnostics.keepRest("the channel", [&] {
      applyChannel(document, channel, seconds, shutter, inModel);
      return true;
    });
  }
}

}  // namespace fragtrace
