// SPDX-License-Identifier: MIT
// All options are compared but those that are made equal here, so that a new one counts until it is known not
// to change the picture.
#include "stage/same_picture.h"

namespace fragtrace {

namespace {

/// The options with all that changes neither picture nor samples as by default.
RenderOptions sampledPart(RenderOptions o) {
  const RenderOptions standard;
  o.stages.set(size_t(Stage::Watertight), has(standard.stages, Stage::Watertight));
  o.output = standard.output;
  o.spp = standard.spp;
  o.noise = standard.noise;
  o.seconds = standard.seconds;
  o.sceneOrigin = standard.sceneOrigin;  // rounding alone
  o.exposure = standard.exposure;        // this and the next: of files, not of what was drawn
  o.toneMap = standard.toneMap;
  // The heat map shows the way through the tree.
  if (!has(o.stages, Stage::BvhHeatmap)) o.traversal = standard.traversal;
  o.instancing = standard.instancing;
  o.backend = standard.backend;
  o.bufferReads = standard.bufferReads;
  o.dispatch = standard.dispatch;
  o.schedule = standard.schedule;
  o.aovSamples = standard.aovSamples;
  o.aovVariance = standard.aovVariance;
  o.aovFeatures = standard.aovFeatures;
  o.denoise = standard.denoise;  // after all samples
  o.oidnLibrary = standard.oidnLibrary;
  o.treeLevel = standard.treeLevel;
  o.statsFile = standard.statsFile;
  o.shaderFolder = standard.shaderFolder;
  o.limits.memoryBytes = standard.limits.memoryBytes;
  o.limits.allowExternalFiles = standard.limits.allowExternalFiles;
  o.quiet = standard.quiet;
  o.verbose = standard.verbose;
  return o;
}

/// The same, with what changes the samples alone.
RenderOptions shownPart(const RenderOptions& options) {
  const RenderOptions standard;
  RenderOptions o = sampledPart(options);
  o.stages.set(size_t(Stage::Sobol), has(standard.stages, Stage::Sobol));
  o.stages.set(size_t(Stage::LightSampling), has(standard.stages, Stage::LightSampling));
  o.seed = standard.seed;
  o.sampleOffset = standard.sampleOffset;
  o.rouletteDepth = standard.rouletteDepth;
  return o;
}

}  // namespace

bool showSame(const RenderOptions& a, const RenderOptions& b) { return shownPart(a) == shownPart(b); }

bool drawSameSamples(const RenderOptions& a, const RenderOptions& b) {
  return sampledPart(a) == sampledPart(b);
}

std::string whyWithoutNoise(const RenderOptions& options) {
  if (!has(options.stages, Stage::Gi)) return "stages before gi have no noise but at edges";
  if (options.debugView != DebugView::None || has(options.stages, Stage::BvhHeatmap))
    return "a debug view shows what was drawn";
  return "";
}

}  // namespace fragtrace
