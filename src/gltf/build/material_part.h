// SPDX-License-Identifier: MIT
// A part of a material in the file, the material itself or one of its extensions: factors, colours and uses
// of textures, with warnings for what is out of range.
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "gltf/build/textures.h"
#include "gltf/read/document.h"
#include "scene/scene.h"

namespace fragtrace {

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

}  // namespace fragtrace
