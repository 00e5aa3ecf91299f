// SPDX-License-Identifier: MIT
#include "view/edit.h"

namespace fragtrace {

SideOptions sideOf(const RenderOptions& o) {
  return {.stages = o.stages,
          .sampling = o.sampling,
          .device = o.device,
          .debugView = o.output.debugView,
          .denoise = o.output.denoise,
          .pixelFilter = o.camera.pixelFilter,
          .lightSelection = o.light.selection,
          .lightReuse = o.light.reuse,
          .caustics = o.light.caustics,
          .transparentGlass = o.light.transparentGlass};
}

Edit editOf(const RenderOptions& options) {
  Edit edit;
  edit.shared = options;
  edit.sides = {sideOf(options)};
  return edit;
}

RenderOptions optionsOf(const Edit& edit, size_t side) {
  const SideOptions& own = edit.sides.at(side);
  RenderOptions o = edit.shared;
  o.stages = own.stages;
  o.sampling = own.sampling;
  o.sampling.noise = edit.shared.sampling.noise;
  o.device = own.device;
  o.output.debugView = own.debugView;
  o.output.denoise = own.denoise;
  o.camera.pixelFilter = own.pixelFilter;
  o.light.selection = own.lightSelection;
  o.light.reuse = own.lightReuse;
  o.light.caustics = own.caustics;
  o.light.transparentGlass = own.transparentGlass;
  return o;
}

void split(Edit& edit) {
  edit.split = true;
  if (edit.sides.size() == 1) edit.sides.push_back(edit.sides[0]);
}

}  // namespace fragtrace
