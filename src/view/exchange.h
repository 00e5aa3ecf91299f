// SPDX-License-Identifier: MIT
// Between the window's thread and the tracing thread: requests one way, pictures and results the other.
#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "bvh/outlines.h"
#include "gl/context.h"
#include "image/image.h"
#include "pack/own_light.h"
#include "scene/describe.h"
#include "shader/render_options.h"
#include "shader/traits.h"
#include "shader/variant.h"
#include "view/pictures.h"

namespace fragtrace {

/// The steps of a picture of the viewer, in their order.
enum class Pass : size_t { Trace, Guides, Film, Past, Filter, Show };
inline constexpr std::array kPassNames{"trace", "guides", "film", "past", "filter", "show"};

/// Milliseconds of each.
struct PassTimes {
  std::array<double, kPassNames.size()> wall{};  ///< meaningful where each pass was waited for
  std::array<double, kPassNames.size()> cpu{};   ///< processor time of the tracing thread
};

/// The contents of the split view: both sides of the bar, one side alone, or how far they differ.
enum class CompareMode : uint8_t { Bar, Left, Right, Difference };
inline constexpr std::array kComparisonNames{"bar", "left", "right", "difference"};

/// The picture that the window wants to show.
struct TraceRequest {
  uint64_t number = 0;               ///< the window counts requests
  std::vector<RenderOptions> sides;  ///< one, both of the split view, or one a stage; with their cameras
  glm::ivec2 size{0};                ///< pixels
  bool moving = false;               ///< frames at the resolution that can be had now, rather than samples
  bool values = true;                ///< pictures that are not shared are copied to the host
};

/// Returns true if both draw the same samples, whatever their number and their display.
bool drawsTheSame(const RenderOptions& a, const RenderOptions& b);

/// Progress and cost of one side.
struct SideStatistics {
  int samples = 0;       ///< a pixel
  double error = -1.0;   ///< the relative error that 95 % of the pixels stay under; negative: not yet known
  double seconds = 0.0;  ///< spent on these samples
  double frameMs = 0.0;  ///< one sample in every pixel: median of the latest
  double frameP95Ms = 0.0;
  double megaRaysPerSecond = 0.0;
  double megaPathsPerSecond = 0.0;
  bool resting = false;   ///< converged, or as many samples as asked for
  double filtered = 0.0;  ///< the share of the noise filter in what is shown, 0 to 1
  double filterMs = 0.0;  ///< time that it took, with the layers it needs
  std::string variant;
  size_t deviceBytes = 0;   ///< scene, film and pictures
  uint64_t movedBytes = 0;  ///< between host and device since the side's picture before
  PassTimes passes;         ///< times since then
  bool copied = false;      ///< through the host, as the window's driver is another one
};

/// Pictures that are shown at once at most: one of each stage.
inline constexpr size_t kMostSides = 7;

/// A texture that the contexts of both threads see: RGBA32F, linear, the first row at the top.
struct SharedTexture {
  int slot = -1;  ///< index among the side's kSlots; negative: there is none
  unsigned texture = 0;
  void* ready = nullptr;  ///< the GLsync after which it holds the picture; the tracing thread's
};
/// There are four textures for a side: one is shown, one waits for its fence, the window has just taken one
/// that replaces the latter, and one is drawn.
inline constexpr size_t kSlots = 4;

/// A finished picture of one side.
struct TracedPicture {
  size_t side = 0;
  uint64_t request = 0;  ///< the latest that it answers
  glm::ivec2 size{0};
  SharedTexture shared{};          ///< the picture, if textures are shared; else the image below
  Image image;                     ///< linear R, G, B and perhaps A, the first row at the top
  bool asItIs = false;             ///< colours of a debug view: neither exposure nor tone map
  std::filesystem::path file{};    ///< file of a picture that was read; empty: it was traced
  std::vector<PictureLine> lines;  ///< lines over the picture: boxes of the tree
  SideStatistics statistics;
};

/// The scene that is drawn, as far as the window knows it.
struct ViewedScene {
  RenderOptions options;  ///< options of the load
  Camera camera;          ///< the camera that the options choose
  std::vector<Camera> cameras;
  BoundsDouble bounds;
  TraitSet present;
  SceneDescription description;
  bool defaultLight = false;                        ///< the scene has no light of its own
  FileLight light{};                                ///< what is decided about that light
  std::optional<double> exposure{};                 ///< stops that it asks for
  Surroundings surroundings = Surroundings::None;   ///< the light besides the scene's own
  bool refersToFiles = false;                       ///< its file can only be written into its own folder
  std::vector<std::filesystem::path> environments;  ///< files near it that may
  std::vector<SceneNode> nodes;                     ///< nodes as they were loaded
  /// The file's materials, without the numbers that the user has set.
  std::vector<Material> materials;
  std::vector<LightSource> lights;      ///< the file's lights, in the same way
  std::vector<std::string> sceneNames;  ///< this and the next three are those of Scene
  std::vector<std::string> materialVariants;
  std::vector<std::string> animationNames;
  std::vector<std::optional<double>> animationSeconds;
};

/// The scene as it is posed now.
struct PosedScene {
  BoundsDouble bounds;
  Surroundings surroundings = Surroundings::None;
};

/// The progress of loading.
struct LoadStatus {
  bool busy = false;
  std::string name;
  std::string step;
  double fraction = 0.0;

