// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "session/picture/draw_samples.h"

namespace fragtrace {

// The one thread of a Python process that draws. The OpenGL context belongs to a thread, its table of
// functions to the process, and a draw uses all processors, so scenes of all Python threads take turns here.

/// Work for the drawing thread, and its progress. The waiting thread and the drawing thread share it.
struct DrawJob {
  std::function<void(DrawJob&)> work;
  std::atomic<int> interrupts = 0;   ///< interrupts() of the work
  std::atomic<double> fraction = 0;  ///< share of the samples
  std::vector<std::string> said;     ///< lines of say(); read them when the job has ended
  std::exception_ptr error;          ///< likewise

  void end();
  /// Returns true if it has ended within that time.
  bool wait(int milliseconds);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false;
};

/// Puts work into the queue. Throws std::runtime_error in a process that was forked from one that has drawn.
std::shared_ptr<DrawJob> postJob(std::function<void(DrawJob&)> work);

/// Interrupts all work and waits for its end; later work is dropped. It must be called before Python ends.
void stopDrawing();
bool isDrawingStopped();

// A scene that stays on the device between its pictures. All of this belongs to the drawing thread
// (kept_scene.h).

/// A scene on the device.
struct KeptScene {
  Session session{std::numeric_limits<double>::infinity(), true};
  bool isKept = true;  ///< else one picture is drawn, and memory that only loading needs is freed before
  std::optional<RenderOptions> placed{};  ///< those of a sequence, with the camera of all its pictures
};

/// A picture with all its layers, linear, and the statistics as JSON.
struct DrawnPicture {
  Image image;
  std::string statistics;
  bool complete = true;
  Renewal renewal = Renewal::None;  ///< the earliest step that was done again
};

/// Draws a picture of the scene by options without an output; loads and uploads what is missing. Where they
/// are of a sequence, that of the index, from 0; a scene that draws a sequence draws nothing else. Throws
/// what `render` throws. Nothing if the job was interrupted.
std::optional<DrawnPicture> drawKept(const std::shared_ptr<KeptScene>& scene, const RenderOptions& options,
                                     int index, DrawJob& job);

/// Frees a scene, in the drawing thread.
void releaseLater(std::shared_ptr<KeptScene> scene);

/// The names of all options that optionsOfWords() reads, without dashes.
std::vector<std::string> optionNames();

/// The option (with dashes) that another word for it, or a misspelled one, stands for; empty if there is
/// none.
std::string optionLike(const std::string& unknown);

/// The options of a render by the words of its command line, without its output. Throws UsageError,
/// InputError.
RenderOptions optionsOfWords(std::vector<std::string> words);

}  // namespace fragtrace
