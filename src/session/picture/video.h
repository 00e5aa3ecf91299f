// SPDX-License-Identifier: MIT
// A video that ffmpeg encodes in a process of its own, frame by frame.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>

#include "image/files/video_format.h"

namespace fragtrace {

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
/// also where the interrupted user waits no longer; the video is dropped then.
void addFrame(Video& video, const Image& display);

/// Ends the encoder and puts the video in its place. Throws as addFrame() does.
void finishVideo(Video& video);

}  // namespace fragtrace
