// SPDX-License-Identifier: MIT
#include "pack/textures/pack_textures.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <span>
#include <type_traits>

#include "base/errors.h"
#include "base/words.h"
#include "image/display/tone_map.h"
#include "image/files/process.h"
#include "shader/layout.h"

namespace fragtrace {

namespace {

/// The linear values of all stored ones.
template <typename Value>
const std::vector<float>& linearValues(TransferCurve curve) {
  constexpr size_t kCount = size_t(std::numeric_limits<Value>::max()) + 1;
  const auto make = [](bool srgb) {
    std::vector<float> values(kCount);
    for (size_t i = 0; i < kCount; ++i) {
      const double x = double(i) / double(kCount - 1);
      values[i] = float(srgb ? decodeSrgb(x) : x);
    }
    return values;
  };
  static const std::vector<float> linear = make(false);
  if (curve == TransferCurve::Linear) return linear;
  static const std::vector<float> srgb = make(true);
  return srgb;
}

TransferCurve curveOf(TransferCurve ofColor, size_t channel) {
  return channel < 3 ? ofColor : TransferCurve::Linear;
}

/// The linear values from which on those stored are rounded up to the next one in sRGB.
template <typename Value>
const std::vector<float>& bordersOfSrgb() {
  static const std::vector<float> borders = [] {
    std::vector<float> values(std::numeric_limits<Value>::max());
    for (size_t i = 0; i < values.size(); ++i)
      values[i] = float(decodeSrgb((double(i) + 0.5) / double(values.size())));
    return values;
  }();
  return borders;
}

template <typename Value>
Value stored(double linear, TransferCurve curve) {
  if (curve == TransferCurve::Linear) return Value(std::lround(linear * std::numeric_limits<Value>::max()));
  const std::vector<float>& borders = bordersOfSrgb<Value>();
  return Value(std::ranges::upper_bound(borders, float(linear)) - borders.begin());
}

uint32_t wrapFlags(Wrap wrap, uint32_t clamp, uint32_t mirror) {
  return wrap == Wrap::ClampToEdge ? clamp : wrap == Wrap::MirroredRepeat ? mirror : 0u;
}

/// The mean of the texels by both curves, found by how often each channel has each value.
template <typename Value>
PictureFacts meansOf(std::span<const Value> rgba) {
  std::array<std::vector<uint32_t>, 4> counts;
  for (auto& channel : counts) channel.resize(size_t(std::numeric_limits<Value>::max()) + 1);
  for (size_t i = 0; i < rgba.size(); ++i) ++counts[i & 3][rgba[i]];
  const auto meanBy = [&](TransferCurve curve) {
    glm::dvec4 sum(0.0);
    for (size_t channel = 0; channel < 4; ++channel) {
      const std::vector<float>& linear = linearValues<Value>(curveOf(curve, channel));
      for (size_t i = 0; i < linear.size(); ++i) sum[int(channel)] += double(counts[channel][i]) * linear[i];
    }
    return glm::vec4(sum / double(std::max<size_t>(rgba.size() / 4, 1)));
  };
  return {.meanNumber = meanBy(TransferCurve::Linear), .meanColor = meanBy(TransferCurve::Srgb)};
}

/// The texels of a line that one of a shorter line replaces.
struct Replaced {
  int begin;
  int end;
  int from;  ///< length of the line
  int to;    ///< length of the shorter one
  int texel;