  bool operator==(const LoadStatus&) const = default;
};

/// A file to be made of what a side has accumulated, linear or as a display shows it, or of all sides.
struct SaveRequest {
  std::filesystem::path path;
  size_t side = 0;
  bool all = false;  ///< all sides as they are shown, rather than one
  Composition composition{};
};

/// The use of the answer to a pick.
enum class PickUse : uint8_t {
  Select,
  Center,   ///< the camera is centred on it
  Focus,    ///< the lens is focused on it
  Measure,  ///< its distance from the selected point is wanted
  Level     ///< the plane through it and the two points of the distance becomes level
};

/// A question for the thing at a place of the picture.
struct PickRequest {
  size_t side = 0;
  glm::dvec2 place{0.0};  ///< parts of width and height, from the top left
  PickUse use = PickUse::Select;
  bool clear = false;              ///< nothing is selected any more
  std::optional<uint32_t> node{};  ///< this one and what is below it, rather than a place (SceneNode::index)
  uint64_t number = 0;             ///< number of the latest selection that was asked for
};

struct PickAnswer {
  PickRequest request;
  bool hit = false;
  glm::dvec3 point{0.0};             ///< world space
  std::vector<std::string> lines;    ///< description of the hit, in words
  BoundsDouble bounds;               ///< bounds of all that its node draws, world space
  std::optional<uint32_t> node;      ///< the selected node
  std::optional<uint32_t> material;  ///< material at the place, an index into ViewedScene::materials
  std::optional<glm::dvec3> end{};   ///< the point that was measured to, world space
};

/// A small picture of an environment.
struct EnvironmentThumbnail {
  std::filesystem::path file;  ///< empty: the studio
  /// The picture as a display shows it: R, G, B, 0..1; without pixels: it cannot be read.
  Image image;
};

/// A model has been written with these numbers.
struct SavedModel {
  std::vector<SetNumber> set;
};

/// A result for the window, which takes all of them in their order. A text is a message about the driver or
/// about a file that was written.
using Result =
    std::variant<ViewedScene, PosedScene, PickAnswer, EnvironmentThumbnail, SavedModel, std::string>;

/// The state of the tracing thread. Only the latest counts.
struct TraceStatus {
  LoadStatus load;
  uint64_t request = 0;  ///< the latest that the tracing thread has seen
  bool resting = false;  ///< the tracing thread has nothing to do
  std::string note;      ///< reason why the tracing thread does not draw; empty: it does
  std::string error;     ///< why the latest request could not be met; empty if it was met

