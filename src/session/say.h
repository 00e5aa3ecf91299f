// SPDX-License-Identifier: MIT
// Words beside results: warnings, choices.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "shader/render_options.h"

namespace fragtrace {

/// Says a line on stderr unless quiet. From any thread.
void say(const RenderOptions& options, const std::string& text);

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
