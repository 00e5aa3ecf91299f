// SPDX-License-Identifier: MIT
#pragma once

#include <tiny_gltf.h>

#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gltf/build/nodes.h"
#include "gltf/build/textures.h"
#include "gltf/read/document.h"
#include "scene/scene.h"

namespace fragtrace {

// A part of a material in the file, the material itself or one of its extensions: factors, colours and uses
// of textures, with warnings for what is out of range.

inline constexpr float kLargest = std::numeric_limits<float>::max();

class MaterialPart {
 public:
  /// `place` is the part's JSON pointer; `object` is null where tinygltf has taken it apart, and outlives
  /// this.
  MaterialPart(Diagnostics& diagnostics, TextureTable& textures, std::string place,
               const tinygltf::Value& object)
      : diagnostics_(diagnostics), textures_(textures), place_(std::move(place)), object_(object) {}

  /// A part of the same material at a place below this one.
  MaterialPart below(const std::string& name, const tinygltf::Value& object) const {
    return {diagnostics_, textures_, place_ + "/" + name, object};
  }

  const tinygltf::Value& object() const { return object_; }
  std::string placeOf(const std::string& name) const { return place_ + "/" + name; }
  void warn(const std::string& name, const std::string& reason) const {
    diagnostics_.warn(placeOf(name), reason);
  }

  /// The value, or the nearest of least..most with a warning.
  float within(double value, float least, float most, const std::string& name) const;
  glm::vec3 colorWithin(const std::vector<double>& values, float most, const std::string& name) const;

  /// Members of the object.
  float factor(const std::string& name, double otherwise, float least, float most) const;
  glm::vec3 color(const std::string& name, const std::vector<double>& otherwise, float most) const;
  TextureRef texture(const std::string& name) const;

  /// A use of a texture, with KHR_texture_transform as `transform` if that is an object; none if index < 0.
  TextureRef texture(int index, int texcoord, const tinygltf::Value& transform,
                     const std::string& name) const;

 private:
  TextureTransform transformOf() const;

  Diagnostics& diagnostics_;
  TextureTable& textures_;
  std::string place_;
  const tinygltf::Value& object_;
};

/// Appends all materials in the order of the file, with the textures they use, and last the default material.
/// Factors outside of their range are brought to it with a warning. `nodes` tell which materials are
/// drawn. Throws InputError.
void addMaterials(Document& document, const std::vector<PlacedNode>& nodes, Scene& scene);

/// Makes the materials of these names or indices double-sided, or all. Throws UsageError for one that is not
/// in the file.
void makeDoubleSided(const std::vector<std::string>& wanted, Scene& scene);

/// The extension's object in a material, or null if the material does not have it.
const tinygltf::Value* extensionOf(const tinygltf::Material& source, std::string_view name);

/// Reads the extensions of a material, of which `core` is the place and `result` holds what glTF itself says.
void readMaterialExtensions(const tinygltf::Material& source, const MaterialPart& core, Material& result);

}  // namespace fragtrace
