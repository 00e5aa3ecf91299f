// SPDX-License-Identifier: MIT
#include "session/say.h"

#include <mutex>
#include <set>
#include <utility>

#include "base/report.h"

namespace fragtrace {

namespace {

struct Listening {
  std::mutex mutex;
  std::function<void(const std::string&)> listener;
  std::set<std::string> said;
};

Listening& listening() {
  static Listening state;
  return state;
}

thread_local std::vector<std::string>* saidHere = nullptr;

}  // namespace

void say(const RenderOptions& options, const std::string& text) {
  if (saidHere != nullptr) {
    saidHere->push_back(text);
    return;
  }
  Listening& state = listening();
  const std::lock_guard lock(state.mutex);
  const bool fresh = !state.listener || state.said.insert(text).second;
  if (!options.output.quiet && fresh) reportMessage(text);
  if (state.listener) state.listener(text);
}

void sayNotes(const RenderOptions& options, const std::filesystem::path& path, const Image& image) {
  for (const std::string& note : image.notes) say(options, path.string() + ": " + note);
}

void passOnWhatIsSaid(std::function<void(const std::string&)> listener) {
  Listening& state = listening();
  const std::lock_guard lock(state.mutex);
  state.listener = std::move(listener);
}

SaidHere::SaidHere(std::vector<std::string>& lines) { saidHere = &lines; }

SaidHere::~SaidHere() { saidHere = nullptr; }

}  // namespace fragtrace
