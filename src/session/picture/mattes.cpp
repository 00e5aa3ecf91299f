// SPDX-License-Identifier: MIT
#include "session/picture/mattes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "image/cryptomatte.h"

namespace fragtrace {

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