  Replaced(int number, int before, int after)
      : begin(int(int64_t(number) * before / after)),
        end(int((int64_t(number + 1) * before + after - 1) / after)),
        from(before),
        to(after),
        texel(number) {}
  /// The part of a texel that is replaced, of `to`; all of them add up to `from`.
  double partOf(int i) const {
    const int64_t first = std::max(int64_t(i) * to, int64_t(texel) * from);
    return double(std::min(int64_t(i + 1) * to, int64_t(texel + 1) * from) - first);
  }
};

/// Scales a picture down. Each texel is the mean of the area that it replaces, in linear light, rounded to
/// its bits again. isCut: alpha weights the colours.
template <typename Value>
void scale(const Value* rgba, glm::ivec2 from, glm::ivec2 to, TransferCurve curve, bool isCut,
           Value* result) {
  std::array<const float*, 4> linear{};
  for (size_t c = 0; c < 4; ++c) linear[c] = linearValues<Value>(curveOf(curve, c)).data();
  const double area = double(from.x) * double(from.y);
  for (int y = 0; y < to.y; ++y) {
    const Replaced rows(y, from.y, to.y);
    for (int x = 0; x < to.x; ++x) {
      const Replaced columns(x, from.x, to.x);
      glm::dvec4 sum(0.0);
      glm::dvec3 shown(0.0);
      for (int v = rows.begin; v < rows.end; ++v) {
        for (int u = columns.begin; u < columns.end; ++u) {
          const Value* t = rgba + (size_t(v) * size_t(from.x) + size_t(u)) * 4;
          const glm::dvec4 texel(linear[0][t[0]], linear[1][t[1]], linear[2][t[2]], linear[3][t[3]]);
          const glm::dvec4 part = rows.partOf(v) * columns.partOf(u) * texel;
          sum += part;
          shown += part.a * glm::dvec3(texel);
        }
      }
      if (isCut && sum.a > 0.0) sum = glm::dvec4(shown * (area / sum.a), sum.a);
      for (size_t c = 0; c < 4; ++c) *result++ = stored<Value>(sum[int(c)] / area, curveOf(curve, c));
    }
  }
}

/// Fills the levels of a picture behind its texels.
template <typename Value>
void addLevels(const TexturePlace& place, Value* rgba) {
  const auto at = [&](int level) { return rgba + 4 * texelsBefore(place.size, level); };
  const TransferCurve curve = place.isColor ? TransferCurve::Srgb : TransferCurve::Linear;
  for (int level = 1; level < levelsOf(place.size); ++level)
    scale<Value>(at(level - 1), place.size >> (level - 1), place.size >> level, curve, place.isCut,
                 at(level));
}

}  // namespace

TexturePacker::TexturePacker(const Scene& scene, const TexturePlan& plan, std::vector<PictureFacts> known,
                             const DecodeProgress& progress, const TexelMemory& memory)
    : scene_(scene), plan_(plan), facts_(std::move(known)) {
  if (!facts_.empty()) return;
  facts_.resize(plan.places.size());
  cutsOut_.resize(plan.places.size());
  for (const Material& m : scene.materials) {
    const TextureRef& ref = m.baseColorTexture;
    if (m.alphaMode == AlphaMode::Opaque || !ref.present()) continue;
    const uint32_t image = scene.textures[ref.texture].image;
    if (image < cutsOut_.size()) cutsOut_[image] = true;
  }
  std::vector<EncodedPicture> encoded;
  for (uint32_t image = 0; image < plan.places.size(); ++image) {
    if (plan.places[image].size.x == 0) continue;
    pictures_.push_back({.image = image});
    encoded.push_back({scene.images[image].bytes, nameOf(scene.images[image])});
  }
  std::mutex mutex;
  size_t decoded = 0;
  const std::vector<std::string> errors = decodeEach(encoded, [&](size_t i, const TexelImage& texels) {
    take(texels, memory, pictures_[i]);
    const std::lock_guard lock(mutex);
    if (progress) progress(++decoded, encoded.size());
  });
  for (size_t i = 0; i < errors.size(); ++i) {
    if (errors[i].empty()) continue;
    if (!whyNoPictures().empty()) throw InputError(errors[i]);
    if (std::ranges::find(broken_, errors[i]) == broken_.end()) broken_.push_back(errors[i]);
    facts_[pictures_[i].image].isBroken = true;
  }
  std::erase_if(pictures_, [&](const PackedPicture& picture) { return facts_[picture.image].isBroken; });
}

void TexturePacker::take(const TexelImage& texels, const TexelMemory& memory, PackedPicture& picture) {
  const TexturePlace& place = plan_.places[picture.image];
  const glm::ivec2 size(texels.width, texels.height);
  if (memory.empty()) picture.own.resize(plan_.wordsOf(place));
  uint32_t* words = memory.empty() ? picture.own.data() : memory[place.number] + place.first;
  picture.words = {words, texelsBefore(place.size, 1) * (place.wide ? 2 : 1)};
  std::visit(
      [&](auto rgba) {
        facts_[picture.image] = meansOf(rgba);
        auto* values = reinterpret_cast<typename decltype(rgba)::value_type*>(words);
        const TransferCurve curve = place.isColor ? TransferCurve::Srgb : TransferCurve::Linear;
        if (size == place.size)
          std::ranges::copy(rgba, values);
        else
          scale(rgba.data(), size, place.size, curve, false, values);
        const std::span<const std::remove_pointer_t<decltype(values)>> drawn =
            size == place.size ? rgba : std::span(values, 4 * texelsBefore(place.size, 1));
        if (cutsOut_[picture.image]) facts_[picture.image].alpha = alphaPyramidOf(drawn, place.size);
        if (plan_.levels == MipLevels::Made) addLevels(place, values);
      },
      texels.rgba);
}

glm::uvec4 TexturePacker::slot(const TextureRef& ref) {
  if (!ref.present()) return glm::uvec4(0u);
  const Texture& texture = scene_.textures[ref.texture];
  if (texture.image == kMissIndex || facts_[texture.image].isBroken) return glm::uvec4(0u);
  const TexturePlace& place = plan_.places[texture.image];
  uint32_t flags = layout::kTexturePresent | place.number << layout::kTexturePlaceShift;
  if (place.wide) flags |= layout::kTextureWide;
  if (texture.linear) flags |= layout::kTextureLinear;
  if (ref.texcoord == 1) flags |= layout::kTextureTexcoord1;
  flags |= wrapFlags(texture.wrapU, layout::kTextureClampU, layout::kTextureMirrorU);
  flags |= wrapFlags(texture.wrapV, layout::kTextureClampV, layout::kTextureMirrorV);
  return {place.first, uint32_t(place.size.x) | uint32_t(place.size.y) << 16, flags,
          ref.transformed() ? transformRow(ref.transform) : 0u};
}

const AlphaPyramid* TexturePacker::alphaOf(const TextureRef& ref) const {
  if (!ref.present() || scene_.textures[ref.texture].image == kMissIndex) return nullptr;
  const PictureFacts& facts = facts_[scene_.textures[ref.texture].image];
  return facts.isBroken || facts.alpha.levels.empty() ? nullptr : &facts.alpha;
}

glm::ivec2 TexturePacker::sizeOf(const TextureRef& ref) const {
  return plan_.places[scene_.textures[ref.texture].image].size;
}

glm::vec3 TexturePacker::meanRadiance(const Material& m) const {
  const glm::vec3 mean(this->mean(m.emissiveTexture, TransferCurve::Srgb));
  const Material settled = withoutBroken(m);
  return settled.emissiveFactor * settled.emissiveStrength * mean;
}

Material TexturePacker::withoutBroken(Material m) const {
  bool isBroken = false;
  for (const TextureRefRow& row : kTextureRefs) {
    TextureRef& ref = m.*row.ref;
    if (!ref.present() || scene_.textures[ref.texture].image == kMissIndex) continue;
    if (!facts_[scene_.textures[ref.texture].image].isBroken) continue;
    ref = {.lost = true};
    isBroken = true;
  }
  if (isBroken) settleLostTextures(m);
  return m;
}

/// The index of the transform's first row; the same transform is kept once.
uint32_t TexturePacker::transformRow(const TextureTransform& transform) {
  const auto known = std::find(transforms_.begin(), transforms_.end(), transform);
  const size_t index = size_t(known - transforms_.begin());
  if (known == transforms_.end()) transforms_.push_back(transform);
  return uint32_t(scene_.materials.size() * layout::kMaterialRows + 2 * index);
}

void TexturePacker::appendTransforms(std::vector<uint32_t>& materials) const {
  for (const TextureTransform& transform : transforms_) {
    appendRow(materials, transform.u, 0.0f);
    appendRow(materials, transform.v, 0.0f);
  }
}

glm::vec4 TexturePacker::mean(const TextureRef& ref, TransferCurve curve) const {
  if (!ref.present() || scene_.textures[ref.texture].image == kMissIndex) return glm::vec4(1.0f);
  const PictureFacts& facts = facts_[scene_.textures[ref.texture].image];
  return curve == TransferCurve::Srgb ? facts.meanColor : facts.meanNumber;
}

void addLevels(const TexturePlan& plan, const TexelMemory& memory) {
  for (const TexturePlace& place : plan.places) {
    if (place.size.x == 0) continue;
    uint32_t* words = memory[place.number] + place.first;
    if (place.wide)
      addLevels(place, reinterpret_cast<uint16_t*>(words));
    else
      addLevels(place, reinterpret_cast<uint8_t*>(words));
  }
}

glm::vec4 texelOf(const PackedPicture& picture, const TexturePlace& place, size_t texel,
                  TransferCurve curve) {
  const auto valueOf = [&](auto zero) {
    using Value = decltype(zero);
    const auto* rgba = reinterpret_cast<const Value*>(picture.words.data()) + 4 * texel;
    glm::vec4 value;
    for (size_t c = 0; c < 4; ++c) value[int(c)] = linearValues<Value>(curveOf(curve, c))[rgba[c]];
    return value;
  };
  return place.wide ? valueOf(uint16_t{}) : valueOf(uint8_t{});
}

}  // namespace fragtrace
