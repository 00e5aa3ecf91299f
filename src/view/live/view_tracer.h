// SPDX-License-Identifier: MIT
// The viewer's tracing thread: a context and renderers of its own, requests in, finished pictures out; and
// the files that it reads: scenes and thumbnails, in the background, and the picture to compare with.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <deque>
#include <exception>
#include <filesystem>
#include <limits>
#include <memory>
#include <vector>

#include "base/errors.h"
#include "bvh/outlines.h"
#include "gl/gl.h"
#include "image/image.h"
#include "options/option_row.h"
#include "options/view_options.h"
#include "session/picture/denoising.h"
#include "session/session.h"
#include "session/setup.h"
#include "view/background.h"
#include "view/exchange.h"
#include "view/files.h"
#include "view/live/view_picture.h"
#include "view/resolution_controller.h"

namespace fragtrace {

/// A load that has ended: the scene, or why there is none.
struct LoadResult {
  ViewedScene viewed;  ///< with the options of the load; only these without a scene
  std::unique_ptr<LoadedScene> scene;
  std::shared_ptr<KeptDocument> document;  ///< the document for poses, if it is animated
  std::exception_ptr error;
};

/// A picture that the viewer compares with: linear R, G, B, and A where it has that. Throws InputError for
/// what has no colour or is too large.
LinearImage readReference(const std::filesystem::path& path, uint64_t memoryLimit);

/// Nodes of the scene that is shown; none: nothing is selected.
struct Selected {
  NodeSet nodes;
  BoundsDouble bounds;  ///< world space; empty: they draw nothing
  std::vector<PictureLine> outline{};
  std::optional<std::pair<Projection, glm::ivec2>> outlined{};  ///< the view and size that it was made for
};

class ViewTracer {
 public:
  /// The scene of the options is loaded first; when that fails, or there is no context, so does the program.
  /// `oidn` is open where the options ask for it.
  ViewTracer(const ViewOptions& start, std::optional<OidnLibrary> oidn, Exchange& exchange);
  ViewTracer(const ViewTracer&) = delete;
  ViewTracer& operator=(const ViewTracer&) = delete;
  ~ViewTracer() { passOnWhatIsSaid({}); }

  /// Draws until the exchange says quit. It is called in the thread that draws. In a context that shares its
  /// objects with the window's, if that can be had and is no worse than one of its own: pictures then stay on
  /// the device.
  void run(const SharedContexts& shared);

  /// Returns true if a file is being written.
  bool saving() const { return saving_; }
  /// Returns true if a thread still loads something, even if nobody waits for it any more.
  bool loading() const {
    return loading_.working() || std::ranges::any_of(thumbnails_, &Background<bool>::working);
  }

 private:
  struct Side {
    RenderOptions options;
    std::shared_ptr<SceneProgram> program;
    std::optional<RenderOptions> awaited;  ///< options to draw once their program is compiled
    bool previews = false;                 ///< draws in Blinn-Phong until then
    bool guessesLightPaths = false;        ///< the film's View::pixelsPerPath was not measured
    bool byCones = false;                  ///< the film's samples read textures by ray cones
    std::unique_ptr<Film> film;
    View view;
    int samples = 0;
    RenderTimes times;
    double megaRaysPerSecond = 0.0;
    double counted = 0.0;    ///< when its rays were; this and the next by steadyMilliseconds()
    double published = 0.0;  ///< its latest picture
    double error = -1.0;
    int errorAt = 0;    ///< samples when it was estimated
    bool stale = true;  ///< the film holds another picture
    SideMemory memory;
    int shownAt = 0;          ///< samples when it was published last
    int shownIn = -1;         ///< slot of that picture; negative: it is not there any more
    double filterMs = 0.0;    ///< time of the filter
    uint64_t movedBytes = 0;  ///< the thread's count at the side's picture before

    bool drawsCones() const { return byCones && program->hasCones; }
    bool denoises() const { return whyNotDenoised(options).empty(); }
  };

