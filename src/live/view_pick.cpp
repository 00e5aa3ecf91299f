// SPDX-License-Identifier: MIT
// What the viewer's tracing thread knows of a place of the picture, and of what was selected there.
#include "live/pick_text.h"
#include "live/view_tracer.h"
#include "picture/picture_file.h"

namespace fragtrace {

void ViewTracer::answer(const PickRequest& request) {
  if (request.clear) return select({});
  PickAnswer answer;
  answer.request = request;
  const Side* side = request.side < sides_.size() ? &sides_[request.side] : nullptr;
  if (!side || !side->program) return;
  const Projection projection = projectionOf(side->view.camera, double(request_.size.x) / request_.size.y);
  const glm::dvec2 place(2.0 * request.place.x - 1.0, 1.0 - 2.0 * request.place.y);
  const Scene& scene = loaded_->scene;
  if (const std::optional<Pick> pick = pickAt(scene, loaded_->bvh, projection, place)) {
    answer.hit = true;
    answer.point = pick->point;
    answer.lines = pickLines(scene, *pick);
    answer.bounds = boundsOfPicked(scene, *pick);
  } else {
    answer.lines = {"nothing is there"};
  }
  if (!request.center) select(answer.bounds);
  exchange_.deliver(std::move(answer));
}

/// Its box is drawn over the pictures from now on; empty: nothing is selected.
void ViewTracer::select(const BoundsDouble& bounds) {
  if (selected_.empty() && bounds.empty()) return;
  selected_ = bounds;
  for (Side& side : sides_) {
    if (side.program && !side.stale && side.samples > 0) publish(side);
  }
}

std::vector<PictureLine> ViewTracer::linesOver(const Side& side) const {
  std::vector<PictureLine> lines = treeLines(side.options, *loaded_, side.view.camera, request_.size);
  if (selected_.empty()) return lines;
  const LocalSpace& space = loaded_->scene.space;
  Bounds box;
  box.include(glm::vec3(space.localOf(selected_.minimum)));
  box.include(glm::vec3(space.localOf(selected_.maximum)));
  const Projection projection = projectionOf(side.view.camera, double(request_.size.x) / request_.size.y);
  const std::vector<PictureLine> edges = boxEdges({&box, 1}, projection, space);
  lines.insert(lines.end(), edges.begin(), edges.end());
  return lines;
}

}  // namespace fragtrace
