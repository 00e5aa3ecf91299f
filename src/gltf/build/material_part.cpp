// SPDX-License-Identifier: MIT
#include "gltf/build/material_part.h"

#include <cmath>

#include "base/text.h"
#include "gltf/read/value.h"

namespace fragtrace {

float MaterialPart::within(double value, float least, float most, const std::string& name) const {
  if (value >= double(least) && value <= double(most)) return float(value);
  const float nearest = value < double(least) ? least : most;
  warn(name, "is out of range, the nearest possible value is taken: " + shortText(double(nearest)));
  return nearest;
}

glm::vec3 MaterialPart::colorWithin(const std::vector<double>& values, float most,
                                    const std::string& name) const {
  glm::vec3 result(0.0f);
  for (int c = 0; c < 3; ++c) result[c] = within(values.at(size_t(c)), 0.0f, most, name);
  return result;
}

float MaterialPart::factor(const std::string& name, double otherwise, float least, float most) const {
  return within(numberOf(object_, name, otherwise), least, most, name);
}

glm::vec3 MaterialPart::color(const std::string& name, const std::vector<double>& otherwise,
                              float most) const {
  return colorWithin(numbersOf(object_, name, otherwise), most, name);
}

TextureRef MaterialPart::texture(const std::string& name) const {
  const tinygltf::Value& info = memberOf(object_, name);
  return texture(int(numberOf(info, "index", -1)), int(numberOf(info, "texCoord", 0)),
                 memberOf(memberOf(info, "extensions"), "KHR_texture_transform"), name);
}

TextureRef MaterialPart::texture(int index, int texcoord, const tinygltf::Value& transform,
                                 const std::string& name) const {
  TextureRef result;
  if (index < 0) return result;
  result = textures_.use(index);
  if (transform.IsObject()) {
    texcoord = int(numberOf(transform, "texCoord", texcoord));
    result.transform = below(name + "/extensions/KHR_texture_transform", transform).transformOf();
  }
  result.texcoord = uint32_t(texcoord);
  return result;
}

/// The matrix of KHR_texture_transform, translation times rotation times scale. Its rotation is
/// counter-clockwise as seen on the picture, v pointing down (KhronosGroup/glTF issue 1563).
TextureTransform MaterialPart::transformOf() const {
  constexpr double kMost = 1e6;  // beyond, a float has hardly any digits left for the place in the picture
  const std::vector<double> offset = numbersOf(object_, "offset", {0.0, 0.0});
  const std::vector<double> scale = numbersOf(object_, "scale", {1.0, 1.0});
  const auto bounded = [&](double value, const char* name) {
    return double(within(value, float(-kMost), float(kMost), name));
  };
  const double angle = std::fmod(numberOf(object_, "rotation", 0.0), 2.0 * M_PI);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const double x = bounded(scale.at(0), "scale");
  const double y = bounded(scale.at(1), "scale");
  TextureTransform result;
  result.u = glm::vec3(c * x, s * y, bounded(offset.at(0), "offset"));
  result.v = glm::vec3(-s * x, c * y, bounded(offset.at(1), "offset"));
  return result;
}

}  // namespace fragtrace
