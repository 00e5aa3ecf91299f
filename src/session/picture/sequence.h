// SPDX-License-Identifier: MIT
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>

#include <glm/glm.hpp>

#include "image/files/video_format.h"
#include "scene/camera.h"
#include "session/session.h"
#include "session/statistics.h"
#include "shader/render_options.h"

namespace fragtrace {

// A video that ffmpeg encodes in a process of its own, frame by frame.

/// The destructor drops a video that is not finished: it ends the process and removes the part.
struct Video {
  std::filesystem::path file;
  const VideoFormat* format = nullptr;
  glm::ivec2 size{0};          ///< size of all frames, pixels
  int count = 0;               ///< number of whole frames
  pid_t encoder = -1;          ///< its process; -1: none runs
  int frames = -1;             ///< the pipe that it reads them from
  int said = -1;               ///< file in memory with its messages
  std::filesystem::path part;  ///< the file that is being written; empty: there is none
  std::filesystem::path kept;  ///< the file that holds what was encoded; empty: there is none
  Video() = default;
  ~Video();
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;
};

/// To be called before long work: encodes one black frame to nothing. Throws UsageError where there is no
/// ffmpeg, RenderError where it cannot make such a video.
void checkVideo(const std::filesystem::path& file);

/// Starts an encoder for frames of that size. The name is that of a video. Throws as checkVideo() does.
std::unique_ptr<Video> startVideo(const std::filesystem::path& file, glm::ivec2 size, double framesPerSecond);

/// Appends a picture as a display shows it, of that size. Throws RenderError, with the encoder's last words,
/// also where the interrupted user waits no longer. The video is dropped then, or kept as one of fewer frames
/// where the encoder failed and players show a file that is cut off.
void addFrame(Video& video, const Image& display);

/// Ends the encoder and puts the video in its place; one of fewer than `frames` frames goes to
/// NAME.partial.EXTENSION instead, so that an older file stays. Throws as addFrame() does.
void finishVideo(Video& video, int frames);

// The pictures of a sequence: their numbers, names, times and views.

/// One picture of a sequence.
struct SequenceFrame {
  int number = 0;
  RenderOptions options;  ///< the options with the picture's own names and time
  double turn = 0.0;      ///< radians about the focal point
  double sweep = 0.0;     ///< the part of the turn for which the shutter is open, radians
};

/// The name with that word instead of its last run of #. The number takes its place if the word is empty or
/// unsuitable for the name of a file.
std::filesystem::path namedFile(const std::filesystem::path& pattern, const std::string& word, int number);

/// The numbers of the sequence's pictures; isSequence() must hold.
FrameRange rangeOf(const SequenceOptions& sequence);

/// The speed at which a video of the sequence shows its pictures: that of the animation.
double picturesPerSecond(const SequenceOptions& sequence);

/// Returns true if the pictures follow each other in one file, or on standard output.
bool isStream(const OutputOptions& output);

int frameCount(const SequenceOptions& sequence);

/// The picture of that index, from 0; the options are of a sequence. Small scenes do not become shader text
/// in it, so that one program draws all pictures.
SequenceFrame frameOf(const RenderOptions& options, int index);

/// Makes the session's scene and tracer those of the picture; a turntable has another scene in each picture
/// where it has lamps that stay, and the rest turns. Says once where the animation ends early. Throws as
/// Session::set().
Statistics prepareFrame(Session& session, Device& device, const SequenceFrame& frame,
                        const SequenceOptions& sequence);

/// Turns the camera of a turntable's scene, and its view and motion with it. The caller keeps the camera
/// that was not turned, for the next picture.
void turnView(LoadedScene& loaded, const RenderOptions& options, const SequenceFrame& frame,
              const SequenceOptions& sequence);

}  // namespace fragtrace
