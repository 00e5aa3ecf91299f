// SPDX-License-Identifier: MIT
#include "options/same_picture.h"

#include "options/option_row.h"

namespace fragtrace {

namespace {

/// The options that the samples depend on.
RenderOptions sampledPart(const RenderOptions& options) {
  RenderOptions part = withoutEffects(
      options, {Effect::Report, Effect::Method, Effect::Layers, Effect::Count, Effect::Display});
  // The heat map shows the way through the tree.
  if (options.output.debugView == DebugView::Visits) part.device.traversal = options.device.traversal;
  return part;
}

/// The options that the limit of many samples depends on.
RenderOptions shownPart(const RenderOptions& options) {
  return withoutEffects(sampledPart(options), {Effect::Noise});
}

}  // namespace

bool showSame(const RenderOptions& a, const RenderOptions& b) { return shownPart(a) == shownPart(b); }

bool drawSameSamples(const RenderOptions& a, const RenderOptions& b) {
  return sampledPart(a) == sampledPart(b);
}

std::string whyWithoutNoise(const RenderOptions& options) {
  if (!has(options.stages, Stage::Gi)) return "stages before gi have no noise but at edges";
  if (options.output.debugView != DebugView::None) return "a debug view shows what was drawn";
  return "";
}

}  // namespace fragtrace
