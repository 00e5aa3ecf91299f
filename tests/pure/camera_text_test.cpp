// SPDX-License-Identifier: MIT
#include "options/command_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/errors.h"
#include "options/parse_render.h"
#include "view/camera_controller.h"

namespace fragtrace {
namespace {

/// Returns the viewer's options after a movement.
RenderOptions optionsOf(const CameraPose& pose) {
  RenderOptions options;
  options.camera.overrides = overridesOf(pose);
  return options;
}

TEST(CameraText, SaysWhatIsSet) {
  RenderOptions options;
  EXPECT_EQ(cameraText(options), "");
  options.camera.index = 2;
  options.camera.overrides.position = glm::dvec3(-0.5, 0.1, 1e-7);
  options.camera.resolution = glm::ivec2(640, 480);
  EXPECT_EQ(cameraText(options), "--camera-index 2 --camera-position -0.5,0.1,1e-07 --resolution 640,480");
}

TEST(CameraArguments, SizesMayBeWrittenWithAnX) {
  EXPECT_EQ(withNumberSettled("640x480", "--resolution"), "640,480");
  EXPECT_EQ(withNumberSettled("--resolution=640x480", ""), "--resolution=640,480");
  EXPECT_EQ(withNumberSettled("0x10", "--seed"), "0x10");
  EXPECT_EQ(withNumberSettled("-.5", "--exposure"), "-0.5");
  for (const char* other :
       {"x480", "640x", "640x480x2", "640 x 480", "0x1f", "room.gltf", "--resolution=", ""}) {
    EXPECT_EQ(withNumberSettled(other, "--resolution"), other);
  }
}

TEST(CameraText, ReadsBackAsItselfBitForBit) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> mantissa(-2.0, 2.0);
  std::uniform_int_distribution<int> exponent(-40, 25);
  const auto number = [&] { return std::ldexp(mantissa(random), exponent(random)); };
  const auto vector = [&] { return glm::dvec3(number(), number(), number()); };
  for (int i = 0; i < 2000; ++i) {
    RenderOptions options = optionsOf(
        {.position = vector(), .focalPoint = vector(), .viewUp = vector(), .type = CameraType(i % 2)});
    if (i % 4 > 1) options.camera.overrides.lensShift = {0.1 * i / 2000.0, -5.0 + i / 300.0};
    if (i % 2 == 0)
      options.camera.overrides.viewAngleDegrees = std::abs(number());
    else
      options.camera.overrides.parallelScale = std::abs(number());
    options.camera.sceneOrigin = vector();
    if (i % 3 == 0) options.camera.index = i;
    if (i % 5 == 0) {
      options.camera.overrides.position.reset();
      options.camera.overrides.orbit = Orbit{number(), i % 90 - 45.0, i % 10 == 0 ? 1.0 : 0.5 + i};
      options.camera.overrides.fit = i % 4 == 0;
    }
    const RenderOptions read = withCameraText(RenderOptions(), cameraText(options));
    ASSERT_EQ(read.camera.overrides, options.camera.overrides) << cameraText(options);
    ASSERT_EQ(read.camera.sceneOrigin, options.camera.sceneOrigin);
    ASSERT_EQ(read.camera.index, options.camera.index);
  }
}

TEST(CameraText, LeavesTheOtherOptionsAlone) {
  RenderOptions options = optionsOf({});
  options.sampling.spp = 5;
  options.camera.index = 1;
  options.camera.resolution = glm::ivec2(64, 48);
  const RenderOptions read = withCameraText(options, "--camera-position -.5,0,3");
  EXPECT_EQ(read.sampling.spp, 5);
  EXPECT_EQ(read.camera.resolution, glm::ivec2(64, 48));
  EXPECT_FALSE(read.camera.index);
  EXPECT_EQ(read.camera.overrides.position, glm::dvec3(-0.5, 0, 3));
  EXPECT_FALSE(read.camera.overrides.focalPoint);
}

TEST(CameraText, WhatIsNoCameraIsRefused) {
  for (const char* text :
       {"hello", "--spp 4", "--camera-position 1,2", "--camera-position 1,2,x", "--camera-position 1,2,nan",
        "--camera-view-up 0,0,0", "--camera-focal-point 2e30,0,0",
        "--camera-view-angle 30 --camera-parallel-scale 2"}) {
    EXPECT_THROW(withCameraText(RenderOptions(), text), UsageError) << text;
  }
}

}  // namespace
}  // namespace fragtrace
