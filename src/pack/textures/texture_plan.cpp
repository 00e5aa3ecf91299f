// SPDX-License-Identifier: MIT
#include "pack/textures/texture_plan.h"

#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <tuple>

#include <glm/gtc/constants.hpp>

#include "shader/layout.h"

namespace fragtrace {

namespace {

constexpr double kLeast = 1e-6;  // of the largest density

/// The surfaces of a material.
struct Shown {
  double area = 0.0;                          ///< in local space
  std::array<double, 2> texcoords{0.0, 0.0};  ///< the areas in both sets of texture coordinates
};

double crossed(const glm::dvec2& a, const glm::dvec2& b) { return std::abs(a.x * b.y - a.y * b.x); }

void addTriangles(const Scene& scene, size_t first, size_t count, double areaScale, double copies,
                  std::vector<Shown>& shown) {
  const std::array sets{&scene.vertices.texcoord0, &scene.vertices.texcoord1};
  for (size_t i = first; i < first + count; ++i) {
    const Triangle& t = scene.triangles[i];
    const auto [a, b, c] = cornersOf<glm::dvec3>(scene, t);
    shown[t.material].area += areaScale * 0.5 * glm::length(glm::cross(b - a, c - a));
    for (size_t set = 0; set < sets.size(); ++set) {
      if (sets[set]->empty()) continue;
      const auto at = [&](uint32_t vertex) { return glm::dvec2((*sets[set])[vertex]); };
      const glm::dvec2 corner = at(t.vertex.x);
      shown[t.material].texcoords[set] +=
          copies * 0.5 * crossed(at(t.vertex.y) - corner, at(t.vertex.z) - corner);
    }
  }
}

std::vector<Shown> shownByMaterial(const Scene& scene) {
  std::vector<Shown> shown(scene.materials.size());
  addTriangles(scene, 0, flatTriangleCount(scene), 1.0, 1.0, shown);
  std::vector<std::pair<double, double>> copies(scene.sharedMeshes.size());  // scale of areas, number
  for (const Instance& instance : scene.instances) {
    copies[instance.mesh].first +=
        std::pow(std::abs(glm::determinant(glm::dmat3(instance.toLocal))), 2.0 / 3.0);
    copies[instance.mesh].second += 1.0;
  }
  for (size_t i = 0; i < copies.size(); ++i) {
    const SharedMesh& mesh = scene.sharedMeshes[i];
    addTriangles(scene, mesh.firstTriangle, mesh.triangleCount, copies[i].first, copies[i].second, shown);
  }
  for (const Sphere& sphere : scene.spheres) {
    shown[sphere.material].area += 4.0 * glm::pi<double>() * double(sphere.radius) * double(sphere.radius);
    shown[sphere.material].texcoords[0] += 1.0;
  }
  return shown;
}

TexelDensities texelDensities(const Scene& scene) {
  std::vector<double> areas(scene.images.size(), 0.0), texels(scene.images.size(), 0.0);
  const std::vector<Shown> shown = shownByMaterial(scene);
  for (size_t i = 0; i < shown.size(); ++i) {
    for (const TextureRefRow& row : kTextureRefs) {
      const TextureRef& ref = scene.materials[i].*row.ref;
      const uint32_t image = ref.present() ? scene.textures[ref.texture].image : kMissIndex;
      if (image == kMissIndex) continue;
      const EncodedImage& picture = scene.images[image];
      const double scale = crossed(glm::dvec2(ref.transform.u), glm::dvec2(ref.transform.v));
      areas[image] += shown[i].area;
      texels[image] +=
          shown[i].texcoords[ref.texcoord] * scale * double(picture.width) * double(picture.height);
    }
  }
  TexelDensities result;
  result.ofImage.assign(areas.size(), std::numeric_limits<double>::infinity());
  for (size_t i = 0; i < areas.size(); ++i) {
    const double density = std::sqrt(texels[i] / areas[i]);
    if (density >= 0.0) result.ofImage[i] = density;  // not where both are 0, or no numbers
    if (std::isfinite(result.ofImage[i])) result.largest = std::max(result.largest, result.ofImage[i]);
  }
  for (double& density : result.ofImage) density = std::max(density, result.largest * kLeast);
  return result;
}

/// Returns true if a cell has an alpha above `most` within the cells from `low` to `high` of level 0.
bool cellExceeds(const AlphaPyramid& pyramid, size_t level, glm::ivec2 cell, glm::ivec2 low, glm::ivec2 high,
                 int most) {
  const int side = 1 << (pyramid.levels.size() - 1 - level);
  if (pyramid.levels[level][size_t(cell.y) * size_t(side) + size_t(cell.x)] <= most) return false;
  const glm::ivec2 first = cell << int(level);
  const glm::ivec2 last = first + ((1 << level) - 1);
  if (glm::any(glm::lessThan(last, low)) || glm::any(glm::lessThan(high, first))) return false;
  const bool isInside = glm::all(glm::lessThanEqual(low, first)) && glm::all(glm::lessThanEqual(last, high));
  if (level == 0 || isInside) return true;
  for (const glm::ivec2 corner : {glm::ivec2(0, 0), glm::ivec2(1, 0), glm::ivec2(0, 1), glm::ivec2(1, 1)})
    if (cellExceeds(pyramid, level - 1, 2 * cell + corner, low, high, most)) return true;
  return false;
}

constexpr int kLeastLayerSide = 1024;

/// The size scaled down until both sides are at most `side`.
glm::ivec2 within(glm::ivec2 size, int side) {
  const int larger = std::max(size.x, size.y);
  if (larger <= side) return size;
  const double scale = double(side) / larger;
  return glm::max(glm::ivec2(glm::round(glm::dvec2(size) * scale)), glm::ivec2(1));
}

bool isUsed(const TexturePlace& place) { return place.size.x > 0; }

/// One picture behind the other. Returns false where the room ends.
bool placeInBuffers(const TextureRoom& room, TexturePlan& plan) {
  plan.sizes.assign(1, 0);
  for (TexturePlace& place : plan.places) {
    if (!isUsed(place)) continue;
    const auto words = int64_t(plan.wordsOf(place));
    if (words > room.words) return false;
    if (plan.sizes.back() + words > room.words) plan.sizes.push_back(0);
    if (plan.sizes.size() > room.buffers) return false;
    place.number = uint32_t(plan.sizes.size() - 1);
    place.first = uint32_t(plan.sizes.back());
    plan.sizes.back() += words;
  }
  return true;
}

/// Pictures of one array texture in shelves, the highest first. Returns the number of layers. With levels, a
/// picture lies at multiples of what its last level divides sides by; the largest of these come first.
uint32_t placeInLayers(std::vector<TexturePlace*>& places, int side, bool levels) {
  const auto stepOf = [&](const TexturePlace& place) { return levels ? 1 << (levelsOf(place.size) - 1) : 1; };
  const auto stepped = [](int begin, int step) { return (begin + step - 1) / step * step; };
  std::ranges::stable_sort(places, [&](const TexturePlace* a, const TexturePlace* b) {
    return std::tuple(stepOf(*a), a->size.y, a->size.x) > std::tuple(stepOf(*b), b->size.y, b->size.x);
  });
  uint32_t layer = 0;
  glm::ivec2 end{0};
  int shelf = 0;  // its top
  for (TexturePlace* place : places) {
    end.x = stepped(end.x, stepOf(*place));
    if (end.x + place->size.x > side) {
      shelf = stepped(end.y, stepOf(*place));
      end.x = 0;
    }
    if (shelf + place->size.y > side) {
      ++layer;
      shelf = end.x = end.y = 0;
    }
    place->number = layer;
    place->first = uint32_t(end.x) | uint32_t(shelf) << 16;
    end.x += place->size.x;
    end.y = std::max(end.y, shelf + place->size.y);
  }
  return places.empty() ? 0 : layer + 1;
}

bool placeInArrays(const TextureRoom& room, TexturePlan& plan) {
  int largest = kLeastLayerSide;
  for (const TexturePlace& place : plan.places) largest = std::max({largest, place.size.x, place.size.y});
  plan.layerSide = std::min(int(std::bit_ceil(uint32_t(largest))), room.side);
  plan.sizes.clear();
  for (const bool wide : {false, true}) {
    std::vector<TexturePlace*> places;
    for (TexturePlace& place : plan.places)
      if (isUsed(place) && place.wide == wide) places.push_back(&place);
    plan.sizes.push_back(placeInLayers(places, plan.layerSide, plan.levels != MipLevels::None));
  }
  return std::ranges::max(plan.sizes) <= int64_t(room.layers);
}

/// Places the pictures, each scaled down to the room's side and to the part of its size that it may have.
bool placeWithin(const std::vector<TexturePlace>& whole, const std::function<double(size_t)>& part,
                 const TextureRoom& room, TexturePlan& plan) {
  plan.places = whole;
  plan.shrunk = {};
  for (size_t i = 0; i < whole.size(); ++i) {
    const int larger = std::max(whole[i].whole.x, whole[i].whole.y);
    if (larger == 0) continue;
    const int side = std::min(room.side, std::max(1, int(std::lround(larger * std::min(part(i), 1.0)))));
    plan.places[i].size = within(whole[i].whole, side);
    if (side >= larger) continue;
    ++plan.shrunk.count;
    plan.shrunk.from = std::max(plan.shrunk.from, larger);
    plan.shrunk.to = std::max(plan.shrunk.to, side);
  }
  const bool fits = room.reads == TexelReads::Words ? placeInBuffers(room, plan) : placeInArrays(room, plan);
  return fits && plan.bytes() <= room.bytes;
}

/// Calls for each use of a picture by a slot or a mean that a variant of these traits reads.
void forEachPicture(const Scene& scene, const TraitSet& traits,
                    const std::function<void(uint32_t image, TransferCurve curve)>& use) {
  const auto useTexture = [&](const TextureRef& ref, TransferCurve curve) {
    if (!ref.present() || scene.textures[ref.texture].image == kMissIndex) return;
    use(scene.textures[ref.texture].image, curve);
  };
  for (const Material& m : scene.materials) {
    for (uint32_t slot = 0; slot < layout::kSlotCount; ++slot)
      if (readsTexture(slot, m, traits)) useTexture(m.*kTextureRefs[slot].ref, kTextureRefs[slot].curve);
    if (!m.scattersInside() || !has(traits, Trait::Scattering)) continue;
    useTexture(m.scatterStrengthTexture, TransferCurve::Linear);
    useTexture(m.multiscatterColorTexture, TransferCurve::Srgb);
  }
}

/// The pictures that are read, whole, without their places.
std::vector<TexturePlace> readPictures(const Scene& scene, const TraitSet& traits) {
  std::vector<TexturePlace> pictures(scene.images.size());
  forEachPicture(scene, traits, [&](uint32_t index, TransferCurve curve) {
    const EncodedImage& image = scene.images[index];
    pictures[index].whole = {image.width, image.height};
    pictures[index].wide = image.texelBits > 8;
    pictures[index].isColor |= curve == TransferCurve::Srgb;
  });
  for (const Material& m : scene.materials) {
    const uint32_t texture = m.baseColorTexture.texture;
    if (m.alphaMode != AlphaMode::Opaque && m.baseColorTexture.present() &&
        scene.textures[texture].image != kMissIndex)
      pictures[scene.textures[texture].image].isCut = true;
  }
  return pictures;
}

}  // namespace

std::vector<uint8_t> coarser(std::span<const uint8_t> cells) {
  size_t side = 1;
  while (4 * side * side < cells.size()) ++side;
  std::vector<uint8_t> result(side * side);
  for (size_t y = 0; y < side; ++y) {
    for (size_t x = 0; x < side; ++x) {
      const uint8_t* top = &cells[4 * y * side + 2 * x];
      const uint8_t* bottom = top + 2 * side;
      result[y * side + x] = std::max({top[0], top[1], bottom[0], bottom[1]});
    }
  }
  return result;
}

bool AlphaPyramid::exceeds(glm::ivec2 low, glm::ivec2 high, int most) const {
  return levels.empty() ||
         cellExceeds(*this, levels.size() - 1, {0, 0}, low >> kCellBits, high >> kCellBits, most);
}

int levelsOf(glm::ivec2 size) { return std::bit_width(uint32_t(std::min(size.x, size.y))); }

size_t texelsBefore(glm::ivec2 size, int level) {
  if (level == 0) return 0;
  // A level has at most a quarter of the texels of that before it. 11 / 32 is the next above a third that
  // shifts divide.
  const size_t texels = size_t(size.x) * size_t(size.y);
  return texels + (11 * (texels - (texels >> (2 * (level - 1)))) >> 5);
}

size_t TexturePlan::wordsOf(const TexturePlace& place) const {
  return texelsBefore(place.size, levels == MipLevels::None ? 1 : levelsOf(place.size)) *
         (place.wide ? 2 : 1);
}

size_t TexturePlan::bytes() const {
  const auto sum = [&](auto bytesOf) {
    size_t bytes = 0;
    for (size_t i = 0; i < sizes.size(); ++i) bytes += size_t(sizes[i]) * bytesOf(i);
    return bytes;
  };
  if (reads == TexelReads::Words) return sum([](size_t) { return sizeof(uint32_t); });
  size_t texels = 0;
  for (int side = layerSide; side > 0; side = levels == MipLevels::None ? 0 : side / 2)
    texels += size_t(side) * size_t(side);
  return sum([&](size_t array) { return texels * (array == 0 ? 4 : 8); });
}

bool readsTexture(uint32_t slot, const Material& material, const TraitSet& traits) {
  static_assert(kTextureRefs.size() == layout::kSlotCount + 1);  // occlusion has no slot
  const Trait trait = slotTrait(slot);
  return has(traits, trait) && traitRows()[size_t(trait)].ofMaterial(material, Coordinates{});
}

TexturePlan planTextures(const Scene& scene, const TraitSet& traits, const TextureRoom& room) {
  const std::vector<TexturePlace> whole = readPictures(scene, traits);
  TexturePlan plan{.reads = room.reads, .levels = room.levels};
  if (placeWithin(
          whole, [](size_t) { return 1.0; }, room, plan))
    return plan;
  const TexelDensities densities = texelDensities(scene);
  // The logarithm of the common density, between one at which each picture is a texel and the largest one.
  double fits = std::log2(densities.largest * 1e-12), above = std::log2(densities.largest);
  const auto tryDensity = [&](double logarithm) {
    const double most = std::exp2(logarithm);
    return placeWithin(
        whole, [&](size_t i) { return most / densities.ofImage[i]; }, room, plan);
  };
  for (int step = 0; step < 50; ++step) {
    const double middle = std::midpoint(fits, above);
    (tryDensity(middle) ? fits : above) = middle;
  }
  tryDensity(fits);
  return plan;
}

bool holdsTextures(const TexturePlan& plan, const Scene& scene, const TraitSet& traits) {
  const auto holds = [](const TexturePlace& place, const TexturePlace& read) {
    return read.whole.x == 0 || (place.whole == read.whole && place.wide == read.wide);
  };
  return std::ranges::equal(plan.places, readPictures(scene, traits), holds);
}

}  // namespace fragtrace
