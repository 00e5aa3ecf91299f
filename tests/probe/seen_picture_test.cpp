// SPDX-License-Identifier: MIT
// The past of a camera that moves, joined with the present on the driver.
#include "render/picture_passes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "gl/program.h"
#include "gl_probe.h"
#include "image/channels.h"
#include "render/denoise.h"
#include "scene/camera.h"

namespace fragtrace {
namespace {

constexpr int kSide = 64;
constexpr double kDistance = 4.0;
constexpr double kLight = 3.0;  // without albedo

/// Returns the albedo of the wall z = 0: stripes that are wide compared with a pixel.
double albedoAt(double x) { return 0.5 + 0.05 * std::sin(1.5 * x); }

Camera cameraAt(double x, double distance) {
  Camera camera;
  camera.position = {x, 0.0, distance};
  camera.forward = {0.0, 0.0, -1.0};
  camera.up = {0.0, 1.0, 0.0};
  camera.type = CameraType::Perspective;
  camera.fovY = 0.8;
  return camera;
}

/// A picture with the layers of a noisy one, and the camera that saw it. The wall looks the same upside down.
struct Seen {
  Image layers;
  Camera camera;
};

/// The wall, lit evenly, as that camera sees it.
Seen seen(const Camera& camera, double light, double samples, double variance) {
  Seen picture;
  picture.camera = camera;
  picture.layers = {kSide, kSide, {"R", "G", "B", "samples.Y", "variance.Y"}, {}, {}};
  picture.layers.channels.insert(picture.layers.channels.end(), kGuideChannels.begin(), kGuideChannels.end());
  const Projection projection = projectionOf(camera, 1.0);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const glm::dvec2 place = 2.0 * (glm::dvec2(x, kSide - 1 - y) + 0.5) / double(kSide) - 1.0;
      const std::optional<Ray> ray = rayThrough(projection, {}, place);
      const double covered = ray && ray->direction.z < 0.0f ? 1.0 : 0.0;
      const double distance = covered > 0.0 ? -ray->origin.z / ray->direction.z : 0.0;
      const double wall = covered > 0.0 ? ray->origin.x + distance * ray->direction.x : 0.0;
      const float albedo = float(covered * albedoAt(wall));
      const float radiance = float(covered * light * (0.96 * albedo + 0.04));
      const double depth = isRectilinear(camera.type) ? covered * camera.position.z : distance;
      for (const double value :
           {double(radiance), double(radiance), double(radiance), samples, variance, double(albedo),
            double(albedo), double(albedo), covered, 0.0, 0.0, covered, depth})
        picture.layers.values.push_back(float(value));
    }
  }
  return picture;
}

float valueOf(const Image& image, const char* channel, int x, int y) {
  return image
      .values[(size_t(y) * kSide + size_t(x)) * image.channelCount() + findChannel(image, channel).value()];
}

SeenPicture uploaded(const Seen& seen) {
  bool observed = false;
  return {texturesOf(seen.layers, observed), {kSide, kSide}, seen.camera};
}

class Reprojection : public GlProbe {
 protected:
  static Image joined(const Seen& now, const Seen& past, double most) {
    SeenPasses seenPasses(shaderSource({}));
    PicturePasses passes(shaderSource({}));
    const SeenPicture fresh = uploaded(now);
    const SeenPicture present = uploaded(now);
    seenPasses.join(fresh.noisy, present, uploaded(past), most, passes);
    return imageOf(present.noisy, present.size);
  }
  /// Returns a picture as the device keeps it.
  static Image asIs(const Seen& now) {
    const SeenPicture present = uploaded(now);
    return imageOf(present.noisy, present.size);
  }
};

TEST_P(Reprojection, JoinsAsIfAllSamplesHadBeenSeen) {
  const Camera camera = cameraAt(0.0, kDistance);
  const Seen now = seen(camera, kLight, 4, 0.25);
  const Seen past = seen(camera, 1.1 * kLight, 8, 0.125);
  const Image whole = joined(now, past, 100.0);
  const double own = valueOf(now.layers, "G", 20, 30);
  EXPECT_NEAR(valueOf(whole, "samples.Y", 20, 30), 12.0, 1e-4);
  EXPECT_NEAR(valueOf(whole, "G", 20, 30), (4.0 * own + 8.0 * 1.1 * own) / 12.0, 1e-4);
  const double m2 = 0.25 * 4 * 3 + 0.125 * 8 * 7 + 0.01 * own * own * 4 * 8 / 12;
  EXPECT_NEAR(valueOf(whole, "variance.Y", 20, 30), m2 / (12 * 11), 1e-4);
}

