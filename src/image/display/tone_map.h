// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "image/image.h"

namespace fragtrace {

// From linear radiance to the sRGB-encoded values of a display.

enum class ToneMap { Linear, Reinhard, Aces, Agx, Neutral };

/// The curves' names on the command line, in the order of ToneMap.
std::span<const std::string_view> toneMapNames();
std::optional<ToneMap> parseToneMap(std::string_view name);

/// Linear radiance (exposed, Rec.709) to linear display values in 0..1. Negative values and NaN count as 0.
glm::dvec3 applyToneMap(ToneMap toneMap, glm::dvec3 color);

/// The sRGB transfer function (IEC 61966-2-1) of a linear value in 0..1.
double encodeSrgb(double linear);

/// The inverse of encodeSrgb(): returns the linear value of an encoded one in 0..1.
double decodeSrgb(double encoded);

/// A view of an OpenColorIO configuration, which takes the place of the curve. Empty names: see --ocio-view.
struct OcioView {
  std::string config;
  std::string display;
  std::string view;  ///< empty: no view
  std::string look;
  std::string input;

  bool isAsked() const { return !view.empty(); }
  bool operator==(const OcioView&) const = default;
};

/// R, G, B in 0..1, sRGB-encoded, after a factor of 2^exposureEv and the curve. With a channel A the colour
/// is taken as premultiplied and returned unassociated, with A; colour is 0 where A is. Other channels are
/// dropped. For a format without alpha pass withoutAlpha(linear), which puts it over black. Throws
/// RenderError without colour.
Image toDisplay(const Image& linear, double exposureEv, ToneMap toneMap);

/// Returns what a view of OpenColorIO takes: toDisplay() with neither curve nor encoding. NaN counts as 0,
/// and no value is beyond 1e30.
Image exposedColors(const Image& linear, double exposureEv);

/// Linear display values in 0..1 of a colour with coverage that lies over a page, after this factor and
/// curve: a pixel of toDisplayOver().
glm::dvec3 shownOver(const glm::dvec3& page, const glm::dvec4& color, double factor, ToneMap toneMap);

/// The opaque picture of a linear one whose colour lies over a page of one colour, as far as its channel A
/// lets it through. The page has that very colour: neither exposure nor curve changes it. So a page of 1 is
/// exactly white. Throws as toDisplay does.
Image toDisplayOver(const glm::vec3& page, const Image& linear, double exposureEv, ToneMap toneMap);

/// The picture of toDisplay() for programs that blend sRGB values, as browsers do: over white they show what
/// blending light shows. Unchanged where it has no channel A.
Image forBlendedValues(Image display);

/// A displayed picture as readImage reads it from a .png: dithered and rounded to 8 bits. Only colour of the
/// `linear` picture that is not finite becomes NaN, so that no comparison takes a broken picture for a good
/// one.
Image asRead(Image display, const Image& linear);

/// The .png of a linear picture with default options, as readImage reads it: toDisplay at exposure 0 with the
/// neutral curve. Throws as toDisplay does.
Image toDefaultDisplay(const Image& linear);

/// Adds noise of one step of 8 bits to the colours of a picture of toDisplay(), for a format of 8 bits
/// (shaders/picture/dither.glsl). It depends on the place in the whole picture alone, where the first pixel
/// is at `corner`. Alpha stays.
void dither(Image& display, glm::ivec2 corner);

}  // namespace fragtrace