  bool operator==(const TraceStatus&) const = default;
};

/// Results for the window since it asked last.
struct Results {
  std::vector<Result> queue;
  std::vector<TracedPicture> pictures;  ///< one per side at most
  TraceStatus status;
};

/// Requests for the tracing thread. Of each kind the latest counts, but all files are written.
struct Requests {
  std::optional<TraceRequest> trace;
  std::optional<std::optional<RenderOptions>> load;  ///< a scene; none: the load is cancelled
  std::vector<SaveRequest> saves;
  std::optional<std::filesystem::path> model;      ///< file to be written with the numbers that are set
  std::optional<std::filesystem::path> reference;  ///< file to be delivered as side B; empty: side B ends
  std::optional<PickRequest> pick;
  std::optional<std::vector<std::filesystem::path>>
      thumbnails;  ///< environments of which small pictures are wanted
  bool quit = false;
};

class Exchange {
 public:
  /// Called from the tracing thread whenever something waits for the window.
  void setWake(std::function<void()> wake);

  // The window's thread.
  template <typename T>
  void request(std::optional<T> Requests::*kind, T wanted) {
    request([&](Requests& r) { r.*kind = std::move(wanted); });
  }
  void request(const std::function<void(Requests&)>& change);
  /// Throws what the tracing thread failed with, if it did.
  Results take();
  /// The window shows a texture no longer, once the GLsync `done`, now the tracing thread's, is signalled.
  void release(size_t side, const SharedTexture& texture, void* done);

  // The tracing thread.
  /// Waits for requests or wakeTracer(), at most that long.
  Requests wait(double seconds);
  /// Returns true if drawing is to stop: a newer request waits, or the end.
  bool interrupted() const;
  bool ending() const;
  /// Returns a slot of the side that the window neither shows nor waits for, and the GLsync at which its last
  /// use ends (null: none). The caller owns both. A picture that the window has not yet taken is dropped, and
  /// if sides are shown together, so are those of the other sides.
  std::pair<int, void*> freeSlot(size_t side, bool together);
  void deliver(TracedPicture picture);
  /// The window gets these at once.
  void deliver(std::vector<TracedPicture> pictures);
  void deliver(Result result);
  /// The tracing thread has ended by an exception, which ends the program.
  void fail(std::exception_ptr failure);
  /// Sets a member of the status, and wakes the window if that changes it. Any thread may call it.
  template <typename T>
  void set(T TraceStatus::*member, std::type_identity_t<T> value) {
    const std::lock_guard lock(mutex_);
    if (results_.status.*member == value) return;
    results_.status.*member = std::move(value);
    if (wake_) wake_();
  }
  /// Ends a wait() from a third thread.
  void wakeTracer();

 private:
  mutable std::mutex mutex_;
  std::condition_variable requested_;
  std::function<void()> wake_;
  bool waiting_ = false;  ///< something waits for the tracing thread
  bool ending_ = false;
  Requests requests_;
  Results results_;
  std::exception_ptr failure_;
  std::array<std::array<bool, kSlots>, kMostSides> taken_{};  ///< slots that the window reads
  std::array<std::array<void*, kSlots>, kMostSides> doneAt_{};
};

// The viewer's window behind a shared object of our own, opened by `view` alone: it links GLFW and Dear
// ImGui, and has OpenGL functions of its own, since its driver may be another than the tracing thread's.

struct WindowStart {
  RenderOptions options;
  std::filesystem::path statusFile;           ///< see docs/viewer.md; empty: none
  std::filesystem::path reference;            ///< a picture to compare with; empty: none
  std::vector<std::filesystem::path> models;  ///< the scene and those that follow; one: its folder's
  bool panel = true;                          ///< next to the first picture
  std::string warning;                        ///< for a message; empty: none
  /// Called once the window is there, with contexts that share its objects, as far as there can be any, and
  /// live as long as it; and before the window ends, by when nothing may be drawn there any more.
  std::function<void(const SharedContexts& shared)> opened;
  std::function<void()> ending;
  /// True from when the program is told to end.
  std::function<bool()> interrupted;
};

/// The functions of libfragtrace_window.so. Host and library are of one build, so C++ types may cross.
struct WindowLibrary {
  const char* version;  ///< version of its sources; stays the first member
  /// Shows the window until it is closed, then returns. Throws ContextError when there can be none, and what
  /// the tracing thread failed with.
  void (*run)(const WindowStart& start, Exchange& exchange);
};

/// The one function that libfragtrace_window.so exports, by this name.
inline constexpr const char* kWindowLibraryEntry = "fragtraceWindowLibrary";
using WindowLibraryEntry = const WindowLibrary* (*)();

}  // namespace fragtrace
