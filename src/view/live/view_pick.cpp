// SPDX-License-Identifier: MIT
// The tracing thread's knowledge of a place of the picture, and of what was selected there.
#include <algorithm>

#include "session/picture/picture_file.h"
#include "view/live/pick_text.h"
#include "view/live/view_tracer.h"

namespace fragtrace {

void ViewTracer::answer(const PickRequest& request) {
  if (request.clear) return select({});
  PickAnswer answer;
  answer.request = request;
  Selected chosen;
  const Scene& scene = loaded_->scene;
  const auto choose = [&](uint32_t node, NodeSet nodes) {
    answer.node = node;
    answer.bounds = boundsOfNodes(scene, nodes);
    chosen = {std::move(nodes), answer.bounds};
  };
  const Side* side = request.side < sides_.size() ? &sides_[request.side] : nullptr;
  if (request.node) {
    choose(*request.node, nodesBelow(scene, *request.node));
    const auto node = std::ranges::find(scene.nodes, *request.node, &SceneNode::index);
    if (node != scene.nodes.end()) answer.lines = {"node " + node->name};
    const bool hidden = node != scene.nodes.end() && node->hidden;
    if (answer.bounds.empty()) answer.lines.emplace_back(hidden ? "it is hidden" : "it draws nothing");
  } else {
    if (!side || !side->program) return;
    const Projection projection = projectionOf(side->view.camera, double(request_.size.x) / request_.size.y);
    const glm::dvec2 place(2.0 * request.place.x - 1.0, 1.0 - 2.0 * request.place.y);
    if (const std::optional<Pick> pick = pickAt(scene, loaded_->bvh, projection, place)) {
      answer.hit = true;
      answer.point = pick->point;
      answer.lines = pickLines(scene, *pick);
      if (pick->material < scene.materials.size()) answer.material = pick->material;
      NodeSet nodes(size_t(pick->nodeIndex) + 1);
      nodes[pick->nodeIndex] = true;
      choose(pick->nodeIndex, std::move(nodes));
    } else {
      answer.lines = {"nothing is there"};
    }
  }
  if (request.use == PickUse::Select) select(std::move(chosen));
  exchange_.deliver(std::move(answer));
}

/// Its outline is drawn over the pictures from now on.
void ViewTracer::select(Selected selected) {
  if (selected_.nodes.empty() && selected.nodes.empty()) return;
  selected_ = std::move(selected);
  for (Side& side : sides_) {
    if (side.program && !side.stale && side.samples > 0) publish(side);
  }
}

std::vector<PictureLine> ViewTracer::linesOver(const Side& side) {
  std::vector<PictureLine> lines = treeLines(side.options, *loaded_, side.view.camera, request_.size);
  // Straight edges are curves in a panorama and a fisheye, which have no outline.
  if (selected_.bounds.empty() || !isRectilinear(side.view.camera.type)) return lines;
  const LocalSpace& space = loaded_->scene.space;
  const Projection projection = projectionOf(side.view.camera, double(request_.size.x) / request_.size.y);
  if (selected_.outlined != std::pair(projection, request_.size)) {
    selected_.outline = outlineOfNodes(loaded_->scene, selected_.nodes, projection, request_.size);
    selected_.outlined = {projection, request_.size};
  }
  std::vector<PictureLine> around = selected_.outline;
  if (around.empty()) {
    Bounds box;
    box.include(glm::vec3(space.localOf(selected_.bounds.minimum)));
    box.include(glm::vec3(space.localOf(selected_.bounds.maximum)));
    around = boxEdges({&box, 1}, projection, space);
  }
  lines.insert(lines.end(), around.begin(), around.end());
  return lines;
}

}  // namespace fragtrace
