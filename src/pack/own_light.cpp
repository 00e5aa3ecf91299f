// SPDX-License-Identifier: MIT
#include "pack/own_light.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>

#include "base/vectors.h"
#include "pack/pack_lights.h"
#include "pack/pack_textures.h"
#include "shader/variant.h"

namespace fragtrace {

namespace {

constexpr double kDimRadiance = 0.01;

/// Areas of emissive surfaces by material, m^2 of local space.
std::vector<double> emissiveAreas(const Scene& scene) {
  std::vector<double> areas(scene.materials.size(), 0.0);
  for (const Triangle& t : scene.triangles) {
    if (scene.materials[t.material].emissive()) areas[t.material] += areaOf(cornersOf<glm::dvec3>(scene, t));
  }
  for (const Sphere& s : scene.spheres) {
    if (scene.materials[s.material].emissive())
      areas[s.material] += 4.0 * glm::pi<double>() * double(s.radius) * double(s.radius);
  }
  return areas;
}

}  // namespace

bool shinesByTexturesAlone(const Scene& scene) {
  const auto shinesEvenly = [&scene](const auto& primitive) {
    const Material& m = scene.materials[primitive.material];
    return m.emissive() && !m.emissiveTexture.present();
  };
  return hasOwnLight(scene) && scene.lights.empty() && std::ranges::none_of(scene.triangles, shinesEvenly) &&
         std::ranges::none_of(scene.spheres, shinesEvenly);
}

OwnLight ownLight(const Scene& scene) {
  if (!hasOwnLight(scene)) return OwnLight::None;
  if (!shinesByTexturesAlone(scene)) return OwnLight::Enough;
  const std::vector<double> areas = emissiveAreas(scene);
  constexpr int kSide = 64;  // pixels: enough for a mean, and little memory
  TexturePacker textures(scene, kSide);
  const double enough = kDimRadiance * scene.bounds.area() / (scene.space.unit * scene.space.unit);
  double light = 0.0;
  for (size_t i = 0; i < areas.size(); ++i) {
    if (areas[i] == 0.0) continue;
    light += areas[i] * luminance(glm::dvec3(textures.meanRadiance(scene.materials[i])));
    if (light >= enough) return OwnLight::Enough;
  }
  return OwnLight::Dim;
}

}  // namespace fragtrace
