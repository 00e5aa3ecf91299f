// SPDX-License-Identifier: MIT
// Values that can be drawn in place of radiance: layers of .exr files, and debug views, which show layers or
// counts as colours (docs/output.md).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace fragtrace {

/// Properties of a first hit beside its radiance, and parts of that radiance.
enum class Aov : uint8_t {
  None,
  Albedo,
  Normal,
  Depth,
  GeometricNormal,
  Roughness,
  Texcoords,
  Position,
  Object,    ///< number of the glTF node, from 1 on
  Material,  ///< number of the glTF material, from 1 on
  Emission,  ///< the parts of its radiance, which add up to it: what surfaces and surroundings send to the
             ///< camera,
  Diffuse,   ///< light that was scattered first by a diffuse surface,
  Specular,  ///< light that was scattered first by any other surface
  Guides,    ///< guides of filters, all in one: kGuideChannels
  CryptoObject,   ///< Cryptomatte of the glTF nodes: ids and shares of each pixel (image/cryptomatte.h)
  CryptoMaterial  ///< the same of the materials
};

struct AovRow {
  std::string_view name;      ///< name of the layer
  std::string_view channels;  ///< a letter each, behind the name and a dot
};

/// The layers, in the order of Aov.
inline constexpr std::array<AovRow, 16> kAovRows{{{"", ""},
                                                  {"albedo", "RGB"},
                                                  {"normal", "XYZ"},
                                                  {"depth", "Z"},
                                                  {"geometric-normal", "XYZ"},
                                                  {"roughness", "Y"},
                                                  {"texcoords", "UV"},
                                                  {"position", "XYZ"},
                                                  {"object", "Y"},
                                                  {"material", "Y"},
                                                  {"emission", "RGB"},
                                                  {"diffuse", "RGB"},
                                                  {"specular", "RGB"},
                                                  {"denoising", ""},
                                                  {"crypto-object", ""},
                                                  {"crypto-material", ""}}};

inline const AovRow& rowOf(Aov aov) { return kAovRows[size_t(aov)]; }

/// Returns true if the AOV is a share of the light, for which paths are traced to their ends.
inline bool isLightPart(Aov aov) {
  return aov == Aov::Emission || aov == Aov::Diffuse || aov == Aov::Specular;
}

/// Returns true if the AOV is a Cryptomatte.
inline bool isMatte(Aov aov) { return aov == Aov::CryptoObject || aov == Aov::CryptoMaterial; }

/// The content of a picture. All but None are colours to be displayed as they are, without exposure and tone
/// curve.
enum class DebugView : uint8_t {
  None,
  GeometricNormal,
  Normal,
  Albedo,
  Roughness,
  Texcoords,
  Depth,
  Visits,
  Samples,
  Variance
};

struct DebugViewRow {
  std::string_view name;   ///< on the command line
  std::string_view label;  ///< the name in the viewer
  std::string_view sentence;
  Aov aov;  ///< drawn for it; None: it shows counts, of samples drawn as ever or of nodes
};

/// The debug views, in the order of DebugView.
inline constexpr std::array<DebugViewRow, 10> kDebugViewRows{{
    {"none", "Radiance", "the picture itself", Aov::None},
    {"geometric-normal", "Geometric normal", "0.5 + 0.5 N of the triangle, towards the camera",
     Aov::GeometricNormal},
    {"normal", "Shading normal", "0.5 + 0.5 N with vertex normals and maps", Aov::Normal},
    {"albedo", "Base colour", "base colour: factor, texture, vertex colour", Aov::Albedo},
    {"roughness", "Roughness", "perceptual roughness, from black to white", Aov::Roughness},
    {"texcoords", "Texture coordinates", "the fractions of TEXCOORD_0, red and green", Aov::Texcoords},
    {"depth", "Depth", "along the view's axis, from white (nearest) to dark grey (farthest)", Aov::Depth},
    {"visits", "Node visits", "nodes of the tree that a camera ray visits, as a heat map", Aov::None},
    {"samples", "Samples", "samples per pixel, as a heat map", Aov::None},
    {"variance", "Variance", "estimated relative error of each pixel in per cent, as a heat map", Aov::None},
}};

inline const DebugViewRow& rowOf(DebugView view) { return kDebugViewRows[size_t(view)]; }

}  // namespace fragtrace
