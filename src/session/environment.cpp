// SPDX-License-Identifier: MIT
#include "session/environment.h"

#include <cmath>
#include <utility>

#include "base/errors.h"
#include "base/text.h"
#include "scene/sky/blurred_map.h"
#include "scene/sky/sky.h"
#include "scene/studio.h"
#include "session/say.h"

namespace fragtrace {

namespace {

/// Numbers of values that were no light.
struct NoLight {
  size_t negative = 0, infinite = 0, noNumber = 0;
};

/// Values below 0, which filters leave, and values that are no number become 0. Infinite ones become what the
/// formats of 16 bits hold at most.
NoLight settleRadiance(Image& image) {
  constexpr float kBrightest = 65504.0f;
  NoLight found;
  for (float& value : image.values) {
    if (std::isfinite(value) && value >= 0.0f) continue;
    const bool isInfinite = value > 0.0f;
    ++(isInfinite ? found.infinite : std::isnan(value) ? found.noNumber : found.negative);
    value = isInfinite ? kBrightest : 0.0f;
  }
  return found;
}

void warn(const RenderOptions& options, const std::string& what, std::vector<std::string>& warnings) {
  warnings.push_back(options.light.hdriFile.string() + what);
  say(options, "warning: " + warnings.back());
}

}  // namespace

std::string whyDark(const SkyOptions& sky) {
  return sunOf(sky).elevation < 0.0
             ? "the sun is below the horizon: the sky gives little light, or none (--exposure)"
             : "";
}

Environment skyOf(const RenderOptions& options, std::vector<std::string>& warnings) {
  constexpr double kNight = -18.0;  // degrees
  const SkyOptions& sky = options.light.sky;
  const double elevation = sunOf(sky).elevation;
  if (elevation < kNight) {
    warnings.emplace_back("--sky: the sun is " + std::to_string(std::lround(-elevation)) +
                          " degrees below the horizon: it is night");
    say(options, "warning: " + warnings.back());
  } else if (const std::string dark = whyDark(sky); !dark.empty()) {
    say(options, dark);
  }
  SkyMap map = makeSky(sky.turbidity, sky.groundAlbedo, elevation);
  Environment environment{Surroundings::Map, std::move(map.image), {}, map.sun};
  if (options.light.backgroundBlur > 0.0)
    environment.backdrop = blurredMap(withDisc(environment.image, map.sun), options.light.backgroundBlur);
  return environment;
}

LinearImage readMap(const RenderOptions& options) {
  LinearImage image = readLinearImage(options.light.hdriFile, options.limits.memoryBytes);
  image.image = wholeOf(std::move(image.image));
  return image;
}

Environment makeEnvironment(const RenderOptions& options, std::future<LinearImage>& map, OwnLight light,
                            std::vector<std::string>& warnings) {
  Environment environment;
  if (map.valid()) {
    LinearImage read = map.get();
    environment.kind = Surroundings::Map;
    sayNotes(options, options.light.hdriFile, read.image);
    if (read.image.channelCount() < 3) throw InputError(options.light.hdriFile.string() + ": has no colour");
    environment.image = std::move(read.image);
    Image& image = environment.image;
    const NoLight found = settleRadiance(image);
    const auto warnOf = [&](size_t count, const char* what) {
      if (count > 0) warn(options, ": " + countText(count, "value") + what, warnings);
    };
    warnOf(found.negative, " below 0, which is no light, taken as 0");
    warnOf(found.infinite, " without bound, taken as 65504");
    warnOf(found.noNumber,
           found.noNumber == 1 ? " that is no number, taken as 0" : " that are no numbers, taken as 0");
    if (read.wasEncoded)
      warn(options, ": holds no light above 1, so no sun and no lamp; an .hdr, .exr or .pfm does", warnings);
    // Mirror balls and faces of cubes are square; there is one reading of an environment here.
    if (image.width == image.height && image.width > 1)
      warn(options, ": is square, and drawn as latitude and longitude: 360 degrees wide, 180 high", warnings);
    environment.mapSun = sunOfMap(image);
    if (options.light.backgroundBlur > 0.0)
      environment.backdrop = blurredMap(image, options.light.backgroundBlur);
  } else if (options.light.sky.on) {
    environment = skyOf(options, warnings);
  } else if (options.light.studio ||
             (light != OwnLight::Enough && options.light.defaultLight == DefaultLight::Studio)) {
    environment = {Surroundings::Map, studioLight(options.light.studioLook),
                   studioBackdrop(options.light.studioLook)};
  } else if (light != OwnLight::Enough && options.light.defaultLight == DefaultLight::White) {
    environment.kind = Surroundings::DefaultLight;
    environment.image = {1, 1, {"R", "G", "B"}, {1.0f, 1.0f, 1.0f}, {}};
  }
  return environment;
}

}  // namespace fragtrace
