// SPDX-License-Identifier: MIT
// A scene that stays on the device between its pictures. All of this belongs to the drawing thread
// (draw_thread.h).
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "python/draw_thread.h"
#include "session/picture/finished_picture.h"

namespace fragtrace {

/// A scene on the device.
struct KeptScene {
  Session session{std::numeric_limits<double>::infinity(), true};
  bool isKept = true;  ///< else one picture is drawn, and memory that only loading needs is freed before
};

/// A picture with all its layers, linear, and the statistics as JSON.
struct DrawnPicture {
  Image image;
  std::string statistics;
  bool complete = true;
};

/// Draws a picture of the scene by options without an output; loads and uploads what is missing. Throws what
/// `render` throws. Nothing if the job was interrupted.
std::optional<DrawnPicture> drawKept(const std::shared_ptr<KeptScene>& scene, const RenderOptions& options,
                                     DrawJob& job);

/// Frees a scene, in the drawing thread.
void releaseLater(std::shared_ptr<KeptScene> scene);

/// The names of all options that optionsOfWords() reads, without dashes.
std::vector<std::string> optionNames();

/// The options of a render by the words of its command line, without its output. Throws UsageError,
/// InputError.
RenderOptions optionsOfWords(std::vector<std::string> words);

}  // namespace fragtrace
