// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "scene/parts.h"
#include "scene/scene.h"

namespace fragtrace {

/// Called with what is done and the part of the work that is behind, 0..1; what it throws ends loading.
using GltfProgress = std::function<void(const std::string& step, double part)>;

/// A picture with an open shutter: its moment, and the first and the last key of what is played, in seconds.
struct OpenShutter {
  double moment = 0.0, firstKey = 0.0, lastKey = 0.0;
};

struct GltfOptions {
  std::optional<glm::dvec3> recenterOn{};      ///< world position that becomes the local origin
  std::optional<glm::dvec3> cameraPosition{};  ///< else the origin is chosen for a camera there,
  int cameraIndex = 0;  ///< else for the file's camera of this index: see recentringPoint()
  SceneSelection selection{};
  Instancing instancing = Instancing::Flatten;
  InputLimits limits{};
  std::optional<OpenShutter> shutter{};  ///< the time of the selection is one while it is open
  bool readsVolume = true;               ///< the grid of densities that a node brings
  GltfProgress progress{};
};

/// An animated file as it was read, for further poses: its bytes are not read again.
struct KeptDocument;

/// Reads a .gltf (with files next to it or data URIs) or .glb into a Scene whose geometry is recentred.
/// Throws InputError that names the file, the JSON pointer and the reason, and UsageError for a selection
/// that is not in the file. Scene::warnings lists what is skipped. With `kept`, an animated file is stored
/// there, and the next call reads it from there: a call for the same file, whose options differ only in pose,
/// camera and origin. A call that throws may leave nothing there.
Scene loadGltf(const std::filesystem::path& path, const GltfOptions& options = {},
               std::shared_ptr<KeptDocument>* kept = nullptr);

/// The times of the keys of the animation that the document was posed by last, in seconds, rising.
std::vector<double> keyTimesOf(const KeptDocument& document);

}  // namespace fragtrace