TEST_P(Reprojection, APastThatIsWrongCountsForWhatItIsWorth) {
  const Camera camera = cameraAt(0.0, kDistance);
  const Seen now = seen(camera, kLight, 4, 0.25);
  const double own = valueOf(now.layers, "G", 20, 30);
  // Wrong by as much as the light itself: as many samples as have that error.
  const Image whole = joined(now, seen(camera, 2.0 * kLight, 50, 0.0), 100.0);
  EXPECT_NEAR(valueOf(whole, "samples.Y", 20, 30), 4.0 + 4.0 * 0.25 / (own * own), 0.02);
  // With one sample, the noise is known only from differences between pixels. Here there are none.
  const Image single = joined(seen(camera, kLight, 1, 0.0), seen(camera, 2.0 * kLight, 50, 0.0), 100.0);
  EXPECT_NEAR(valueOf(single, "samples.Y", 20, 30), 1.0, 0.01);
}

TEST_P(Reprojection, ThePastCountsForNoMoreThanAllowed) {
  const Camera camera = cameraAt(0.0, kDistance);
  const Image whole = joined(seen(camera, kLight, 1, 0.0), seen(camera, kLight, 500, 0.1), 16.0);
  EXPECT_NEAR(valueOf(whole, "samples.Y", 5, 5), 17.0, 1e-3);
}

TEST_P(Reprojection, ACameraThatMovedFindsTheSamePoints) {
  const Seen now = seen(cameraAt(0.3, 3.5), kLight, 4, 0.25);
  const Seen past = seen(cameraAt(0.0, kDistance), kLight, 1e6, 0.0);
  const Image whole = joined(now, past, 1e6);
  // The past's light at the present's texture, to a bilinear lookup of a stripe.
  for (int x = 8; x < kSide - 8; ++x) {
    EXPECT_NEAR(valueOf(whole, "R", x, 32) / valueOf(now.layers, "R", x, 32), 1.0, 2e-3) << x;
    EXPECT_GT(valueOf(whole, "samples.Y", x, 32), 1e4) << x;
  }
}

TEST_P(Reprojection, EachTypeOfCameraFindsTheSamePoints) {
  for (const CameraType type : {CameraType::Orthographic, CameraType::Panorama, CameraType::Fisheye}) {
    for (const bool shifted : {false, true}) {
      Camera camera = cameraAt(0.3, 3.5);
      camera.type = type;
      camera.fovY = type == CameraType::Fisheye ? 2.0 : camera.fovY;
      if (type == CameraType::Orthographic && shifted) camera.shift = {0.2, -0.1};
      // The past is a perspective, or another of the same type.
      Camera before = cameraAt(0.0, kDistance);
      if (shifted) before = camera;
      if (!isRectilinear(type)) before.fovY = 2.2;
      before.position = {0.0, 0.0, kDistance};
      const Seen now = seen(camera, kLight, 4, 0.25);
      const Image whole = joined(now, seen(before, kLight, 1e6, 0.0), 1e6);
      // The middle is where all see the wall in pixels that are fine next to a stripe.
      for (int x = 29; x < 36; ++x) {
        EXPECT_NEAR(valueOf(whole, "R", x, 32) / valueOf(now.layers, "R", x, 32), 1.0, 4e-3)
            << int(type) << shifted << x;
        EXPECT_GT(valueOf(whole, "samples.Y", x, 32), 1e3) << int(type) << shifted << x;
      }
    }
  }
}

TEST_P(Reprojection, OtherSurfacesGiveNothing) {
  const Camera camera = cameraAt(0.0, kDistance);
  const Seen now = seen(camera, kLight, 1, 0.0);
  for (const auto& [channel, value] : {std::pair{kGuideChannels[7], 3.5f},
                                       {kGuideChannels[6], -1.0f},
                                       {kGuideChannels[1], 0.9f},
                                       {kGuideChannels[3], 0.0f}}) {
    Seen past = seen(camera, 9.0, 8, 0.1);
    const size_t at = findChannel(past.layers, channel).value();
    for (size_t i = at; i < past.layers.values.size(); i += past.layers.channelCount())
      past.layers.values[i] = value;
    EXPECT_EQ(joined(now, past, 16.0).values, asIs(now).values) << channel;
  }
}

TEST_P(Reprojection, WhatWasOutsideThePastPictureStaysAsItIs) {
  const Seen now = seen(cameraAt(50.0, kDistance), kLight, 1, 0.0);
  EXPECT_EQ(joined(now, seen(cameraAt(0.0, kDistance), kLight, 8, 0.1), 16.0).values, asIs(now).values);
}

INSTANTIATE_TEST_SUITE_P(Backends, Reprojection, bothBackends(), backendName);

}  // namespace
}  // namespace fragtrace
