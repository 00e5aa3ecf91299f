// SPDX-License-Identifier: MIT
// The pictures of a sequence: their numbers, names, times and views.
#pragma once

#include <filesystem>

#include "scene/camera.h"
#include "shader/render_options.h"

namespace fragtrace {

/// One picture of a sequence.
struct SequenceFrame {
  int number = 0;
  RenderOptions options;  ///< the options with the picture's own names and time
  double turn = 0.0;      ///< radians about the focal point
  double sweep = 0.0;     ///< the part of the turn for which the shutter is open, radians
};

/// The name with the number in place of its last run of #, with at least as many digits.
std::filesystem::path numberedName(const std::filesystem::path& pattern, int number);

/// The name with that word in place of its last run of #. The number takes its place if the word is empty or
/// unsuitable for the name of a file.
std::filesystem::path namedFile(const std::filesystem::path& pattern, const std::string& word, int number);

/// The numbers of the sequence's pictures; isSequence() must hold.
FrameRange rangeOf(const SequenceOptions& sequence);

/// The speed at which a video of the sequence shows its pictures: that of the animation.
double picturesPerSecond(const SequenceOptions& sequence);

/// Returns true if the pictures follow each other in one file, or on standard output.
bool isStream(const OutputOptions& output);

int frameCount(const SequenceOptions& sequence);

/// The seed of a picture of a sequence with that seed: picture 0 has the seed itself, and no two pictures
/// have the same. None is the seed of an adaptive picture's second half (seedOfOtherHalf), which is even
/// where the picture's seed is odd, and odd where it is even.
uint32_t seedOfPicture(uint32_t seed, int number);

/// The picture of that index, from 0; the options are of a sequence. Small scenes do not become shader text
/// in it, so that one program draws all pictures.
SequenceFrame frameOf(const RenderOptions& options, int index);

/// The camera turned by an angle (radians, to the right as seen through it) about the vertical axis, +Y,
/// through its focal point.
Camera turnedCamera(Camera camera, const glm::dvec3& focalPoint, double angle);

/// Turns the scene's punctual lights in the same way, so that they stay before such a camera.
void turnLights(Scene& scene, const glm::dvec3& focalPoint, double angle);

}  // namespace fragtrace
