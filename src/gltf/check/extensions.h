// SPDX-License-Identifier: MIT
// The extensions of glTF that the loader knows, in one table. docs/gltf.md has a row for each.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace fragtrace {

class MaterialPart;
struct Material;

enum class Support : uint8_t { Supported, Partly };

/// The place of any use of a texture, whatever its name.
inline constexpr std::string_view kTextureInfo = "a texture info";

struct Extension {
  std::string_view name;
  Support support = Support::Supported;
  std::string_view reader;  ///< the file of src/gltf that reads it
  /// Places where the extension may stand: pointers with * for an index, "" the root, kTextureInfo; kNowhere.
  std::array<std::string_view, 2> places;
  std::string_view members = {};  ///< members of a material's extension, with spaces between: a texture ends
                                  ///< in Texture, NAME[3] is three numbers, all others are numbers
  void (*read)(const MaterialPart&, Material&) = nullptr;  ///< reads a material's extension
};

/// The place of extensions without an object of their own, and a second place that does not exist.
inline constexpr std::string_view kNowhere = "nowhere";

/// The extensions of materials. Their table is beside the functions that read them
/// (build/material_extensions.cpp), in the order in which they are read.
std::span<const Extension> materialExtensions();

/// All extensions.
const std::vector<Extension>& extensions();

/// Returns null for an extension that is not in the table.
const Extension* extensionNamed(std::string_view name);

/// Returns true if the loader reads the extension.
bool isApplied(std::string_view name);

}  // namespace fragtrace
