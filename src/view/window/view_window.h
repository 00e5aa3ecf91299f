// SPDX-License-Identifier: MIT
// The window's thread: events in, requests to the tracing thread, its pictures onto the screen. It draws only
// when something has changed, and sleeps otherwise.
#pragma once

#include <map>
#include <set>

#include "gl/gl.h"
#include "view/exchange.h"
#include "view/view_state.h"
#include "view/window/display.h"
#include "view/window/file_dialog.h"
#include "view/window/glfw_window.h"
#include "view/window/input.h"
#include "view/window/overlay.h"

namespace fragtrace {

inline constexpr int kFramesAfterEvent = 3;  ///< Dear ImGui comes to rest this many frames after an event

class Window {
 public:
  Window(const WindowStart& start, Exchange& exchange);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window() { exchange_.setWake({}); }
  /// Runs until the window is closed. Throws what the tracing thread failed with, and InputError when the
  /// scene that was asked for could never be shown.
  void run();
  /// The contexts for the tracing thread.
  SharedContexts shared() const;
  /// The last of the status file: why the window is closed; empty: it was wanted.
  void end(const std::string& failure);

 private:
  // window_loop.cpp
  void open();
  void wait();
  /// Takes what the tracing thread and a dialog have given; false: nothing that is new.
  bool take();
  void take(ViewedScene scene);
  void take(const PosedScene& posed);
  void take(PickAnswer answer);
  void take(const EnvironmentThumbnail& thumbnail);
  void take(SavedModel saved);
  void take(const std::string& message);
  std::vector<ChangedNumber> numbersSavedIn(const ViewedScene& scene) const;
  void takeStatus(const TraceStatus& status);
  void endLoad();
  void forgetBrokenEnvironment();
  void request();
  void readValues();
  void draw();
  void writeStatus();
  void notify(const std::string& message);
  bool iconified() const;

  // window_tasks.cpp
  void takePictures(std::vector<TracedPicture> pictures);
  void takeReference(const TracedPicture& picture);
  void pick(const Invocation& invocation);
  void level(const PickAnswer& answer);
  void compareSizes();
  void requestThumbnails();
  void execute(const Invocation& invocation);
  void close();
  void deselect();
  std::string sceneFile() const;
  void changeBookmarks(const Invocation& invocation);
  void load(RenderOptions options);
  void loadStep();
  void cancelLoad();
  bool isSaved() const;
  bool mayOpen();
  bool closes();
  void copyCommand();
  void pasteCommand();
  void toggleFullscreen();
  bool takeText(const std::string& text, const std::string& otherwise);
  RenderOptions shownOptions() const;
  void openFiles(const std::vector<std::filesystem::path>& files, bool isAsked = false);
  void save(const std::filesystem::path& file);
  void askForFile(const Invocation& invocation);
  void takeFile();
  void remember(const std::function<void(Remembered&)>& change);

  const WindowStart& start_;
  Exchange& exchange_;
  Glfw glfw_;
  WindowHandle window_;
  WindowHandle sharing_;    ///< none: the tracing thread draws elsewhere
  WindowHandle compiling_;  ///< next to it
  DebugLog driverLog_;
  Input input_;
  Interface interface_;
  Display display_;
  FileDialog dialog_;
  Command dialogFor_ = Command::Open;  ///< why it asks: Open, SaveAs, SaveModel
  std::filesystem::path savedFolder_;  ///< folder of the latest picture written; empty: none was
  std::vector<SetNumber> saved_;       ///< numbers that the latest model was written with
  std::set<std::filesystem::path> requestedThumbnails_;
  ViewState state_;
  ViewFacts facts_;
  History history_;
  WindowReport report_;
  RenderOptions wanted_;                 ///< options of the scene that is shown or being loaded
  std::optional<RenderOptions> pasted_;  ///< they apply once their scene is loaded
  glm::ivec4 windowed_{0};               ///< place and size before the window filled the screen
  std::string status_;
  double statusTime_ = -1.0;
  bool statusWaits_ = false;
  bool newReference_ = false;  ///< its size is not yet compared with the picture's
  bool prepared_ = false;      ///< the display
  /// The latest frame was not drawn, since it would have shown the previous picture again.
  bool skipped_ = false;
  int frames_ = 0;               ///< still to be drawn
  double drawn_ = -1e30;         ///< time of the latest frame that was drawn
  double changed_ = -1.0;        ///< time of the latest change of the traced picture
  double again_ = 1e30;          ///< time to look again for a picture or its values
  double fades_ = 1e30;          ///< time to draw a message paler
  TraceRequest requested_;       ///< the latest; without sides, the next turn asks again
  bool discards_ = false;        ///< the window closes although numbers are not saved
  bool quitsWhenSaved_ = false;  ///< the model that is being written is what the window waits for
  bool savesShown_ = false;      ///< a model is written over the file that is shown
  uint64_t picksRequested_ = 0;
  uint64_t picksAnswered_ = 0;   ///< picks that are answered or taken back
  int quitAskedAt_ = -2;         ///< Input::presses() when Escape last asked
  std::deque<double> arrivals_;  ///< times of the first side's pictures in the last second
  std::deque<std::pair<uint64_t, double>> unanswered_;  ///< requests, and when they were made
};

}  // namespace fragtrace
