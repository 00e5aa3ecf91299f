// SPDX-License-Identifier: MIT
#include "live/view_denoiser.h"

#include <algorithm>
#include <cmath>

#include "denoise/oidn.h"
#include "gl/program.h"
#include "image/channels.h"
#include "picture/draw_picture.h"

namespace fragtrace {

namespace {

constexpr double kAllUpTo = 64.0;  // samples
constexpr double kNoneFrom = 256.0;
constexpr int kGuideStep = 4;              // from one set of guides to the next, in samples
constexpr double kMostPastSamples = 16.0;  // that the past counts for

}  // namespace

double filteredShare(double samples) {
  return std::clamp(std::log2(kNoneFrom / std::max(samples, 1.0)) / std::log2(kNoneFrom / kAllUpTo), 0.0,
                    1.0);
}

void SideMemory::turn() {
  if (present) past = std::move(present);
  present.reset();
  guides = {};
  guideSamples = 0;
}

bool ViewDenoiser::drawGuides(glm::ivec2 size, int samples, Tracer& tracer, const View& view,
                              SideMemory& memory, const std::function<bool()>& goOn) {
  const int wanted = std::min(samples, kFewLayerSamples);
  const bool enough = memory.guides.width == size.x && memory.guides.height == size.y &&
                      (memory.guideSamples >= kFewLayerSamples || wanted < kGuideStep * memory.guideSamples);
  if (enough) return true;
  Image guides{size.x, size.y, {}, {}, {}};
  const LayerDraw layer = addLayer(guides, *tracer.renderer, tracer.features.front(), view, wanted,
                                   [&](double) { return goOn(); });
  tracer.renderer->use(tracer.variant);
  if (!layer.complete) return false;
  memory.guides = std::move(guides);
  memory.guideSamples = wanted;
  return true;
}

std::optional<Image> ViewDenoiser::shown(const Image& drawn, int samples, const RenderOptions& options,
                                         bool byOidn, Tracer& tracer, const View& view, SideMemory& memory,
                                         const std::function<bool()>& goOn) {
  const std::vector<std::string> colors{"R", "G", "B", "A"};
  const double share = filteredShare(samples);
  if (share <= 0.0) {
    memory = {};
    return onlyChannels(drawn, colors);
  }
  if (!drawGuides({drawn.width, drawn.height}, samples, tracer, view, memory, goOn)) return std::nullopt;
  SeenPicture present{drawn, view.camera};
  appendChannels(present.layers, memory.guides, memory.guides.channels);
  // The past fades out as the filter would: what it has seen from elsewhere is not what is seen here.
  const double past = kMostPastSamples * std::max(0.0, 1.0 - samples / kAllUpTo);
  if (memory.past && past > 0.0) present.layers = withPast(present, *memory.past, past);
  if (!byOidn && !filter_) filter_ = std::make_unique<VarianceFilter>(shaderSource(shaderFolder_));
  const std::optional<Image> filtered =
      byOidn
          ? denoisedByOidn(present.layers, *oidn_, options.limits.memoryBytes, [&](double) { return goOn(); })
          : filter_->filtered(present.layers, goOn);
  if (!filtered) return std::nullopt;
  Image picture = onlyChannels(drawn, colors);
  for (size_t i = 0, from = 0; i < picture.values.size(); i += 4, from += 3) {
    for (size_t c = 0; c < 3; ++c) {
      float& value = picture.values[i + c];
      value = float(std::lerp(double(value), double(filtered->values[from + c]), share));
    }
  }
  memory.present = std::move(present);
  return picture;
}

}  // namespace fragtrace
