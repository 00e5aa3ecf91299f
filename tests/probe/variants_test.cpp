// SPDX-License-Identifier: MIT
// The full shader links on the driver by each entry. tests/pure/variant_texts_test.cpp checks the text of
// every switch.
#include <gtest/gtest.h>

#include "gl/context.h"
#include "gl/program.h"

namespace fragtrace {
namespace {

TEST(Variants, TheFullShaderLinksByEachEntry) {
  DeviceOptions device;
  device.backend = Backend::Egl;
  const auto context = makeContext(device);
  ShaderVariant fragments;
  fragments.stages.set();
  fragments.traits.set();
  fragments.reads = BufferReads::Image;
  ShaderVariant compute = fragments;
  fragments.resumable = true;
  compute.reads = BufferReads::Ssbo;
  compute.dispatch = Dispatch::Compute;
  for (const ShaderVariant& variant : {fragments, compute}) {
    ProgramCache cache(shaderSource({}));
    EXPECT_NO_THROW(cache.tracerProgram(variant)) << variantName(variant);
  }
}

}  // namespace
}  // namespace fragtrace
