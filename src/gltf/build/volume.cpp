// SPDX-License-Identifier: MIT
#include <algorithm>

#include "base/text.h"
#include "gltf/build/placed.h"
#include "gltf/read/value.h"

namespace fragtrace {
namespace {

constexpr const char* kName = "fragtrace_volume";
constexpr std::string_view kMembers[] = {"volume", "position",   "scale",   "density",
                                         "color",  "anisotropy", "emission"};

/// Reads one group of numbers of the volume.
class Numbers {
 public:
  Numbers(Diagnostics& diagnostics, std::string place, const tinygltf::Value& object)
      : diagnostics_(diagnostics), place_(std::move(place)), object_(object) {}

  std::optional<double> number(const char* name, double least, double most) const {
    if (!memberOf(object_, name).IsNumber()) return std::nullopt;
    return checked(name, numberOf(object_, name, 0.0), least, most);
  }

  std::optional<glm::dvec3> vector(const char* name, double least, double most) const {
    const std::vector<double> values = numbersOf(object_, name, {});
    if (values.empty()) return std::nullopt;
    glm::dvec3 result;
    for (int axis = 0; axis < 3; ++axis) result[axis] = checked(name, values.at(size_t(axis)), least, most);
    return result;
  }

 private:
  double checked(const char* name, double value, double least, double most) const {
    if (!(value >= least && value <= most))
      diagnostics_.refuse(place_ + "/" + name,
                          "is not in the range " + shortText(least) + " to " + shortText(most));
    return value;
  }

  Diagnostics& diagnostics_;
  std::string place_;
  const tinygltf::Value& object_;
};

}  // namespace

std::optional<Volume> volumeAt(Document& document, const PlacedNode& node) {
  const tinygltf::Node& source = document.model.nodes.at(size_t(node.index));
  const tinygltf::Value& object = memberOf(source.extras, kName);
  if (!object.IsObject()) return std::nullopt;
  const std::string place = pointerTo("nodes", node.index, "extras", kName);
  const Numbers numbers(document.diagnostics, place, object);
  const tinygltf::Value& named = memberOf(object, "volume");
  for (const std::string& key : object.Keys()) {
    if (std::ranges::find(kMembers, key) == std::end(kMembers))
      document.diagnostics.warn(pointerTo("nodes", node.index, "extras", kName, key),
                                "is no member of a volume and is ignored");
  }
  Volume volume;
  volume.source = volumeFile(named.IsString() ? named.Get<std::string>() : "");
  if (volume.source.file.empty()) document.diagnostics.refuse(place + "/volume", "names no file");
  volume.source.position = numbers.vector("position", -kFarthest, kFarthest);
  volume.source.scale = numbers.number("scale", kLeastVolumeScale, kMostVolumeScale);
  volume.source.density = numbers.number("density", 0.0, kMostVolumeFactor);
  if (const auto color = numbers.vector("color", 0.0, 1.0)) volume.source.color = glm::vec3(*color);
  volume.source.anisotropy = numbers.number("anisotropy", -kMostAnisotropy, kMostAnisotropy);
  volume.source.emission = numbers.number("emission", 0.0, kMostVolumeFactor);
  volume.toWorld = node.world;
  const std::string uri = volume.source.file.string();
  volume.file = document.diagnostics.attempt(place + "/volume",
                                             [&] { return readUri(document.access, uri, document.memory); });
  takeMemory(document, place + "/volume", volume.file.size());
  volume.source.file = isDataUri(uri) ? std::filesystem::path(place) : pathOfUri(document.access, uri);
  return volume;
}

}  // namespace fragtrace
