// SPDX-License-Identifier: MIT
#include "image/display/tone_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/mat3x3.hpp>

#include "base/errors.h"
#include "image/channels.h"

namespace fragtrace {

namespace {

constexpr std::array<std::string_view, 5> kToneMapNames{"linear", "reinhard", "aces", "agx", "neutral"};

/// Above this all curves are flat; it keeps infinity, and with it inf / inf, out of them.
constexpr double kBrightest = 1e30;

/// Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002, eq. 3, a channel at a time.
glm::dvec3 reinhard(glm::dvec3 color) { return color / (1.0 + color); }

/// Stephen Hill's fit of the ACES 1.0 reference rendering and output transforms, in: Pettineo and Hill,
/// BakingLab, ACES.hlsl, 2016. Without the factor 1 / 0.6 by which some renderers brighten it.
glm::dvec3 aces(glm::dvec3 color) {
  // Columns: glm and GLSL store matrices so; the source prints rows.
  static const glm::dmat3 kInput{{0.59719, 0.07600, 0.02840},      //
                                 {0.35458, 0.90834, 0.13383},      //
                                 {0.04823, 0.01566, 0.83777}};     // Rec.709, D65 to D60, to AP1, desaturated
  static const glm::dmat3 kOutput{{1.60475, -0.10208, -0.00327},   //
                                  {-0.53108, 1.10813, -0.07276},   //
                                  {-0.07367, -0.00605, 1.07602}};  // the inverse
  const glm::dvec3 v = kInput * color;
  return kOutput * ((v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081));
}

/// Benjamin Wrensch, "Minimal AgX Implementation", 2023: polynomial of degree 6 through AgX's default
/// contrast curve.
glm::dvec3 agxContrast(glm::dvec3 x) {
  constexpr std::array kCoefficients{15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232};
  glm::dvec3 sum(0.0);
  for (const double coefficient : kCoefficients) sum = sum * x + coefficient;
  return sum;
}

/// Troy Sobotka, AgX, 2022, with the Rec.2020 primaries of EaryChow's AgX (Blender 4, 2023), as three.js has
/// it.
glm::dvec3 agx(glm::dvec3 color) {
  // Conversion between Rec.709 and Rec.2020: ITU-R BT.2407, 2017.
  static const glm::dmat3 kRec709ToRec2020{
      {0.6274, 0.0691, 0.0164}, {0.3293, 0.9195, 0.0880}, {0.0433, 0.0113, 0.8956}};
  static const glm::dmat3 kRec2020ToRec709{
      {1.6605, -0.1246, -0.0182}, {-0.5876, 1.1329, -0.1006}, {-0.0728, -0.0083, 1.1187}};
  static const glm::dmat3 kInset{{0.856627153315983, 0.137318972929847, 0.11189821299995},
                                 {0.0951212405381588, 0.761241990602591, 0.0767994186031903},
                                 {0.0482516061458583, 0.101439036467562, 0.811302368396859}};
  static const glm::dmat3 kOutset{{1.1271005818144368, -0.1413297634984383, -0.14132976349843826},
                                  {-0.11060664309660323, 1.157823702216272, -0.11060664309660294},
                                  {-0.016493938717834573, -0.016493938717834257, 1.2519364065950405}};
  constexpr double kMinimumEv = -12.47393;
  constexpr double kMaximumEv = 4.026069;
  constexpr double kDisplayGamma = 2.2;
  // Keeps the logarithm of black finite; it is below 2^kMinimumEv, so the clamp hides it.
  constexpr double kBlack = 1e-10;

  const glm::dvec3 ev = glm::log2(glm::max(kInset * (kRec709ToRec2020 * color), kBlack));
  const glm::dvec3 encoded = glm::clamp((ev - kMinimumEv) / (kMaximumEv - kMinimumEv), 0.0, 1.0);
  const glm::dvec3 display = kOutset * agxContrast(encoded);
  return kRec2020ToRec709 * glm::pow(glm::max(display, 0.0), glm::dvec3(kDisplayGamma));
}

/// Khronos PBR Neutral Tone Mapper, specification of 2024.
glm::dvec3 neutral(glm::dvec3 color) {
  constexpr double kFresnel = 0.04;  // a dielectric of index 1.5 reflects this, which is taken off again
  constexpr double kCompressionStart = 0.8 - kFresnel;
  constexpr double kDesaturation = 0.15;

  const double lowest = std::min({color.x, color.y, color.z});
  color -= lowest < 2 * kFresnel ? lowest - lowest * lowest / (4 * kFresnel) : kFresnel;
  const double peak = std::max({color.x, color.y, color.z});
  if (peak <= kCompressionStart) return color;

  const double room = 1 - kCompressionStart;
  const double newPeak = 1 - room * room / (peak + room - kCompressionStart);
  const double whiteness = 1 - 1 / (kDesaturation * (peak - newPeak) + 1);
  return glm::mix(color * (newPeak / peak), glm::dvec3(newPeak), whiteness);
}

}  // namespace

std::span<const std::string_view> toneMapNames() { return kToneMapNames; }

std::optional<ToneMap> parseToneMap(std::string_view name) {
  const auto* found = std::ranges::find(kToneMapNames, name);
  if (found == kToneMapNames.end()) return std::nullopt;
  return ToneMap(found - kToneMapNames.begin());
}

glm::dvec3 applyToneMap(ToneMap toneMap, glm::dvec3 color) {
  // NaN compares false.
  for (int i = 0; i < 3; ++i) color[i] = color[i] > 0 ? std::min(color[i], kBrightest) : 0.0;

  switch (toneMap) {
    case ToneMap::Linear:
      break;
    case ToneMap::Reinhard:
      color = reinhard(color);
      break;
    case ToneMap::Aces:
      color = aces(color);
      break;
    case ToneMap::Agx:
      color = agx(color);
      break;
    case ToneMap::Neutral:
      color = neutral(color);
      break;
  }
  return glm::clamp(color, 0.0, 1.0);
}

double encodeSrgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double decodeSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

namespace {

/// The pixels' exposed, unassociated colours through a function, with A.
template <typename Curve>
Image mapColors(const Image& linear, double exposureEv, const Curve& curve) {
  const auto channels = findColorChannels(linear);
  if (!channels) throw RenderError("cannot tone-map a picture without colour channels");
  const auto alphaChannel = findChannel(linear, "A");
  const double factor = std::exp2(exposureEv);

  Image display{linear.width, linear.height, {"R", "G", "B"}, {}, linear.attributes};
  if (alphaChannel) display.channels.emplace_back("A");
  const size_t pixelCount = size_t(linear.width) * size_t(linear.height);
  display.values.reserve(pixelCount * display.channelCount());
  for (size_t i = 0; i < pixelCount; ++i) {
    const float* stored = linear.values.data() + i * linear.channelCount();
    glm::dvec3 color(stored[(*channels)[0]], stored[(*channels)[1]], stored[(*channels)[2]]);
    double alpha = 1;
    if (alphaChannel) {
      const double value = stored[*alphaChannel];
      alpha = value > 0 ? std::min(value, 1.0) : 0.0;  // NaN compares false
      color = alpha > 0 ? color / alpha : glm::dvec3(0.0);
    }
    color = curve(color * factor);
    for (int c = 0; c < 3; ++c) display.values.push_back(float(color[c]));
    if (alphaChannel) display.values.push_back(float(alpha));
  }
  return display;
}

}  // namespace

Image toDisplay(const Image& linear, double exposureEv, ToneMap toneMap) {
  return mapColors(linear, exposureEv, [&](const glm::dvec3& color) {
    const glm::dvec3 shown = applyToneMap(toneMap, color);
    return glm::dvec3(encodeSrgb(shown.x), encodeSrgb(shown.y), encodeSrgb(shown.z));
  });
}

Image exposedColors(const Image& linear, double exposureEv) {
  return mapColors(linear, exposureEv, [](glm::dvec3 color) {
    for (int c = 0; c < 3; ++c)
      color[c] = std::isnan(color[c]) ? 0.0 : std::clamp(color[c], -kBrightest, kBrightest);
    return color;
  });
}

glm::dvec3 shownOver(const glm::dvec3& page, const glm::dvec4& color, double factor, ToneMap toneMap) {
  const double alpha = color.a > 0.0 ? std::min(color.a, 1.0) : 0.0;  // NaN compares false
  glm::dvec3 shown = page;
  if (alpha > 0.0) {
    const glm::dvec3 own = glm::dvec3(color) - (1.0 - alpha) * page;
    // Less than nothing is what tinted glass and coloured shadows take from the page.
    shown = alpha * applyToneMap(toneMap, factor / alpha * own) + (1.0 - alpha) * page +
            glm::min(own, glm::dvec3(0.0));
  }
  for (int c = 0; c < 3; ++c) shown[c] = shown[c] > 0.0 ? std::min(shown[c], 1.0) : 0.0;
  return shown;
}

Image toDisplayOver(const glm::vec3& page, const Image& linear, double exposureEv, ToneMap toneMap) {
  const auto channels = findColorChannels(linear);
  if (!channels) throw RenderError("cannot tone-map a picture without colour channels");
  const size_t alpha = findChannel(linear, "A").value();
  const double factor = std::exp2(exposureEv);
  Image display{linear.width, linear.height, {"R", "G", "B"}, {}, linear.attributes};
  display.values.reserve(linear.values.size() / linear.channelCount() * 3);
  for (size_t first = 0; first < linear.values.size(); first += linear.channelCount()) {
    const float* pixel = linear.values.data() + first;
    const glm::dvec4 color(pixel[(*channels)[0]], pixel[(*channels)[1]], pixel[(*channels)[2]], pixel[alpha]);
    const glm::dvec3 shown = shownOver(glm::dvec3(page), color, factor, toneMap);
    for (int c = 0; c < 3; ++c) display.values.push_back(float(encodeSrgb(shown[c])));
  }
  return display;
}

Image forBlendedValues(Image display) {
  const auto alphaChannel = findChannel(display, "A");
  if (!alphaChannel) return display;
  const auto channels = findColorChannels(display).value();  // toDisplay() has put them there
  for (size_t i = 0; i < display.values.size(); i += display.channelCount()) {
    float* const pixel = display.values.data() + i;
    const double alpha = pixel[*alphaChannel];
    // Blending light over white gives the value w of a channel, over black b. Blending values with colour c
    // and alpha a gives a c + 1 - a and a c. Both are met by a = 1 - w + b, which is a shadow's alpha, too,
    // but channels differ where the surface has a colour. So alpha is their mean, at least what keeps c above
    // 0, and the colour is chosen so that white is met exactly.
    double mean = 0.0;
    double least = 0.0;
    std::array<double, 3> missing{};
    for (size_t c = 0; c < 3; ++c) {
      const double light = alpha * decodeSrgb(pixel[channels[c]]);
      missing[c] = 1.0 - encodeSrgb(std::min(light + 1.0 - alpha, 1.0));
      mean += (missing[c] + encodeSrgb(light)) / 3.0;
      least = std::max(least, missing[c]);
    }
    const double blended = std::clamp(mean, least, 1.0);
    for (size_t c = 0; c < 3; ++c)
      pixel[channels[c]] = blended > 0.0 ? float(1.0 - missing[c] / blended) : 0.0f;
    pixel[*alphaChannel] = float(blended);
  }
  return display;
}

Image toDefaultDisplay(const Image& linear) { return asRead(toDisplay(linear, 0, ToneMap::Neutral), linear); }

Image asRead(Image display, const Image& linear) {
  dither(display, linear.placement.value_or(Placement()).corner);
  for (float& value : display.values)
    value = std::round(std::clamp(value, 0.0F, 1.0F) * 255.0F) *
            (1 / 255.0F);  // the value that a reader of the file gets

  const auto channels = findColorChannels(linear).value();  // what has displayed it has thrown else
  const size_t pixelCount = size_t(linear.width) * size_t(linear.height);
  for (size_t i = 0; i < pixelCount; ++i)
    for (size_t c = 0; c < 3; ++c)
      if (!std::isfinite(linear.values[i * linear.channelCount() + channels[c]]))
        display.values[i * display.channelCount() + c] = std::numeric_limits<float>::quiet_NaN();
  return display;
}

namespace {

using std::abs;
using std::floor;
using uint = uint32_t;
#include "picture/dither.glsl"

}  // namespace

void dither(Image& display, glm::ivec2 corner) {
  const auto channels = findColorChannels(display);
  if (!channels) return;
  for (int y = 0; y < display.height; ++y) {
    for (int x = 0; x < display.width; ++x) {
      float* pixel = display.pixel(x, y);
      for (uint c = 0; c < 3; ++c) {
        float& value = pixel[(*channels)[c]];
        value = dithered(value, uint(corner.x + x), uint(corner.y + y), c);
      }
    }
  }
}

}  // namespace fragtrace
