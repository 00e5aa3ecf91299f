// SPDX-License-Identifier: MIT
// Commands beyond the state: clipboard, undo, bookmarks, the screen; pictures as they come in.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/errors.h"
#include "base/text.h"
#include "image/image.h"
#include "options/command_text.h"
#include "options/option_row.h"
#include "options/view_options.h"
#include "scene/camera.h"
#include "view/files.h"
#include "view/shown_text.h"
#include "view/window/view_window.h"

namespace fragtrace {

namespace {

/// Stands before the user as long as Escape answers it.
constexpr const char* kQuitQuestion = "press Escape again to quit";

/// The screen that shows most of the window. On Wayland no program knows where its window is.
GLFWmonitor* monitorOf(GLFWwindow* window) {
  if (onWayland()) return glfwGetPrimaryMonitor();
  glm::ivec2 corner(0), size(0);
  glfwGetWindowPos(window, &corner.x, &corner.y);
  glfwGetWindowSize(window, &size.x, &size.y);
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  std::vector<glm::ivec4> screens;
  for (GLFWmonitor* monitor : std::span(monitors, size_t(count))) {
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    glm::ivec2 at(0);
    glfwGetMonitorPos(monitor, &at.x, &at.y);
    screens.emplace_back(at, mode ? glm::ivec2(mode->width, mode->height) : glm::ivec2(0));
  }
  return screens.empty() ? nullptr : monitors[screenOf(glm::ivec4(corner, size), screens)];
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): the table of what commands do
void Window::execute(const Invocation& invocation) {
  if (apply(state_, invocation) || (!state_.scene && needsScene(invocation.command))) return;
  // Files and picks are of the present view, which may have changed in this turn of the loop.
  request();
  switch (invocation.command) {
    case Command::CenterOn:
    case Command::FocusOn:
    case Command::Inspect:
    case Command::Measure:
    case Command::Level:
      return pick(invocation);
    case Command::SelectNode:
      return exchange_.request(&Requests::pick,
                               {.node = uint32_t(invocation.argument), .number = ++picksRequested_});
    case Command::Deselect:
      return deselect();
    case Command::KeepDefaults:
      try {
        keepDefaults(defaultsFile(), state_.options());
        return notify("kept as default in " + defaultsFile().string());
      } catch (const std::exception& error) {
        return notify(std::string("not kept: ") + error.what());
      }
    case Command::CopyCommand:
      return copyCommand();
    case Command::PasteCommand:
      return pasteCommand();
    case Command::Undo:
      if (!undo(history_, state_)) return notify("there is nothing to undo");
      return loadStep();
    case Command::Redo:
      if (!redo(history_, state_)) return notify("there is nothing to redo");
      return loadStep();
    case Command::ResetAll:
      if (const RenderOptions wanted = resetAll(state_, start_.options);
          !sameScene(wanted, state_.scene->options)) {
        load(wanted);
        history_.waits = true;
        history_.step = 0;
      }
      return;
    case Command::Load:
      return load(*invocation.load);
    case Command::CancelLoad:
      return cancelLoad();
    case Command::Reload:
      // A reference that could not be read may be mended by now.
      if (!state_.reference.empty()) exchange_.request(&Requests::reference, state_.reference);
      if (state_.scene || !wanted_.scene.empty()) load(state_.scene ? state_.scene->options : wanted_);
      return;
    case Command::AddBookmark:
    case Command::RemoveBookmark:
      return changeBookmarks(invocation);
    case Command::ShowBookmark:
      if (const std::vector<Bookmark>& views = facts_.remembered.bookmarks[sceneFile()];
          size_t(invocation.argument) < views.size())
        takeText(views[size_t(invocation.argument)].camera, "cannot go there: ");
      return;
    case Command::Open:
    case Command::SaveAs:
    case Command::SaveModel:
      return askForFile(invocation);
    case Command::NextModel:
      if (const auto next = modelBeside(wanted_.scene, start_.models, invocation.argument); !next.empty())
        return openFiles({next});
      return notify("there is no other model in this folder");
    case Command::OpenFile:
      return openFiles({invocation.file});
    case Command::DropReference:
      state_.reference.clear();
      return exchange_.request(&Requests::reference, {});
    case Command::Screenshot:
      return save(std::filesystem::absolute(freePictureName(state_.edit.shared.scene, ".png")));
    case Command::WriteExr:
      return save(std::filesystem::absolute(freePictureName(state_.edit.shared.scene, ".exr")));
    case Command::Fullscreen:
      return toggleFullscreen();
    case Command::Close:
      return close();
    case Command::Quit:
      discards_ = invocation.argument == 1;
      return glfwSetWindowShouldClose(window_.get(), GLFW_TRUE);
    default:
      return;
  }
}

/// Closes what is open, one at a time. Quits when it is asked twice with nothing open.
void Window::close() {
  if (!facts_.trace.error.empty() && !facts_.errorClosed) {
    facts_.errorClosed = true;
    return;
  }
  if (facts_.trace.load.busy) return cancelLoad();
  if (state_.scene && (facts_.pick || picksAnswered_ < picksRequested_)) return deselect();
  if (state_.fullscreen) return toggleFullscreen();
  // The press that has come here counts, too.
  if (input_.presses() != std::exchange(quitAskedAt_, input_.presses()) + 1 ||
      !isSeen(facts_.messages, kQuitQuestion, glfwGetTime()))
    return notify(kQuitQuestion);
  glfwSetWindowShouldClose(window_.get(), GLFW_TRUE);
}

void Window::deselect() {
  picksAnswered_ = picksRequested_;
  facts_.pick.reset();
  state_.selected = {};
  state_.selectedNode.reset();
  exchange_.request(&Requests::pick, {.clear = true});
}

/// Asks for what is under the cursor.
void Window::pick(const Invocation& invocation) {
  if (sideAt(state_, invocation.place) >= kMostSides) return;
  PickUse use = PickUse::Select;
  if (invocation.command == Command::CenterOn) use = PickUse::Center;
  if (invocation.command == Command::FocusOn) use = PickUse::Focus;
  // If there is no first point, this is the first one.
  if (invocation.command == Command::Measure && facts_.pick && facts_.pick->hit) use = PickUse::Measure;
  if (invocation.command == Command::Level) {
    if (!facts_.pick || !facts_.pick->end)
      return notify("click on a point and Shift+click on another one first");
    use = PickUse::Level;
  }
  if (use == PickUse::Select) ++picksRequested_;
  exchange_.request(&Requests::pick, {.side = sideAt(state_, invocation.place),
                                      .place = magnifiedPlace(state_, invocation.place),
                                      .use = use,
                                      .number = picksRequested_});
}

/// Turns the file, so that the plane through the point and the two that were measured between is level.
void Window::level(const PickAnswer& answer) {
  if (!answer.hit) return notify("nothing is there");
  if (!facts_.pick || !facts_.pick->end) return;
  RenderOptions options = renderOptionsOf(state_, state_.edit.active);
  const std::optional<glm::dvec3> up =
      levelUp({facts_.pick->point, *facts_.pick->end, answer.point}, options.selection.up);
  if (!up)
    return notify("the three points lie on a line: none of the planes through them is the one that is meant");
  // The camera goes with what it looks at, and stands upright.
  CameraPose pose = state_.edit.pose;
  pose.focalPoint = turnToY(*up) * (pose.focalPoint * turnToY(options.selection.up));
  pose.position += pose.focalPoint - state_.edit.pose.focalPoint;
  constexpr double kSteep = 0.999;  // cosine between the view and the vertical: what is up then stays so
  const glm::dvec3 view = glm::normalize(pose.focalPoint - pose.position);
  if (std::abs(view.y) < kSteep) pose.viewUp = {0.0, 1.0, 0.0};
  options.camera.index.reset();
  options.camera.overrides = overridesOf(pose);
  options.selection.up = *up;
  load(options);
  pasted_ = options;
  notify("the model is turned as --up " + rowOf("--up").words(options).front() + " turns it");
}

/// Loads a scene for pictures of the size that is shown.
void Window::load(RenderOptions options) {
  options.camera.resolution = state_.size;
  wanted_ = options;
  pasted_.reset();
  facts_.trace.error.clear();
  exchange_.set(&TraceStatus::error, {});
  exchange_.request(&Requests::load, {options});
}

/// Loads the light or the variant of an undone step, if another one is shown.
void Window::loadStep() {
  if (withLight(history_, wanted_) == wanted_) return;
  load(withLight(history_, state_.scene->options));
  history_.waits = true;
}

void Window::cancelLoad() {
  exchange_.request(&Requests::load, {});
  exchange_.set(&TraceStatus::load, {});
  facts_.trace.load = {};
  endLoad();
}

/// The options of the active side, with everything that its picture on the screen depends on.
RenderOptions Window::shownOptions() const {
  RenderOptions o = renderOptionsOf(state_, state_.edit.active);
  o.camera.resolution = state_.size;
  o.camera.sceneOrigin = state_.scene->description.origin;
  o.sampling.spp = std::max(facts_.statistics[state_.shownSide()].samples, 1);
  return o;
}

/// Returns true if no number would be lost that nobody has saved.
bool Window::isSaved() const {
  const std::vector<SetNumber>& set = state_.edit.shared.selection.set;
  return set.empty() || set == saved_ || set == start_.options.selection.set;
}

/// Returns true if another scene may be opened: nothing is lost, or the user was asked, and sees it still.
bool Window::mayOpen() {
  constexpr const char* kQuestion =
      "the numbers that were set are not saved (Ctrl+Shift+S); open again to leave them";
  if (isSaved() || isSeen(facts_.messages, kQuestion, glfwGetTime())) return true;
  notify(kQuestion);
  return false;
}

/// Returns true if the window is to be closed.
bool Window::closes() {
  if (glfwWindowShouldClose(window_.get()) == 0) return false;
  if (isSaved() || discards_) return true;
  glfwSetWindowShouldClose(window_.get(), GLFW_FALSE);
  facts_.asksToSave = true;
  frames_ = kFramesAfterEvent;
  return false;
}

void Window::toggleFullscreen() {
  GLFWwindow* window = window_.get();
  if (state_.fullscreen) {
    glfwSetWindowMonitor(window, nullptr, windowed_.x, windowed_.y, windowed_.z, windowed_.w, GLFW_DONT_CARE);
  } else {
    GLFWmonitor* monitor = monitorOf(window);
    const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
    if (!mode) return notify("there is no screen to fill");
    if (!onWayland()) glfwGetWindowPos(window, &windowed_.x, &windowed_.y);
    glfwGetWindowSize(window, &windowed_.z, &windowed_.w);
    glfwSetWindowMonitor(window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
  }
  state_.fullscreen = !state_.fullscreen;
}

std::string Window::sceneFile() const {
  return std::filesystem::absolute(state_.scene->options.scene).string();
}

void Window::changeBookmarks(const Invocation& invocation) {
  remember([&](Remembered& remembered) {
    std::vector<Bookmark>& views = remembered.bookmarks[sceneFile()];
    if (invocation.command == Command::AddBookmark)
      views.push_back({invocation.text, cameraText(shownOptions())});
    else if (size_t(invocation.argument) < views.size())
      views.erase(views.begin() + invocation.argument);
  });
}

void Window::copyCommand() {
  RenderOptions o = shownOptions();
  nameLight(o, *state_.scene);
  const bool layers =
      !o.output.aovs.empty() || !o.output.lightGroups.empty() || o.output.aovSamples || o.output.aovVariance;
  o.output.file = freePictureName(o.scene, layers ? ".exr" : ".png");
  glfwSetClipboardString(window_.get(), commandText(o).c_str());
  notify("copied the command that renders this picture");
}

void Window::pasteCommand() {
  const char* text = glfwGetClipboardString(window_.get());
  // A clipboard without text is no failure of the window.
  if (!text) takeGlfwErrors();
  if (takeText(text ? text : "", "cannot paste: ")) notify("pasted");
}

/// Takes a command or options of a camera. False if that fails, after a message.
bool Window::takeText(const std::string& text, const std::string& otherwise) {
  try {
    const RenderOptions options = withCommandText(renderOptionsOf(state_, state_.edit.active), text);
    if (options.scene.empty()) throw UsageError("it names no scene");
    if (sameScene(options, state_.scene->options)) {
      takeOptions(state_, options);
    } else {
      load(options);
      pasted_ = options;
    }
    return true;
  } catch (const std::exception& error) {
    notify(otherwise + error.what());
    return false;
  }
}

void Window::takePictures(std::vector<TracedPicture> pictures) {
  const double now = glfwGetTime();
  for (TracedPicture& picture : pictures) {
    const size_t side = picture.side;
    if (!picture.file.empty()) {
      takeReference(picture);
    } else if (side == 1 && !state_.reference.empty()) {
      // This picture was on its way when the reference took its place.
      if (picture.shared.slot >= 0) exchange_.release(side, picture.shared, nullptr);
      continue;
    }
    display_.take(picture);
    ++report_.pictures;
    if (side == 0) arrivals_.push_back(now);
    facts_.statistics[side] = picture.statistics;
    facts_.pictureSize[side] = picture.size;
    facts_.lines[side] = std::move(picture.lines);
    report_.answered = std::max(report_.answered, picture.request);
    while (!unanswered_.empty() && unanswered_.front().first <= picture.request) {
      keepTime(report_.answerMs, 1000.0 * (now - unanswered_.front().second));
      unanswered_.pop_front();
    }
    frames_ = std::max(frames_, 1);
  }
  while (!arrivals_.empty() && arrivals_.front() < now - 1.0) arrivals_.pop_front();
  const bool moves = requested_.moving && arrivals_.size() > 1;
  facts_.picturesPerSecond =
      moves ? double(arrivals_.size() - 1) / (arrivals_.back() - arrivals_.front()) : 0.0;
  compareSizes();
}

void Window::take(const EnvironmentThumbnail& thumbnail) {
  const Image& image = thumbnail.image;
  if (image.values.empty()) return;
  GlTexture texture = makeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, GL_RGBA8, image.width, image.height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(texture.name(), 0, 0, 0, image.width, image.height, GL_RGB, GL_FLOAT,
                      image.values.data());
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  checkGl("uploading a thumbnail");
  facts_.thumbnails[thumbnail.file] = std::move(texture);
  frames_ = std::max(frames_, 1);
}

/// Asks once for each environment of the list.
void Window::requestThumbnails() {
  if (!std::exchange(facts_.wantsThumbnails, false) || !state_.scene) return;
  std::vector<std::filesystem::path> wanted = state_.scene->environments;
  wanted.emplace_back();
  if (!state_.scene->options.light.hdriFile.empty()) wanted.push_back(state_.scene->options.light.hdriFile);
  std::erase_if(wanted, [&](const auto& file) { return !requestedThumbnails_.insert(file).second; });
  if (!wanted.empty()) exchange_.request(&Requests::thumbnails, std::move(wanted));
}

/// Makes the picture side B.
void Window::takeReference(const TracedPicture& picture) {
  record(history_, state_);
  state_.reference = picture.file;
  split(state_.edit);
  state_.overview = false;
  state_.edit.active = 0;
  newReference_ = true;
  ignoreChange(history_, state_);
}

/// Escape may have taken the request back. Messages say for a while that nothing is there.
void Window::take(PickAnswer answer) {
  frames_ = kFramesAfterEvent;
  const bool awaited = answer.request.number > picksAnswered_;
  picksAnswered_ = std::max(picksAnswered_, answer.request.number);
  if (answer.request.use == PickUse::Level) return level(answer);
  if (answer.request.use == PickUse::Center) {
    if (!answer.hit) return;
    state_.edit.pose = centerOn(state_.edit.pose, answer.point);
    state_.edit.posed = true;
    return;
  }
  if (answer.request.use == PickUse::Focus) {
    const CameraPose& pose = state_.edit.pose;
    LensOptions& lens = state_.edit.shared.camera.lens;
    if (!answer.hit) return notify("nothing is there");
    if (pose.type != CameraType::Perspective) return notify("only a perspective camera is focused");
    lens.focusDistance =
        glm::dot(answer.point - pose.position, glm::normalize(pose.focalPoint - pose.position));
    if (!lens.fStop) lens.fStop = firstStop(pose);
    return notify(formatted("sharp at %.4g m, f / %.3g", *lens.focusDistance, *lens.fStop));
  }
  if (answer.request.use == PickUse::Measure) {
    if (!answer.hit) return notify("nothing is there");
    if (facts_.pick) facts_.pick->end = answer.point;
    return;
  }
  if (!awaited) return;
  state_.selected = answer.bounds;
  state_.selectedNode = answer.node;
  facts_.pick.reset();
  if (answer.node) {
    facts_.pick = std::move(answer);
  } else {
    for (const std::string& line : answer.lines) notify(line);
  }
}

/// Says that sizes differ, once the picture of the scene has its size.
void Window::compareSizes() {
  const glm::ivec2 size = facts_.pictureSize[1];
  if (!newReference_ || state_.reference.empty() || facts_.pictureSize[0] != state_.size) return;
  newReference_ = false;
  if (size == state_.size) return;
  const auto text = [](glm::ivec2 s) { return std::to_string(s.x) + " x " + std::to_string(s.y); };
  notify(state_.reference.filename().string() + " has " + text(size) + " pixels, the picture " +
         text(state_.size) + ": it is scaled to compare");
}

// Files that the window opens and writes.

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
  for (const std::string& sentence : drop.refused) notify(sentence);
  if (!drop.load) return;
  const bool hasScene =
      std::ranges::any_of(toLoad, [](const auto& file) { return kindOfDropped(file) == DroppedFile::Scene; });
  if (hasScene && !isAsked && !mayOpen()) return;
  if (hasScene || state_.scene || facts_.trace.load.busy) return load(*drop.load);
  wanted_ = *drop.load;
  notify(wanted_.light.hdriFile.filename().string() + " will light the model that is dropped next");
}

void Window::save(const std::filesystem::path& name) {
  const RenderOptions& o = state_.edit.shared;
  // A file for a display holds the picture as shown; a file of radiance holds the active side's samples.
  const bool seen = isDisplayFormat(name);
  const bool all = (state_.compares() || state_.overview) && seen;
  const char* side = !state_.compares() || all ? "" : state_.edit.active == 0 ? " of side A" : " of side B";
  if (!facts_.trace.resting)
    notify("writing " + name.string() + side + " as soon as all of the picture is drawn");
  exchange_.request([&](Requests& r) {
    r.saves.push_back({name,
                       state_.shownSide(),
                       all,
                       {state_.shownBar(), state_.showsDifference(), state_.differenceStops,
                        o.output.exposure.value_or(0.0), o.output.toneMap}});
  });
}

/// To open, next to the scene that is shown; to save a picture, where one was saved last; to save the model,
/// next to it.
void Window::askForFile(const Invocation& invocation) {
  const RenderOptions& o = state_.edit.shared;
  std::error_code error;
  const std::filesystem::path here = std::filesystem::current_path(error);
  FileQuestion question;
  if (invocation.command == Command::SaveModel) {
    quitsWhenSaved_ = invocation.argument == 1;
    if (o.selection.set.empty()) return notify("no number of a material or a light has been set");
    const std::filesystem::path scene = here / o.scene;
    question =
        saveModelQuestion(freePictureName(scene.parent_path(), scene, scene.extension().string().c_str()),
                          state_.scene->refersToFiles);
  } else if (invocation.command == Command::SaveAs) {
    const std::filesystem::path folder = savedFolder_.empty() ? here : savedFolder_;
    question = saveQuestion(freePictureName(folder, o.scene, ".png"));
  } else {
    const bool environment = invocation.argument == 1;
    if (!environment && !dialog_.open() && !mayOpen()) return;
    const std::filesystem::path& beside =
        environment && !o.light.hdriFile.empty() ? o.light.hdriFile : wanted_.scene;
    question = openQuestion((here / beside).parent_path(), environment);
    if (beside.empty()) question.folder = here;
  }
  dialogFor_ = invocation.command;
  dialog_.ask(std::move(question), portalName(window_.get()), glfwGetTime());
}

void Window::takeFile() {
  const FileDialog::Answer answer = dialog_.take(glfwGetTime());
  facts_.dialog = dialog_.open();
  if (!answer.message.empty()) notify(answer.message);
  if (answer.file.empty()) return;
  frames_ = std::max(frames_, kFramesAfterEvent);
  if (dialogFor_ == Command::Open) return openFiles({answer.file}, true);
  if (!state_.scene) return;
  std::filesystem::path file = answer.file;
  const FileFilter& filter = dialog_.question().filters.front();
  if (file.extension().empty()) file += filter.extensions.front();
  if (!passes(filter, file))
    return notify("not written: " + file.extension().string() + " is not among " + filter.name);
  request();
  if (dialogFor_ == Command::SaveModel) {
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
    notify(std::string("not remembered: ") + error.what());
  }
}

}  // namespace fragtrace
