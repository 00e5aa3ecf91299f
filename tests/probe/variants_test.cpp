// SPDX-License-Identifier: MIT
// Every switch of the shader compiles and links, on its own and left out of the full shader.
#include <gtest/gtest.h>

#include "gl/context.h"
#include "gl/program.h"

namespace fragtrace {
namespace {

class Variants : public ::testing::TestWithParam<BufferReads> {
 protected:
  static void SetUpTestSuite() { context = makeContext(Backend::Egl).release(); }
  static void TearDownTestSuite() { delete context; }
  static inline Context* context = nullptr;

  static ShaderVariant full(BufferReads reads) {
    ShaderVariant v;
    v.stages.set();
    v.traits.set();
    v.reads = reads;
    return v;
  }

  static void links(const ShaderVariant& variant) {
    ProgramCache cache(shaderSource({}));
    EXPECT_NO_THROW(cache.tracerProgram(variant)) << variantName(variant);
  }
};

class EveryRead : public Variants {};

TEST_P(EveryRead, TheFullShaderAndItsEmptyOne) {
  links(full(GetParam()));
  ShaderVariant empty;
  empty.reads = GetParam();
  links(empty);
  ShaderVariant resumable = full(GetParam());
  resumable.resumable = true;
  links(resumable);
  resumable.dispatch = Dispatch::Compute;
  links(resumable);
}

/// Each is left out by one kind of reads and alone by the other, by turns: the reads are another text, which
/// EveryRead covers.
bool isLeftOut(size_t index, BufferReads reads) { return (index % 2 == 0) == (reads == BufferReads::Image); }

TEST_P(Variants, EachStageLeftOutOrAlone) {
  for (const StageRow& row : stageRows()) {
    ShaderVariant v = full(GetParam());
    if (isLeftOut(size_t(row.stage), GetParam())) {
      v.stages.flip(size_t(row.stage));
    } else {
      v.stages.reset().set(size_t(row.stage));
    }
    links(v);
  }
}

TEST_P(Variants, EachTraitLeftOutOrAlone) {
  for (const TraitRow& row : traitRows()) {
    ShaderVariant v = full(GetParam());
    if (isLeftOut(size_t(row.trait), GetParam())) {
      v.traits.reset(size_t(row.trait));
    } else {
      v.traits.reset().set(size_t(row.trait));
    }
    links(v);
  }
}

TEST_P(Variants, EachTraversalAndStack) {
  for (TraversalMethod method :
       {TraversalMethod::Iterative, TraversalMethod::Bvh, TraversalMethod::FrontToBack}) {
    for (int size : {8, 12, 16, 20, 24, 32, 48}) {
      ShaderVariant v = full(GetParam());
      v.traversal = method;
      v.stackSize = size;
      v.stages.reset().set(size_t(Stage::Flat));
      links(v);
    }
  }
}

std::string nameOf(const ::testing::TestParamInfo<BufferReads>& test) {
  return std::string(kBufferReadsNames[size_t(test.param)]);
}

INSTANTIATE_TEST_SUITE_P(Reads, Variants, ::testing::Values(BufferReads::Image, BufferReads::Ssbo), nameOf);
INSTANTIATE_TEST_SUITE_P(Reads, EveryRead,
                         ::testing::Values(BufferReads::Image, BufferReads::Ssbo, BufferReads::Texel),
                         nameOf);

}  // namespace
}  // namespace fragtrace
