// SPDX-License-Identifier: MIT
// Files that the window opens and writes: dropped, chosen in a dialog, shown before.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

#include "image/image.h"
#include "view/dropped_file.h"
#include "view/shown_names.h"
#include "view/window/view_window.h"

namespace fragtrace {

void Window::takeDrops() {
  const std::vector<std::filesystem::path> files = input_.takeDrops();
  if (!files.empty()) openFiles(files);
}

void Window::openFiles(const std::vector<std::filesystem::path>& files, bool isAsked) {
  std::vector<std::filesystem::path> toLoad;
  for (const std::filesystem::path& file : files) {
    if (state_.edit.split && mayBeReference(file))
      exchange_.request(&Requests::reference, file);
    else
      toLoad.push_back(file);
  }
  if (toLoad.empty()) return;
  const Drop drop = takeDrop(wanted_, toLoad, start_.options.selection.up);
  for (const std::string& sentence : drop.refused) say(sentence);
  if (!drop.load) return;
  const bool hasScene =
      std::ranges::any_of(toLoad, [](const auto& file) { return kindOfDropped(file) == DroppedFile::Scene; });
  if (hasScene && !isAsked && !mayDiscard("open")) return;
  if (hasScene || state_.scene || facts_.load.busy) return load(*drop.load);
  wanted_ = *drop.load;
  say(wanted_.light.hdriFile.filename().string() + " will light the model that is dropped next");
}

void Window::save(const std::filesystem::path& name) {
  const RenderOptions& o = state_.edit.shared;
  // A file for a display holds the picture as shown; a file of radiance holds the active side's samples.
  const bool seen = isDisplayFormat(name);
  const bool both = state_.compares() && seen;
  const char* side = !state_.compares() || both ? "" : state_.edit.active == 0 ? " of side A" : " of side B";
  if (!facts_.resting) say("writing " + name.string() + side + " as soon as all of the picture is drawn");
  SaveRequest request;
  request.path = name;
  request.side = state_.shownSide();
  if (both) request.both = state_.comparison;
  request.bar = state_.shownBar();
  request.differenceStops = state_.differenceStops;
  request.exposure = o.output.exposure.value_or(0.0);
  request.toneMap = o.output.toneMap;
  exchange_.request([&](Requests& r) { r.saves.push_back(std::move(request)); });
}

/// To open, beside the scene that is shown; to save a picture, where one was saved last; to save the model,
/// beside it.
void Window::askForFile(const Invocation& invocation) {
  const RenderOptions& o = state_.edit.shared;
  std::error_code error;
  const std::filesystem::path here = std::filesystem::current_path(error);
  FileQuestion question;
  if (invocation.command == Command::SaveModel) {
    if (o.selection.set.empty()) return say("no number of a material or a light has been set");
    const std::filesystem::path scene = here / o.scene;
    question =
        saveModelQuestion(freePictureName(scene.parent_path(), scene, scene.extension().string().c_str()),
                          state_.scene->refersToFiles);
  } else if (invocation.command == Command::SaveAs) {
    const std::filesystem::path folder = savedFolder_.empty() ? here : savedFolder_;
    question = saveQuestion(freePictureName(folder, o.scene, ".png"));
  } else {
    const bool environment = invocation.argument == 1;
    if (!environment && !dialog_.open() && !mayDiscard("open")) return;
    const std::filesystem::path& beside =
        environment && !o.light.hdriFile.empty() ? o.light.hdriFile : wanted_.scene;
    question = openQuestion((here / beside).parent_path(), environment);
    if (beside.empty()) question.folder = here;
  }
  asked_ = invocation.command;
  dialog_.ask(std::move(question), portalName(window_.get()), glfwGetTime());
}

void Window::takeFile() {
  const FileDialog::News news = dialog_.take(glfwGetTime());
  facts_.dialog = dialog_.open();
  if (!news.message.empty()) say(news.message);
  if (news.file.empty()) return;
  frames_ = std::max(frames_, kSettleFrames);
  if (asked_ == Command::Open) return openFiles({news.file}, true);
  if (!state_.scene) return;
  std::filesystem::path file = news.file;
  const FileFilter& filter = dialog_.question().filters.front();
  if (file.extension().empty()) file += filter.extensions.front();
  if (!passes(filter, file))
    return say("not written: " + file.extension().string() + " is not among " + filter.name);
  ask();
  if (asked_ == Command::SaveModel) {
    std::error_code none;
    savesShown_ = std::filesystem::equivalent(file, state_.scene->options.scene, none);
    return exchange_.request(&Requests::model, file);
  }
  savedFolder_ = file.parent_path();
  save(file);
}

/// Reads what other viewers have remembered meanwhile, too.
void Window::remember(const std::function<void(Remembered&)>& change) {
  try {
    const std::filesystem::path file = rememberedFile();
    facts_.remembered = readRemembered(file);
    change(facts_.remembered);
    writeRemembered(file, facts_.remembered);
  } catch (const std::exception& error) {
    say(std::string("not remembered: ") + error.what());
  }
}

}  // namespace fragtrace
