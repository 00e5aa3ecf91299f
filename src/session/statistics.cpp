// SPDX-License-Identifier: MIT
#include "session/statistics.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/summary.h"
#include "render/film/path_share.h"

namespace fragtrace {

namespace {

nlohmann::ordered_json vectorJson(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

nlohmann::ordered_json timesJson(const std::vector<double>& ms) {
  nlohmann::ordered_json json;
  if (ms.empty()) return json;
  const Summary summary = summarize(ms);
  json["median"] = summary.median;
  json["mean"] = summary.mean;
  json["stddev"] = summary.stddev;
  json["min"] = summary.min;
  json["p95"] = summary.p95;
  return json;
}

nlohmann::ordered_json phasesJson(const Statistics& s) {
  std::vector<Phase> phases = s.phases;
  std::ranges::stable_sort(phases, {}, &Phase::begin);
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Phase& phase : phases) {
    json.push_back({{"name", phase.name},
                    {"thread", phase.thread},
                    {"begin_ms", phase.begin - s.clockMs},
                    {"end_ms", phase.end - s.clockMs},
                    {"cpu_ms", phase.cpu}});
  }
  return json;
}

nlohmann::ordered_json denoiseJson(const DenoiseStatistics& denoise) {
  if (denoise.filter.empty()) return {{"skipped", denoise.skipped}};
  nlohmann::ordered_json json = {{"filter", denoise.filter}, {"ms", denoise.filterMs}};
  if (denoise.library.empty()) {
    json["compile_ms"] = denoise.compileMs;
  } else {
    json["load_ms"] = denoise.loadMs;
    json["library"] = denoise.library;
  }
  return json;
}

/// Appends how many segments stand for what moves while the shutter is open.
void addMotion(nlohmann::ordered_json& json, const MotionStatistics& motion) {
  if (motion.segments > 0) json["motion"] = {{"segments", motion.segments}, {"pixels_off", motion.pixels}};
  if (motion.cameraSegments > 0)
    json["camera_motion"] = {{"segments", motion.cameraSegments}, {"pixels_off", motion.cameraPixels}};
}

/// Appends the ways in which light was sampled.
void addLighting(nlohmann::ordered_json& json, const Statistics& s) {
  if (s.sun) {
    json["sun_elevation"] = s.sun->elevation;
    json["sun_azimuth"] = s.sun->azimuth;
  }
  if (s.clampIndirect > 0.0) json["clamp_indirect"] = s.clampIndirect;
  if (!s.lightSelection.empty()) {
    json["light_selection"] = s.lightSelection;
    json["light_selection_reason"] = s.lightSelectionReason;
  }
  json["camera_rays"] = s.cameraRays;
  if (!s.lightReuse.empty()) json["light_reuse"] = s.lightReuse;
  if (!s.lightPathReason.empty()) {
    const bool alone = s.film.pixelsPerPath == kNoLightPaths;
    json["caustics"] = {{"light_paths", s.film.lightPaths},
                        {"pixels_per_path", alone ? 0 : s.film.pixelsPerPath},
                        {"casters", s.casters},
                        {"variance_share", s.film.m2 > 0.0 ? s.film.lightPathM2 / s.film.m2 : 0.0},
                        {"guiding_ms", s.times.guidingMs},
                        {"reason", alone ? "camera paths alone are less noisy" : s.lightPathReason}};
  }
}

/// Appends numbers of rays and draws, and what was counted of the work.
void addWork(nlohmann::ordered_json& json, const Statistics& s) {
  json["rays"] = s.film.rays;
  json["mpaths_per_s"] = megaPathsPerSecond(s);
  json["mrays_per_s"] = s.times.renderMs > 0.0 ? double(s.film.rays) / s.times.renderMs / 1000.0 : 0.0;
  json["draws"] = s.times.work.draws;
  json["programs"] = s.programs;
  json["shader_characters"] = s.shaderCharacters;
  if (!s.countsWork) return;
  for (size_t i = 0; i < kWorkNames.size(); ++i)
    json["work"][std::string(kWorkNames[i])] = s.times.work.numbers[i];
}

/// Erases times and rates from an object, and from the objects in it.
void dropTimes(nlohmann::ordered_json& json) {
  for (auto row = json.begin(); row != json.end();) {
    const std::string& name = row.key();
    if (name == "phases" || name == "ms" || name.ends_with("_ms") || name.ends_with("_per_s")) {
      row = json.erase(row);
      continue;
    }
    if (row->is_object()) dropTimes(*row);
    ++row;
  }
}

}  // namespace

nlohmann::ordered_json sceneJson(const SceneDescription& s) {
  nlohmann::ordered_json json;
  json["triangles"] = s.triangles;
  json["vertices"] = s.vertices;
  json["spheres"] = s.spheres;
  json["points"] = s.points;
  json["lines"] = s.lines;
  json["instances"] = s.instances;
  json["instancing"] = {{"shared_meshes", s.sharedMeshes},
                        {"instances", s.sharedInstances},
                        {"triangles_drawn", s.trianglesDrawn},
                        {"reason", s.sharing}};
  json["materials"] = s.materials;
  json["textures"] = s.textures;
  json["images"] = s.images;
  json["image_bytes"] = s.imageBytes;
  if (s.volumeBricks > 0) json["volume_bricks"] = s.volumeBricks;
  json["lights"] = {{"point", s.pointLights}, {"spot", s.spotLights}, {"directional", s.directionalLights}};
  json["cameras"] = {{"perspective", s.perspectiveCameras}, {"orthographic", s.orthographicCameras}};
  json["emissive_triangles"] = s.emissiveTriangles;
  json["emissive_spheres"] = s.emissiveSpheres;
  json["extensions"] = s.extensionsUsed;
  if (s.bounds.empty()) {
    json["bounds"] = nullptr;
  } else {
    json["bounds"] = {{"min", vectorJson(s.bounds.minimum)}, {"max", vectorJson(s.bounds.maximum)}};
  }
  json["origin"] = vectorJson(s.origin);
  return json;
}

nlohmann::ordered_json bvhJson(const BvhQuality& bvh) {
  nlohmann::ordered_json json;
  json["nodes"] = bvh.nodeCount;
  if (bvh.meshNodeCount > 0) json["mesh_nodes"] = bvh.meshNodeCount;
  json["leaves"] = bvh.leafCount;
  json["depth"] = bvh.depth;
  json["primitives_per_leaf"] = bvh.primitivesPerLeaf;
  json["sah_cost"] = bvh.sahCost;
  return json;
}

std::string jsonText(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

double megaPathsPerSecond(const Statistics& s) {
  return s.times.renderMs > 0.0 ? double(s.film.samples) / s.times.renderMs / 1000.0 : 0.0;
}

double samplesPerPixel(const Statistics& s) { return double(s.film.samples) / (double(s.size.x) * s.size.y); }

double cutShare(const Statistics& s) { return s.film.cut / double(std::max<uint64_t>(1, s.film.samples)); }

std::string statisticsText(const Statistics& s) {
  nlohmann::ordered_json json = {{"schema", 1}};
  json["scene"] = sceneJson(s.scene);
  json["bvh"] = bvhJson(s.bvh);
  json["bvh"]["refitted"] = s.treeRefitted;
  if (s.cutOut > 0) json["bvh"]["cut_out_triangles"] = s.cutOut;
  json["load_ms"] = s.loadMs;
  json["bvh_build_ms"] = s.bvhBuildMs;
  json["pack_ms"] = s.packMs;
  json["upload_ms"] = s.uploadMs;
  json["compile_ms"] = s.compileMs;
  json["first_frame_ms"] = s.times.firstFrameMs;
  json["render_ms"] = s.times.renderMs;
  json["frame_ms"] = timesJson(s.times.frameMs);
  json["spp"] = s.spp;
  json["seed"] = s.seed;
  json["samples_per_pixel"] = samplesPerPixel(s);
  json["fewest_samples"] = s.film.fewestSamples;
  json["most_samples"] = s.film.mostSamples;
  if (s.adaptive) {
    json["adaptive"] = {
        {"noise", s.adaptive->noise},
        {"seconds", s.adaptive->seconds},
        {"error_p95", s.adaptive->known ? nlohmann::json(s.adaptive->error) : nlohmann::json()},
        {"share_under_noise", s.adaptive->known ? s.adaptive->share : 0.0},
        {"rounds", s.adaptive->rounds}};
  }
  addLighting(json, s);
  addMotion(json, s.motion);
  if (s.featureMs > 0.0) json["feature_ms"] = s.featureMs;
  if (s.denoise) json["denoise"] = denoiseJson(*s.denoise);
  json["width"] = s.size.x;
  json["height"] = s.size.y;
  if (s.region) json["region"] = {s.region->corner.x, s.region->corner.y, s.region->size.x, s.region->size.y};
  if (s.parts > 1) json["parts"] = s.parts;
  json["complete"] = s.complete;
  addWork(json, s);
  json["nonfinite_pixels"] = s.film.nonfinitePixels;
  json["budget_hits"] = s.film.budgetHits;
  json["cut_share"] = cutShare(s);
  json["scene_bytes"] = s.sceneBytes;
  if (s.scene.triangles > 0)
    json["gpu_bytes_per_triangle"] = double(s.geometryBytes) / double(s.scene.triangles);
  json["default_light"] = s.defaultLight;
  if (s.defaultLight) json["default_light_reason"] = s.defaultLightReason;
  if (!s.lampUnits.empty()) json["lamp_units"] = s.lampUnits;
  json["exposure"] = s.exposure.value_or(0.0);
  json["variant"] = s.variant;
  json["quick_compilation"] = s.quickCompilation;
  json["schedule"] = s.scheduleReason.empty() ? "wavefront" : "megakernel";
  if (!s.scheduleReason.empty()) json["schedule_reason"] = s.scheduleReason;
  if (!s.readFallback.empty()) json["buffer_reads_fallback"] = s.readFallback;
  json["skipped"] = s.skipped;
  json["backend"] = s.backend;
  json["gl_renderer"] = s.glRenderer;
  json["gl_version"] = s.glVersion;
  if (s.vectorWidth > 0) json["vector_width"] = s.vectorWidth;
  json["warnings"] = s.warnings;
  json["clock_ms"] = s.clockMs;
  json["clock_cpu_ms"] = s.clockCpuMs;
  json["phases"] = phasesJson(s);
  if (s.countsWork) dropTimes(json);
  return jsonText(json);
}

}  // namespace fragtrace
