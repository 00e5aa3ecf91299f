// SPDX-License-Identifier: MIT
// The extensions of glTF that the loader knows, in one table. docs/gltf.md has a row for each.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace fragtrace {

class MaterialPart;
struct Material;

enum class Support : uint8_t { Supported, Partly };

struct Extension {
  std::string_view name;
  Support support = Support::Supported;
  std::string_view reader;        ///< the file of src/gltf that reads it
  std::string_view members = {};  ///< members of a material's extension, with spaces between: a texture ends
                                  ///< in Texture, NAME[3] is three numbers, all others are numbers
  void (*read)(const MaterialPart&, Material&) = nullptr;  ///< reads a material's extension
};

/// All extensions; those of materials in the order in which they are read. Their table is next to the
/// functions that read these (assemble/materials.cpp).
std::span<const Extension> extensions();

/// Returns null for an extension that is not in the table, which the loader does not read.
const Extension* extensionNamed(std::string_view name);

}  // namespace fragtrace
