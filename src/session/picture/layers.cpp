// SPDX-License-Identifier: MIT
#include "session/picture/layers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/errors.h"
#include "base/text.h"
#include "image/channels.h"
#include "shader/layout.h"

namespace fragtrace {

namespace {

/// Light that is dimmed by this factor vanishes in the rounding of any sum. It is not 0, since the shader
/// leaves out the shadow rays of light samples that are 0, and with them random numbers.
constexpr float kDimmed = 0x1p-60f;

constexpr const char* kSurroundings = "environment";
constexpr const char* kRest = "rest";

bool isLit(const Material& material) { return material.emissive() || material.unlit; }

/// The light or emissive material that a group may have, by its JSON pointer and its names, which may be
/// empty.
struct Lamp {
  std::string place, name, otherName;
};

std::vector<Lamp> lampsOf(const Scene& scene) {
  std::vector<Lamp> lamps;
  for (const Light& light : scene.lights)
    lamps.push_back({light.place, scene.lightSources[light.source].name, light.node});
  for (const Material& material : scene.materials) {
    if (isLit(material)) lamps.push_back({material.place, material.name, ""});
  }
  return lamps;
}

/// The names of all that can be a group; places where a name is that of several.
std::string namesIn(const Scene& scene) {
  std::map<std::string, std::vector<std::string>> places;
  for (const Lamp& lamp : lampsOf(scene)) {
    const std::string& name = lamp.name.empty() ? lamp.otherName : lamp.name;
    places[name.empty() ? lamp.place : name].push_back(lamp.place);
  }
  std::set<std::string> names{kSurroundings, kRest};
  for (const auto& [name, of] : places) {
    names.insert(name);
    if (of.size() > 1) names.insert(of.begin(), of.end());
  }
  return joined(names);
}

/// Multiplies the first three numbers of a row.
void scaleRow(Words& words, size_t row, float factor) {
  for (size_t i = row * 4; i < row * 4 + 3; ++i)
    words[i] = std::bit_cast<uint32_t>(std::bit_cast<float>(words[i]) * factor);
}

}  // namespace

LightGroups lightGroupsOf(const RenderOptions& options, const Scene& scene) {
  const std::vector<std::string>& names = options.output.lightGroups;
  std::vector<bool> found(names.size(), false);
  const auto indexOf = [&](const std::string& name) -> std::optional<size_t> {
    const auto place = std::ranges::find(names, name);
    if (name.empty() || place == names.end()) return std::nullopt;
    found[size_t(place - names.begin())] = true;
    return size_t(place - names.begin());
  };
  LightGroups groups;
  const std::optional<size_t> rest = indexOf(kRest);
  // A light has a place and two names. Several may be groups: then it belongs to the first.
  const auto groupOf = [&](const std::string& place, const std::string& first, const std::string& second) {
    for (const std::string& name : {place, first, second}) {
      const bool reserved = name == kSurroundings || name == kRest;
      const std::optional<size_t> named = reserved ? std::nullopt : indexOf(name);
      if (named) return named;
    }
    return rest;
  };
  for (const Material& material : scene.materials)
    groups.ofMaterials.push_back(isLit(material) ? groupOf(material.place, material.name, "") : std::nullopt);
  for (const Light& light : scene.lights)
    groups.ofLights.push_back(groupOf(light.place, scene.lightSources[light.source].name, light.node));
  const std::optional<size_t> surroundings = indexOf(kSurroundings);
  groups.ofSurroundings = surroundings ? surroundings : rest;
  groups.ofVolume = rest;
  for (size_t i = 0; i < names.size(); ++i) {
    if (!found[i])
      throw UsageError("--aov light:" + names[i] + ": " + options.scene.string() +
                       " has no light and no emissive material of that name, but " + namesIn(scene));
  }
  return groups;
}

std::vector<std::string> sharedGroups(const RenderOptions& options, const Scene& scene) {
  std::vector<std::string> lines;
  for (const std::string& group : options.output.lightGroups) {
    std::vector<std::string> places;
    for (const Lamp& lamp : lampsOf(scene)) {
      if (lamp.name == group || lamp.otherName == group) places.push_back("light:" + lamp.place);
    }
    if (places.size() > 1)
      lines.push_back("--aov light:" + group + ": one layer of " + std::to_string(places.size()) +
                      " lights of that name, each of which is " + joined(places));
  }
  return lines;
}

void showLights(const Tracer& tracer, const Scene& scene, const LightGroups& groups,
                std::optional<size_t> group) {
  GpuScene dimmed;
  dimmed.unchanged.fill(true);
  Words& materials = dimmed.buffers[layout::kMaterialsBinding] = tracer.materials;
  Words& lights = dimmed.buffers[layout::kLightsBinding] = tracer.lights;
  dimmed.unchanged[layout::kMaterialsBinding] = false;
  dimmed.unchanged[layout::kLightsBinding] = false;
  for (size_t i = 0; group && i < groups.ofMaterials.size(); ++i) {
    if (groups.ofMaterials[i] == group) continue;
    const size_t row = i * layout::kMaterialRows;
    scaleRow(materials, row + layout::kMaterialEmission, kDimmed);
    // The base colour of such a surface is its light.
    if (scene.materials[i].unlit) scaleRow(materials, row, kDimmed);
  }
  for (size_t i = 0; group && i < groups.ofLights.size() && !lights.empty(); ++i) {
    if (groups.ofLights[i] != group) scaleRow(lights, i * layout::kLightRows, kDimmed);
  }
  tracer.renderer->replaceArrays(std::move(dimmed));
}

View viewOfGroup(const View& view, const LightGroups& groups, size_t group) {
  View dimmed = view;
  if (groups.ofSurroundings != group) dimmed.surroundings = kDimmed;
  if (groups.ofVolume != group)
    dimmed.volume.source.emission = dimmed.volume.source.emission.value_or(0.0) * kDimmed;
  return dimmed;
}

void dropDimmed(Image& layer, const Image& picture) {
  constexpr float kNothing = 0x1p-50f;
  const size_t colors = layer.channelCount();
  for (size_t i = 0; i < layer.values.size(); ++i) {
    const float all = picture.values[i / colors * picture.channelCount() + i % colors];
    if (layer.values[i] < kNothing * all) layer.values[i] = 0.0f;
  }
}

namespace {

std::string nameOf(const Material& material) {
  if (!material.name.empty()) return material.name;
  return material.place.empty() ? "default" : material.place;
}

/// Ids by the numbers that the shader writes.
std::map<uint32_t, uint32_t> idsOf(Aov aov, const Scene& scene) {
  std::map<uint32_t, uint32_t> ids;
  if (aov == Aov::CryptoMaterial) {
    for (const Material& material : scene.materials) ids[material.number] = matteId(nameOf(material));
  } else {
    for (const SceneNode& node : scene.nodes) ids[node.index + 1] = matteId(node.name);
  }
  return ids;
}

void count(std::vector<MatteShare>& shares, uint32_t id) {
  const auto found = std::ranges::find(shares, id, &MatteShare::id);
  if (found == shares.end())
    shares.push_back({id, 1});
  else
    ++found->samples;
}

}  // namespace

std::string matteLayer(Aov aov) { return aov == Aov::CryptoObject ? "CryptoObject" : "CryptoMaterial"; }

std::vector<std::string> namesOfMatte(Aov aov, const Scene& scene) {
  std::vector<std::string> names;
  if (aov == Aov::CryptoMaterial) {
    for (const Material& material : scene.materials) names.push_back(nameOf(material));
  } else {
    for (const SceneNode& node : scene.nodes) {
      if (node.mesh) names.push_back(node.name);
    }
  }
  return names;
}

LayerDraw drawMattes(glm::ivec2 size, Renderer& renderer, const ShaderVariant& variant, const View& view,
                     int samples, const Scene& scene, const Renderer::Progress& progress) {
  const std::map<uint32_t, uint32_t> ids = idsOf(variant.aov, scene);
  LayerDraw layer;
  Film film(size);
  layer.compileMs = useOrCompile(renderer, variant, film, view);
  std::vector<std::vector<MatteShare>> shares(size_t(size.x) * size_t(size.y));
  std::vector<double> before(shares.size(), 0.0);
  FilmPixels pixels;
  for (int i = 0; i < samples && layer.complete; ++i) {
    layer.complete = renderer.addSamples(film, view, i, i + 1, layer.times,
                                         [&](double fraction) { return progress((i + fraction) / samples); });
    pixels = {};
    pixels = film.read();
    for (size_t p = 0; p < shares.size(); ++p) {
      // Sums are exact: the film compensates for the rounding of large ones.
      const double sum = pixels.pixels[p].sum.x;
      const auto number = uint32_t(std::lround(sum - std::exchange(before[p], sum)));
      if (const auto id = ids.find(number); id != ids.end()) count(shares[p], id->second);
    }
  }
  layer.totals = totalsOf(pixels);
  layer.image = {size.x, size.y, matteChannels(matteLayer(variant.aov)), {}, {}};
  layer.image.values.reserve(shares.size() * 2 * kMatteRanks);
  for (int y = size.y - 1; y >= 0; --y) {
    for (int x = 0; x < size.x; ++x) {
      const size_t p = size_t(y) * size_t(size.x) + size_t(x);
      appendRanks(shares[p], pixels.pixels[p].samples, layer.image.values);
    }
  }
  return layer;
}

}  // namespace fragtrace
