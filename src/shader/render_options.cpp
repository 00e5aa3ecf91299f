// SPDX-License-Identifier: MIT
#include "shader/render_options.h"

namespace fragtrace {

SunPlace sunOf(const SkyOptions& sky) {
  const std::optional<double> days = daysOf(sky.time);
  return days && sky.place ? sunPlaceAt(*days, *sky.place) : sky.sun;
}

void placeSun(SkyOptions& sky, const SunPlace& sun) {
  sky.sun = sun;
  sky.time.clear();
  sky.place.reset();
}

double environmentTurn(const LightOptions& light) {
  return light.hdriRotationDegrees - (light.sky.on ? sunOf(light.sky).azimuth : 0.0);
}

}  // namespace fragtrace
