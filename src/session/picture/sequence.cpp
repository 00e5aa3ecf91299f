// SPDX-License-Identifier: MIT
#include "session/picture/sequence.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/gtc/constants.hpp>
#include <glm/gtx/rotate_vector.hpp>

#include "base/errors.h"
#include "base/text.h"
#include "base/worker.h"
#include "image/files/whole_file.h"
#include "options/option_text.h"
#include "scene/motion/moving_scene.h"
#include "session/interrupt.h"
#include "session/picture/denoising.h"
#include "session/say.h"
#include "session/setup.h"
#include "session/shutter.h"

namespace fragtrace {

namespace {

constexpr const char* kEncoder = "ffmpeg";

void closeFile(int& file) {
  if (file >= 0) ::close(file);
  file = -1;
}

/// The last words of the encoder, on one line.
std::string lastWords(int said) {
  constexpr off_t kMostBytes = 4096;
  constexpr size_t kMostLines = 3;
  const off_t end = ::lseek(said, 0, SEEK_END);
  std::string text(size_t(std::clamp(end, off_t(0), kMostBytes)), '\0');
  const ssize_t read = ::pread(said, text.data(), text.size(), std::max(off_t(0), end - kMostBytes));
  text.resize(size_t(std::max(read, ssize_t(0))));
  std::vector<std::string> lines;
  for (const std::string_view line : splitText(text, '\n')) {
    if (line.find_first_not_of(" \r\t") != line.npos) lines.emplace_back(line);
  }
  return joined(std::span(lines).last(std::min(lines.size(), kMostLines)), "; ");
}

/// Ends the process at once, if it still runs, and removes what it has written.
void drop(Video& video) {
  closeFile(video.frames);
  closeFile(video.said);
  if (video.encoder > 0) {
    ::kill(video.encoder, SIGKILL);
    while (::waitpid(video.encoder, nullptr, 0) < 0 && errno == EINTR) {
    }
    video.encoder = -1;
  }
  if (!video.part.empty()) ::unlink(video.part.c_str());
  video.part.clear();
}

bool isGivenUp() { return interrupts() > 1; }

/// Puts what was encoded in the place of that file.
void keepAs(Video& video, const std::filesystem::path& file) {
  const std::filesystem::path part = std::exchange(video.part, {});
  if (partOf(file) != part) std::filesystem::rename(part, partOf(file));
  takePart(file);
  video.kept = file;
}

std::filesystem::path partialName(const Video& video) {
  const std::string name = video.file.stem().string() + ".partial" + video.file.extension().string();
  return video.part.parent_path() / name;
}

[[noreturn]] void fail(Video& video, const std::string& reason) {
  std::error_code unknown;
  const bool hasBytes =
      !video.part.empty() && std::filesystem::file_size(video.part, unknown) > 0 && !unknown;
  if (hasBytes && video.format->playsCut && video.count > 0 && !isGivenUp())
    keepAs(video, partialName(video));
  drop(video);
  throw RenderError("cannot write " + video.file.string() + ": " + reason);
}

/// Waits until the encoder has ended by itself, and throws unless all went well.
void awaitEncoder(Video& video) {
  constexpr useconds_t kStep = 2000;  // microseconds
  closeFile(video.frames);
  int status = 0;
  pid_t ended = 0;
  while (ended == 0 || (ended < 0 && errno == EINTR)) {
    if (isGivenUp()) fail(video, "interrupted, nothing is written");
    ended = ::waitpid(video.encoder, &status, WNOHANG);
    if (ended == 0) ::usleep(kStep);
  }
  video.encoder = -1;
  if (status == 0) return;
  const std::string words = lastWords(video.said);
  fail(video,
       std::string(kEncoder) +
           (WIFSIGNALED(status) ? " was ended by a signal (" + std::string(::strsignal(WTERMSIG(status)))
                                : " ended with status " + std::to_string(WEXITSTATUS(status))) +
           (WIFSIGNALED(status) ? ")" : "") + (words.empty() ? "" : ": " + words));
}

void writeFrame(Video& video, const std::vector<uint8_t>& bytes) {
  for (size_t written = 0; written < bytes.size();) {
    const ssize_t count = ::write(video.frames, bytes.data() + written, bytes.size() - written);
    if (count >= 0) {
      written += size_t(count);
    } else if (errno == EINTR) {
      if (isGivenUp()) fail(video, "interrupted, nothing is written");
    } else {
      const int code = errno;  // most likely nobody reads the pipe
      awaitEncoder(video);
      fail(video, std::string(kEncoder) + " takes no more frames: " + systemReason(code));
    }
  }
  ++video.count;
}

std::unique_ptr<Video> start(const std::filesystem::path& file, glm::ivec2 size, double framesPerSecond,
                             bool isTrial) {
  auto video = std::make_unique<Video>();
  video->file = file;
  video->format = videoFormatOf(file);
  video->size = size;
  if (!isTrial) removeParts(file);
  if (!isTrial) video->part = partOf(file);
  const PixelForm& pixels = video->format->pixels;
  std::vector<std::string> words = {kEncoder,
                                    "-hide_banner",
                                    "-loglevel",
                                    "error",
                                    "-xerror",
                                    "-y",
                                    "-f",
                                    "rawvideo",
                                    "-pixel_format",
                                    pixels.alpha ? "rgba64le" : "rgb24",
                                    "-video_size",
                                    std::to_string(size.x) + "x" + std::to_string(size.y),
                                    "-framerate",
                                    exactText(framesPerSecond),
                                    "-i",
                                    "pipe:0"};
  const auto add = [&](const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
  };
  add(encodingOf(*video->format));
  add(isTrial ? std::vector<std::string>{"-f", "null"} : containerOf(*video->format));
  // Without the protocol, a name with a colon would name another one.
  words.push_back("file:" + (isTrial ? "/dev/null" : video->part.string()));
  int pipe[2] = {-1, -1};
  video->said = ::memfd_create("messages of the encoder", MFD_CLOEXEC);
  if (video->said < 0 || ::pipe2(pipe, O_CLOEXEC) != 0) fail(*video, systemReason(errno));
  video->frames = pipe[1];
  const int error = spawnProcess(
      kEncoder, std::move(words),
      {{STDIN_FILENO, pipe[0]}, {STDOUT_FILENO, kNoFile}, {STDERR_FILENO, video->said}}, video->encoder);
  if (error != 0) video->encoder = -1;
  ::close(pipe[0]);
  if (error == ENOENT)
    throw UsageError("--output " + file.string() + ": the program ffmpeg makes videos, and PATH has none " +
                     "(Debian's package ffmpeg); #### in the name of a .png makes numbered pictures");
  if (error != 0) fail(*video, std::string(kEncoder) + " cannot be started: " + systemReason(error));
  return video;
}

/// The pattern with the result of `wordFor(width)` instead of its last run of #.
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

/// The name with the number instead of its last run of #, with at least as many digits.
std::filesystem::path numberedName(const std::filesystem::path& pattern, int number) {
  return filled(pattern, [&](size_t width) {
    const std::string digits = std::to_string(number);
    return std::string(width - std::min(width, digits.size()), '0') + digits;
  });
}

/// The seed of a picture of a sequence with that seed: picture 0 has the seed itself, and no two pictures
/// have the same. None is the seed of an adaptive picture's second half (seedOfOtherHalf), which is even
/// where the picture's seed is odd, and odd where it is even.
uint32_t seedOfPicture(uint32_t seed, int number) {
  // Each step is a permutation of 31 bits that leaves 0 alone. The lowest bit stays the seed's.
  constexpr uint32_t kBits = 0x7fffffffu;
  uint32_t bits = uint32_t(number);
  bits = (bits ^ bits >> 15) * 0x2c1b3c6du & kBits;
  bits = (bits ^ bits >> 12) * 0x297a2d39u & kBits;
  return seed ^ (bits ^ bits >> 15) << 1;
}

}  // namespace

Video::~Video() { drop(*this); }

void checkVideo(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw RenderError("cannot write " + file.string() + ": it is no file that a video could replace");
  constexpr int kSide = 64;
  const auto trial = start(file, {kSide, kSide}, 1.0, true);
  const PixelForm& pixels = trial->format->pixels;
  const int bytes = pixels.bits / 8 * (pixels.alpha ? 4 : 3);
  writeFrame(*trial, std::vector<uint8_t>(size_t(kSide * kSide * bytes)));
  awaitEncoder(*trial);
}

std::unique_ptr<Video> startVideo(const std::filesystem::path& file, glm::ivec2 size,
                                  double framesPerSecond) {
  return start(file, size, framesPerSecond, false);
}

void addFrame(Video& video, const Image& display) {
  if (glm::ivec2(display.width, display.height) != video.size)
    fail(video, "its pictures differ in size; --resolution gives all of them one");
  writeFrame(video, pixelsOf(display, video.format->pixels));
}

void finishVideo(Video& video, int frames) {
  awaitEncoder(video);
  keepAs(video, video.count < frames ? partialName(video) : video.file);
}

std::filesystem::path namedFile(const std::filesystem::path& pattern, const std::string& word, int number) {
  const auto isPlain = [](unsigned char c) { return c >= 0x20 && c != 0x7f && c != '/' && c != '#'; };
  const bool isName = !word.empty() && std::ranges::all_of(word, isPlain);
  return isName ? filled(pattern, [&](size_t) { return word; }) : numberedName(pattern, number);
}

FrameRange rangeOf(const SequenceOptions& sequence) {
  return sequence.frames ? *sequence.frames : FrameRange{0, sequence.turntable - 1, 1};
}

double picturesPerSecond(const SequenceOptions& sequence) { return sequence.fps / rangeOf(sequence).step; }

bool isStream(const OutputOptions& output) {
  return output.toStandardOutput || videoFormatOf(output.file) != nullptr;
}

int frameCount(const SequenceOptions& sequence) {
  const FrameRange range = rangeOf(sequence);
  return (range.last - range.first) / range.step + 1;
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

namespace {

/// The camera turned by an angle (radians, to the right as seen through it) about the vertical axis, +Y,
/// through its focal point.
Camera turnedCamera(Camera camera, const glm::dvec3& focalPoint, double angle) {
  const auto turned = [&](const glm::dvec3& v) { return glm::rotateY(v, angle); };
  camera.position = focalPoint + turned(camera.position - focalPoint);
  camera.forward = turned(camera.forward);
  camera.up = turned(camera.up);
  return camera;
}

/// Turns the scene's punctual lights in the same way, so that they stay before such a camera.
void turnLights(Scene& scene, const glm::dvec3& focalPoint, double angle) {
  const glm::dvec3 middle = scene.space.localOf(focalPoint);
  for (Light& light : scene.lights) {
    light.position = glm::vec3(middle + glm::rotateY(glm::dvec3(light.position) - middle, angle));
    light.direction = glm::vec3(glm::rotateY(glm::dvec3(light.direction), angle));
  }
}

/// Pictures after the end of an animation are all the same.
void warnBeyondEnd(const RenderOptions& options, const SequenceOptions& sequence, const Scene& scene) {
  const std::optional<double> length = animationLength(scene, options.selection);
  const int last = rangeOf(sequence).last;
  if (!length) return;
  const int end = int(std::ceil(*length * sequence.fps - kKeyTimeRounding));
  if (last > end)
    say(options,
        formatted(
            "warning: --frames: the animation ends after %.4g s, at picture %d; those after it show its end",
            *length, end));
}

}  // namespace

Statistics prepareFrame(Session& session, Device& device, const SequenceFrame& frame,
                        const SequenceOptions& sequence) {
  const bool first = !session.hasTracer();
  const bool turns = sequence.turntable > 0;
  const auto turnsBeforeLamps = [&] {
    return turns && sequence.turn == Turn::Object && session.isLoaded() &&
           !session.loaded().scene.lights.empty();
  };
  const auto change = [&](LoadedScene& loaded) {
    if (turns) loaded.scene.motion.camera = frame.sweep > 0.0;
    if (turnsBeforeLamps())
      turnLights(loaded.scene, turningPoint(loaded.camera, loaded.overrides, loaded.framed), frame.turn);
  };
  Statistics stats;
  const Renewal least = turnsBeforeLamps() ? Renewal::Pose : Renewal::None;
  session.set(withGuides(frame.options), device, stats, {least, change});
  if (first && !turns) warnBeyondEnd(frame.options, sequence, session.loaded().scene);
  return stats;
}

void turnView(LoadedScene& loaded, const RenderOptions& options, const SequenceFrame& frame,
              const SequenceOptions& sequence) {
  if (sequence.turntable == 0) return;
  const Camera camera = loaded.camera;
  const glm::dvec3 focalPoint = turningPoint(camera, loaded.overrides, loaded.framed);
  const auto turned = [&](double angle) { return turnedCamera(camera, focalPoint, angle); };
  loaded.camera = turned(frame.turn);
  const int segments = int(std::ceil(frame.sweep / glm::half_pi<double>()));
  std::vector<Camera> poses;
  for (int i = 0; i <= segments && segments > 0; ++i)
    poses.push_back(turned(frame.turn + (double(i) / segments - 0.5) * frame.sweep));
  loaded.motion = segmentsThrough(poses);
  loaded.view = makeView(options, loaded, loaded.camera);
  if (sequence.turn == Turn::Object) loaded.view.hdriRotation += frame.turn;
}

}  // namespace fragtrace