  void enterContext(const SharedContexts& shared);
  void leaveContext();
  void recover(ContextLost error);
  void carryOut(Requests requests);
  void load(const RenderOptions& options);
  void takeLoaded();
  void watchFiles();
  void rebuildPrograms();
  void setRequest(const TraceRequest& request);
  /// Renews what the request needs otherwise of the scene: its sky, its pose, numbers of surfaces and lights.
  /// Tells the window why if it cannot.
  void renew(const TraceRequest& request);
  /// The options with a filter that is available. Tells the window why if it is not the one asked for.
  RenderOptions withFilter(RenderOptions options);
  void setSide(Side& side, const RenderOptions& options);
  void preview(Side& side, const RenderOptions& wanted);
  View viewOf(const RenderOptions& options);
  /// Null while the program is compiled next to other drawing.
  std::shared_ptr<SceneProgram> programFor(const RenderOptions& options, bool aside);
  /// Sides draw what was compiled aside.
  void takeCompiled();
  /// Returns true if a side draws something else meanwhile.
  bool awaitsProgram() const;
  void makePrograms();
  /// The sides draw what the latest request asks for, unless one still awaits its program.
  void noteAnswered();
  /// A film of the size that is drawn at now; empty, if it was of another.
  void fitFilm(Side& side);
  bool resting(const Side& side) const;
  /// Returns true if nothing moves and the resolution is the full one.
  bool isStill() const;
  /// Draws samples of the side that has the fewest, or a frame of each while something moves; false when all
  /// rest.
  bool work();
  /// Adds samples to the side's film; false when there is something else to do.
  bool draw(Side& side);
  /// Returns true if the side's picture has changed enough, while nothing moves.
  bool worthShowing(const Side& side) const;
  void estimate(Side& side);
  void count(Side& side);
  /// Returns true if Open Image Denoise filters now. It takes seconds, so it runs when the samples have
  /// doubled.
  bool denoisesByOidn(const Side& side) const;
  /// Makes what the side shows now; false when goOn() said no.
  bool show(Side& side, bool past, const std::function<bool()>& goOn);
  /// The slot of the side's next picture.
  int nextSlot(Side& side);
  ShownTexture& shownOf(const Side& side, int slot);
  /// Returns the picture for the window, or none if there is something else to do first.
  std::optional<TracedPicture> pictureOf(Side& side);
  void publish(Side& side);
  Image seenOf(Side& side);
  void save(const SaveRequest& request);
  void saveAll(const SaveRequest& request);
  void saveModel(const std::filesystem::path& path);
  void takeReference(const std::filesystem::path& path);
  void answer(const PickRequest& request);
  void select(Selected selected);
  /// Boxes of the tree, and the outline of what is selected.
  std::vector<PictureLine> linesOver(const Side& side);
  /// Tells the window what keeps the thread from drawing.
  void reportWork(const std::string& what);

  ViewOptions start_;
  Exchange& exchange_;
  Background<LoadResult> loading_;
  std::deque<Background<bool>> thumbnails_;  ///< one for each request; true when they are made
  std::unique_ptr<Context> context_;
  std::unique_ptr<DebugLog> driverLog_;
  Session session_{std::numeric_limits<double>::infinity()};
  CameraOptions loadedCamera_;       ///< that of the options that the scene was loaded with
  std::optional<OidnLibrary> oidn_;  ///< opened later where a pasted command asks for it
  PassClock clock_;
  std::unique_ptr<PictureMaker> maker_;
  TraceRequest request_;
  uint64_t answered_ = 0;  ///< the latest request that the sides draw
  Selected selected_;      ///< the latest pick
  std::vector<Side> sides_;
  enum class Shows : uint8_t { Nothing, Preview, Picture };
  std::atomic<Shows> shows_ = Shows::Nothing;
  bool shares_ = false;                     ///< objects with the window
  std::optional<OutsideContext> compiles_;  ///< none: programs are compiled where they draw
  std::array<std::array<ShownTexture, kSlots>, kMostSides>
      shown_;  ///< of the sides; without sharing the first
  ResolutionController resolution_;
  std::atomic<bool> saving_ = false;
  std::string loadError_;  ///< why the latest load failed; empty: it did not
  std::vector<SaveRequest> saves_;
  std::optional<LinearImage> reference_;  ///< the picture that the window shows as side B
  int losses_ = 0;                        ///< contexts lost since the latest publication
  double publishMs_ = 0.0;                ///< time of the latest publication
  double filterMsPerPixel_ = 0.0;         ///< time of layers and filter for a pixel
  FileWatch sceneFiles_;
  FileWatch shaderFiles_;
  double watched_ = 0.0;  ///< when they were looked at, by steadyMilliseconds()
};

}  // namespace fragtrace
