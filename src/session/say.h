// SPDX-License-Identifier: MIT
// Words beside results: warnings, choices.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "image/image.h"
#include "shader/render_options.h"

namespace fragtrace {

/// Says a line on stderr unless quiet. From any thread.
void say(const RenderOptions& options, const std::string& text);

/// Says how reading changed the values of a picture, a line for each change.
void sayNotes(const RenderOptions& options, const std::filesystem::path& path, const Image& image);

/// From now on every line also goes to the listener, quiet or not. stderr gets each line only once, since a
/// viewer repeats its work and its messages. The listener is called from any thread.
void passOnWhatIsSaid(std::function<void(const std::string&)> listener);

/// While an object of this class exists, say() of the thread that made it appends to `lines`, and the text
/// goes nowhere else. A thread has at most one.
class SaidHere {
 public:
  explicit SaidHere(std::vector<std::string>& lines);
  ~SaidHere();
  SaidHere(const SaidHere&) = delete;
  SaidHere& operator=(const SaidHere&) = delete;
};

}  // namespace fragtrace
