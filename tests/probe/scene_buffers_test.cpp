// SPDX-License-Identifier: MIT
// Arrays above what a driver reads one way are read another way, and memory of what is uploaded is given
// back.
#include <gtest/gtest.h>

#include "base/errors.h"
#include "gl/scene_buffers.h"
#include "gl_probe.h"

namespace fragtrace {
namespace {

class SceneArrays : public GlProbe {};

GpuScene sceneWith(uint32_t binding, size_t bytes) {
  GpuScene scene;
  scene.buffers[binding].resize(bytes / sizeof(uint32_t));
  return scene;
}

TEST_P(SceneArrays, AreReadTheFastestWayThatHoldsThem) {
  const ReadLimits limits{.texels = 100, .storageBytes = 800, .imageUnits = 16};
  const auto chosen = [&](uint32_t binding, size_t bytes, BufferReads wanted, bool software) {
    return chooseReads(wanted, software, sceneWith(binding, bytes), limits);
  };
  const uint32_t rows = layout::kLeavesBinding;   // 16 bytes per texel
  const uint32_t pairs = layout::kBricksBinding;  // 8
  EXPECT_EQ(chosen(rows, 1600, BufferReads::Auto, true).reads, BufferReads::Image);
  EXPECT_EQ(chosen(rows, 1600, BufferReads::Auto, true).fallback, "");
  EXPECT_EQ(chosen(rows, 800, BufferReads::Auto, false).reads, BufferReads::Ssbo);
  EXPECT_EQ(chosen(rows, 800, BufferReads::Auto, false).fallback, "");
  // A GPU whose storage blocks are too small falls back to texels, and says which array it was.
  const ReadChoice image = chosen(rows, 1600, BufferReads::Auto, false);
  EXPECT_EQ(image.reads, BufferReads::Texel);
  for (const char* text : {"1600", "800", "buffer 1", "storage"})
    EXPECT_NE(image.fallback.find(text), std::string::npos) << image.fallback;
  // A software driver whose images are too small, the other way round.
  const ReadLimits smallImages{.texels = 50, .storageBytes = 4000, .imageUnits = 16};
  const ReadChoice storage = chooseReads(BufferReads::Auto, true, sceneWith(rows, 816), smallImages);
  EXPECT_EQ(storage.reads, BufferReads::Ssbo);
  EXPECT_NE(storage.fallback.find("image"), std::string::npos);
  EXPECT_EQ(chooseReads(BufferReads::Auto, true, sceneWith(pairs, 408), smallImages).reads,
            BufferReads::Ssbo);
  EXPECT_EQ(chooseReads(BufferReads::Auto, true, sceneWith(pairs, 400), smallImages).reads,
            BufferReads::Image);
  // A read that was asked for stays, or says why it cannot; what neither holds stays the first, whose upload
  // says why.
  EXPECT_EQ(chosen(rows, 800, BufferReads::Ssbo, true).reads, BufferReads::Ssbo);
  EXPECT_THROW(chosen(rows, 1600, BufferReads::Ssbo, true), RenderError);
  const ReadLimits fewUnits{.texels = 100, .storageBytes = 800, .imageUnits = 8};  // NVIDIA's
  EXPECT_THROW(chooseReads(BufferReads::Image, false, GpuScene(), fewUnits), RenderError);
  EXPECT_EQ(chosen(rows, 1616, BufferReads::Auto, true).reads, BufferReads::Image);
}

TEST_P(SceneArrays, AboveTheLimitOfStorageBuffersAreRefusedThereAndReadAsImages) {
  const ReadLimits limits = readLimits();
  ASSERT_GT(limits.storageBytes, 0);
  if (limits.storageBytes > int64_t(1) << 28) return;  // not this driver's problem
  const auto bytes = size_t(limits.storageBytes) + 16;
  GpuScene scene = sceneWith(layout::kLeavesBinding, bytes);
  EXPECT_EQ(chooseReads(BufferReads::Auto, context().software, scene, limits).reads, BufferReads::Image);
  try {
    const SceneBuffers buffers(scene, BufferReads::Ssbo);
    ADD_FAILURE();
  } catch (const RenderError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(std::to_string(bytes)), std::string::npos) << text;
    EXPECT_NE(text.find("--buffer-reads"), std::string::npos) << text;
  }
  EXPECT_FALSE(scene.buffers[layout::kLeavesBinding].empty());
  const SceneBuffers buffers(scene, BufferReads::Image);
  EXPECT_EQ(scene.buffers[layout::kLeavesBinding].capacity(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Driver, SceneArrays, bothBackends(), backendName);

}  // namespace
}  // namespace fragtrace
