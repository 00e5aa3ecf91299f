// SPDX-License-Identifier: MIT
// Traversal alone finds what double precision finds, whichever way buffers are read.
#include <gtest/gtest.h>

#include <algorithm>

#include "gl_probe.h"
#include "scene/camera.h"
#include "tests/instruments/rays/ball_scene.h"
#include "tests/instruments/rays/hit_check.h"
#include "tests/instruments/rays/ray_caster.h"
#include "tests/instruments/rays/ray_sets.h"

namespace fragtrace {
namespace {

class RayCasting : public GlProbe {};

TEST_P(RayCasting, FindsWhatDoublePrecisionFinds) {
  const Scene scene = makeBallScene(3000);
  const Bvh bvh = buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size()));
  const ExactTracer tracer(scene, bvh);
  const glm::ivec2 size(120, 90);
  std::vector<Ray> primary = primaryRays(frameScene(scene.bounds), {}, size);
  const std::vector<ExactHit> hits = tracer.nearest(primary);
  const std::vector<Ray> shadow = shadowRays(tracer, scene, primary, hits, 1);
  primary[0] = Ray{};  // none
  for (const BufferReads reads : {BufferReads::Image, BufferReads::Ssbo, BufferReads::Texel}) {
    for (const auto& [method, dispatch, gpu] :
         {std::tuple(TraversalMethod::Bvh, Dispatch::Fragment, false),
          std::tuple(TraversalMethod::FrontToBack, Dispatch::Fragment, false),
          std::tuple(TraversalMethod::FrontToBack, Dispatch::Compute, true)}) {
      RenderOptions options;
      options.stages = stagesUpTo(Stage::Flat);
      options.device.traversal = method;
      ShaderVariant variant = chooseVariant(options, traitsOf(scene, Surroundings::None), Surroundings::None,
                                            bvh.stackNeed, reads);
      variant.dispatch = dispatch;
      variant.gpu = gpu;
      RayCaster caster(context(), packScene(scene, bvh, {}, variant), variant, size);
      EXPECT_STREQ(caster.clockName(), "wall clock");
      const auto found = [&](const std::vector<Ray>& rays, bool anyHit) {
        EXPECT_GT(caster.trace(RayCaster::RaySet(rays), anyHit), 0.0);
        std::vector<FoundHit> all;
        for (const TracedRay& hit : caster.hits()) all.push_back({primitiveInSlot(bvh, hit.slot), hit.t});
        return all;
      };
      const std::vector<FoundHit> nearest = found(primary, false);
      EXPECT_EQ(nearest.size(), primary.size());
      EXPECT_EQ(nearest[0].primitive, kMissIndex);
      EXPECT_LE(countWrongNearest(primary, nearest, tracer.nearest(primary), 2.0), 1u);
      const std::vector<FoundHit> any = found(shadow, true);
      EXPECT_LE(countWrongAny(shadow, any, tracer.nearest(shadow)), 1u);
      const auto met = [](const FoundHit& hit) { return hit.primitive != kMissIndex; };
      EXPECT_GT(std::ranges::count_if(nearest, met), 1000);
      EXPECT_GT(std::ranges::count_if(any, met), 20);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Driver, RayCasting, bothBackends(), backendName);

}  // namespace
}  // namespace fragtrace
