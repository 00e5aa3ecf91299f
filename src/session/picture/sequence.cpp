// SPDX-License-Identifier: MIT
#include "session/picture/sequence.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <glm/gtx/rotate_vector.hpp>
#include <string>

#include "image/files/video_format.h"

namespace fragtrace {

namespace {

/// The pattern with the result of `wordFor(width)` in place of its last run of #.
template <typename WordFor>
std::filesystem::path filled(const std::filesystem::path& pattern, const WordFor& wordFor) {
  std::string name = pattern.filename().string();
  const size_t last = name.rfind('#');
  if (last == std::string::npos) return pattern;
  size_t first = last;
  while (first > 0 && name[first - 1] == '#') --first;
  const size_t width = last - first + 1;
  name.replace(first, width, wordFor(width));
  return std::filesystem::path(pattern).replace_filename(name);
}

}  // namespace

std::filesystem::path numberedName(const std::filesystem::path& pattern, int number) {
  return filled(pattern, [&](size_t width) {
    const std::string digits = std::to_string(number);
    return std::string(width - std::min(width, digits.size()), '0') + digits;
  });
}

std::filesystem::path namedFile(const std::filesystem::path& pattern, const std::string& word, int number) {
  const auto isPlain = [](unsigned char c) { return c >= 0x20 && c != 0x7f && c != '/' && c != '#'; };
  const bool isName = !word.empty() && std::ranges::all_of(word, isPlain);
  return isName ? filled(pattern, [&](size_t) { return word; }) : numberedName(pattern, number);
}

FrameRange rangeOf(const SequenceOptions& sequence) {
  return sequence.turntable > 0 ? FrameRange{0, sequence.turntable - 1, 1} : sequence.frames.value();
}

double picturesPerSecond(const SequenceOptions& sequence) { return sequence.fps / rangeOf(sequence).step; }

bool isStream(const OutputOptions& output) {
  return output.toStandardOutput || videoFormatOf(output.file) != nullptr;
}

int frameCount(const SequenceOptions& sequence) {
  const FrameRange range = rangeOf(sequence);
  return (range.last - range.first) / range.step + 1;
}

uint32_t seedOfPicture(uint32_t seed, int number) {
  // Each step is a permutation of 31 bits that leaves 0 alone. The lowest bit stays the seed's.
  constexpr uint32_t kBits = 0x7fffffffu;
  uint32_t bits = uint32_t(number);
  bits = (bits ^ bits >> 15) * 0x2c1b3c6du & kBits;
  bits = (bits ^ bits >> 12) * 0x297a2d39u & kBits;
  return seed ^ (bits ^ bits >> 15) << 1;
}

SequenceFrame frameOf(const RenderOptions& options, int index) {
  const SequenceOptions& sequence = options.output.sequence;
  const FrameRange range = rangeOf(sequence);
  SequenceFrame frame{range.first + index * range.step, options, 0.0};
  frame.options.sampling.seed = seedOfPicture(options.sampling.seed, frame.number);
  if (!isStream(options.output)) frame.options.output.file = numberedName(options.output.file, frame.number);
  if (!options.output.statsFile.empty())
    frame.options.output.statsFile = numberedName(options.output.statsFile, frame.number);
  if (sequence.turntable > 0) {
    frame.turn = 2.0 * glm::pi<double>() * frame.number / sequence.turntable;
    frame.options.camera.overrides.turns = true;
    frame.sweep = 2.0 * glm::pi<double>() / sequence.turntable * options.camera.shutter / 360.0;
  } else {
    frame.options.selection.animationTime = frame.number / sequence.fps;
  }
  if (options.device.traversal == TraversalMethod::Auto)
    frame.options.device.traversal = TraversalMethod::FrontToBack;
  frame.options.output.sequence = {};
  frame.options.output.sequence.fps = sequence.fps;
  return frame;
}

Camera turnedCamera(Camera camera, const glm::dvec3& focalPoint, double angle) {
  const auto turned = [&](const glm::dvec3& v) { return glm::rotateY(v, angle); };
  camera.position = focalPoint + turned(camera.position - focalPoint);
  camera.forward = turned(camera.forward);
  camera.up = turned(camera.up);
  return camera;
}

void turnLights(Scene& scene, const glm::dvec3& focalPoint, double angle) {
  const glm::dvec3 middle = scene.space.localOf(focalPoint);
  for (Light& light : scene.lights) {
    light.position = glm::vec3(middle + glm::rotateY(glm::dvec3(light.position) - middle, angle));
    light.direction = glm::vec3(glm::rotateY(glm::dvec3(light.direction), angle));
  }
}

}  // namespace fragtrace
