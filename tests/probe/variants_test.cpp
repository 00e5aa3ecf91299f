// SPDX-License-Identifier: MIT
// The full shader links on the driver by each entry and each kind of reads. tests/pure/variant_texts_test.cpp
// checks the text of every switch.
#include <gtest/gtest.h>

#include "gl/context.h"
#include "gl/program.h"

namespace fragtrace {
namespace {

TEST(Variants, TheFullShaderLinksByEachEntryAndRead) {
  const auto context = makeContext(Backend::Egl);
  ShaderVariant fragments;
  fragments.stages.set();
  fragments.traits.set();
  fragments.reads = BufferReads::Image;
  ShaderVariant resumable = fragments;
  resumable.reads = BufferReads::Texel;
  resumable.resumable = true;
  ShaderVariant compute = fragments;
  compute.reads = BufferReads::Ssbo;
  compute.dispatch = Dispatch::Compute;
  for (const ShaderVariant& variant : {fragments, resumable, compute}) {
    ProgramCache cache(shaderSource({}));
    EXPECT_NO_THROW(cache.tracerProgram(variant)) << variantName(variant);
  }
}

}  // namespace
}  // namespace fragtrace
