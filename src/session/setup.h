// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <memory>
#include <span>

#include "bvh/scene_tree.h"
#include "gltf/gltf.h"
#include "pack/own_light.h"
#include "render/renderer.h"
#include "scene/motion/moving_scene.h"
#include "scene/scene.h"
#include "session/say.h"
#include "session/statistics.h"
#include "shader/render_options.h"

namespace fragtrace {

// From options to a scene that is ready to be drawn: what every front end does before its first draw.

/// A scene with all that is seen around it and from where; no OpenGL yet.
struct LoadedScene {
  Scene scene;
  Environment environment;
  Camera camera;
  CameraOverrides overrides;       ///< the camera was chosen by these (settledOverrides())
  std::optional<int> cameraIndex;  ///< index of that camera in the scene, if one was asked for
  BoundsDouble framed;  ///< box of what the camera frames, world space: all of the scene, or a part
  /// The camera's motion while the shutter is open; empty: it stands still.
  std::vector<CameraSegment> motion{};
  glm::ivec2 size{0};          ///< size of the picture
  Region region;               ///< part of the picture that is drawn
  size_t strays = 0;           ///< points that the default view leaves out
  glm::dvec2 shadowFade{0.0};  ///< shadowFadeOf() the picture
  FileLight light{};           ///< what is decided about the file's own light
  Bvh bvh;
  View view;
  DecodeProgress decoding{};  ///< told when the textures are, which is later
};

/// Called with what is done, before each step and within those that may be long, and the part of the work
/// that is behind, 0..1; what it throws ends loading.
using LoadProgress = GltfProgress;

/// One film holds all of a picture, or a part at a time (session/picture/draw_parts.h).
enum class FilmOf : uint8_t { Picture, Part };

/// Results that one picture of an animation leaves to the next; each may be none.
struct SceneBefore {
  /// The map of the options; it is moved into the next scene, if there is one.
  Environment* environment = nullptr;
  const RefittableTree* tree = nullptr;
  const Volume* volume = nullptr;
  std::shared_ptr<KeptDocument>* document = nullptr;  ///< passed to loadGltf()
  std::optional<FileLight> light{};                   ///< what was decided when the file was opened
};

/// Loads scene and environment, chooses camera and size, builds the tree; fills in the statistics of that.
/// Says warnings on stderr unless quiet. Throws InputError, UsageError, also where the film of a whole
/// picture would not fit into memory.
LoadedScene loadScene(const RenderOptions& options, Statistics& stats, const LoadProgress& progress = {},
                      FilmOf film = FilmOf::Picture, SceneBefore before = {});

/// Triangles. Smaller scenes are literals as a whole, or not at all.
inline constexpr size_t kLeastBesideLarge = 256;

/// Chooses camera, size and region of a scene that is there. Throws as loadScene() does for these.
void aim(LoadedScene& loaded, const RenderOptions& options, FilmOf film);

/// The options have a scene read so.
GltfOptions gltfOptionsOf(const RenderOptions& options);

/// The picture's size in pixels.
glm::ivec2 chooseSize(const Camera& camera, const RenderOptions& options);

/// LightOptions::shadowFade of a picture of that size, in which the camera has framed these points: as wide
/// as the margins around the lowest of them, from which the shadow spreads, so that no edge of it is seen; 0:
/// nowhere.
glm::dvec2 shadowFadeOf(const RenderOptions& options, const CameraOverrides& settled, const Camera& camera,
                        std::span<const glm::dvec3> points, glm::ivec2 size);

/// Points of the world about which --fit moves the camera.
struct FittedPoints {
  std::vector<glm::dvec3> scene;
  BoundsDouble bounds;             ///< of these, or, if they are all of the scene, its own
  size_t strays = 0;               ///< points that are left out
  std::vector<glm::dvec3> shadow;  ///< points around the shadow on the catcher
  double catcherHeight = -std::numeric_limits<double>::infinity();  ///< Y, metres; of several, the lowest
};

/// The camera as --fit moves it, then zoomed as the orbit says. The shadow counts where the camera sees the
/// catcher, which it does from above.
Camera fitCamera(const Camera& camera, const FittedPoints& points, const CameraOverrides& overrides,
                 glm::ivec2 size);

/// The points of the scene, or of the part that the overrides name, and, where the camera is to be moved for
/// it, of the shadow. Throws UsageError.
FittedPoints pointsToFit(const Scene& scene, const Environment& environment, const RenderOptions& options,
                         const CameraOverrides& overrides);

/// Camera paths that the picture takes at the most: what the largest number of samples allows.
double pathsOf(const RenderOptions& options, glm::ivec2 size);

/// Returns the part of the options that needs neither another program nor other buffers.
View makeView(const RenderOptions& options, const LoadedScene& loaded, const Camera& camera);

/// The tree of the options' traversal. The iterative one needs none; where it is chosen for them, the largest
/// triangles stand next to it when that pays.
Bvh buildTree(const Scene& scene, const RenderOptions& options);

/// Returns true if buildTree() builds the same for both.
bool sameTree(const RenderOptions& a, const RenderOptions& b);

/// Returns true if the built-in environment lights the scene, asked for or by default.
bool isInStudio(const RenderOptions& options, const LoadedScene& loaded);

/// Frees what only packing needs: triangles, vertices, pictures, the tree. For front ends that pack once.
void releaseGeometry(LoadedScene& loaded);

/// Milliseconds since the last call.
class Stopwatch {
 public:
  double lap() {
    const auto now = Clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

/// Reads the grid that the options, or else the scene ask for, unless `before` has it, and adds its box to
/// the scene's. Warns in the scene of one that has no density. Throws InputError.
void placeVolume(Scene& scene, const RenderOptions& options, const Volume* before);

}  // namespace fragtrace
