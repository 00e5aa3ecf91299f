// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "base/timeline.h"
#include "bvh/bvh.h"
#include "render/adaptive.h"
#include "render/film/film_pixels.h"
#include "render/renderer.h"
#include "scene/describe.h"
#include "scene/sky/sky.h"

namespace fragtrace {

/// Scene counts as `info --json` and `--stats` spell them.
nlohmann::ordered_json sceneJson(const SceneDescription& scene);
nlohmann::ordered_json bvhJson(const BvhQuality& bvh);

/// JSON text; bytes that are no UTF-8 (file names) are replaced, so that the text is always valid.
std::string jsonText(const nlohmann::ordered_json& json);

/// Statistics of a render with --noise or --time.
struct AdaptiveStatistics : AdaptiveEstimate {
  double noise = 0.0;    ///< asked for; 0: none
  double seconds = 0.0;  ///< asked for; 0: none
};

/// Statistics of a render with --denoise.
struct DenoiseStatistics {
  std::string filter;      ///< name and version; empty: none ran
  std::string skipped;     ///< why none ran
  double compileMs = 0.0;  ///< programs, built again
  double filterMs = 0.0;   ///< wall clock, with the way to the device and back
  std::string library;     ///< the file of the library that filtered; empty: the built-in filter
  double loadMs = 0.0;     ///< time to open the library
};

/// Statistics of a picture with --shutter: segments in which surfaces and the camera move, 0 where they stand
/// still, and the most by which something is off its way then, pixels.
struct MotionStatistics {
  uint32_t segments = 0;
  double pixels = 0.0;
  uint32_t cameraSegments = 0;
  double cameraPixels = 0.0;
};

/// The contents of `--stats` for one render; the JSON's keys are the names here.
struct Statistics {
  SceneDescription scene;
  BvhQuality bvh;
  double loadMs = 0.0;
  double bvhBuildMs = 0.0;
  bool treeRefitted = false;  ///< the tree is that of the picture before, with other boxes
  double packMs = 0.0;
  double uploadMs = 0.0;
  double compileMs = 0.0;
  RenderTimes times;
  int spp = 0;
  uint32_t seed = 0;
  glm::ivec2 size{0};            ///< size of the drawn part
  std::optional<Region> region;  ///< the drawn part of the picture, if one was asked for
  int parts = 1;                 ///< number of parts in which it was drawn
  int cameraRays = 1;            ///< per sample
  FilmTotals film;
  std::optional<AdaptiveStatistics> adaptive;
  double featureMs = 0.0;  ///< drawing the layers of first hits
  std::optional<DenoiseStatistics> denoise;
  size_t cutOut = 0;         ///< triangles that alpha cuts out wholly
  size_t sceneBytes = 0;     ///< memory of the scene on the device
  size_t geometryBytes = 0;  ///< bytes among these for tree, leaves, records and vertex attributes
  bool defaultLight = false;
  std::string defaultLightReason;
  std::string lampUnits;           ///< as --lamp-units names them; empty: there is no lamp
  std::optional<double> exposure;  ///< stops; none: 0
  MotionStatistics motion;
  std::optional<SunPlace> sun;  ///< place of a sky's sun
  double clampIndirect = 0.0;   ///< 0: not clamped
  std::string lightSelection;   ///< name of the choice of lights; empty: there is none to choose
  std::string lightSelectionReason;
  std::string lightReuse;       ///< value of --light-reuse
  std::string lightPathReason;  ///< why light paths are traced, or are not; empty: the stage has none
  size_t casters = 0;           ///< groups of surfaces that they are aimed at; 0: none are traced
  bool complete = true;
  bool quickCompilation = false;  ///< the driver was told not to optimise
  bool countsWork = false;        ///< the times, which counting makes longer, are left out
  size_t programs = 0;            ///< programs of the tracer
  size_t shaderCharacters = 0;    ///< characters of their text
  std::string variant;
  std::string scheduleReason = "not chosen yet";  ///< why the megakernel draws; empty: the wavefront does
  std::string readFallback;  ///< why buffers are not read the fastest way; empty when they are
  std::string backend;
  std::string glRenderer;
  std::string glVersion;
  int vectorWidth = 0;               ///< bits of the vectors that software computes with; 0: not known
  std::vector<std::string> skipped;  ///< "refraction: no transmissive material", ...
  std::vector<std::string> warnings;
  double clockMs = steadyMilliseconds();     ///< the time at which the command began
  double clockCpuMs = threadMilliseconds();  ///< processor time of its thread by then
  std::vector<Phase> phases;                 ///< up to the written picture
};

/// Returns the statistics as JSON.
std::string statisticsText(const Statistics& statistics);

double megaPathsPerSecond(const Statistics& statistics);
double samplesPerPixel(const Statistics& statistics);
/// The mean share of a camera path's throughput that --bounces has cut (docs/design/conventions.md).
double cutShare(const Statistics& statistics);

}  // namespace fragtrace
