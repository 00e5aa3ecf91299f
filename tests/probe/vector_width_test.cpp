// SPDX-License-Identifier: MIT
// The width of llvmpipe's vectors that `auto` chooses.
#include <gtest/gtest.h>

#include <limits>

#include "gl/driver_choice.h"

namespace fragtrace {
namespace {

constexpr double kMany = std::numeric_limits<double>::infinity();

TEST(VectorWidth, IsWideWhereThatPays) {
  EXPECT_EQ(chooseVectorWidth(VectorWidth::Auto, {kMany, false, true}), VectorWidth::Bits512);
  EXPECT_EQ(chooseVectorWidth(VectorWidth::Auto, {1e6, false, true}), VectorWidth::Auto)
      << "compilation takes longer";
  EXPECT_EQ(chooseVectorWidth(VectorWidth::Auto, {kMany, true, true}), VectorWidth::Auto)
      << "textures are read";
  EXPECT_EQ(chooseVectorWidth(VectorWidth::Auto, {kMany, false, false}), VectorWidth::Auto) << "no AVX-512";
}

TEST(VectorWidth, IsWhatWasAskedFor) {
  for (const VectorWidth wanted : {VectorWidth::Bits256, VectorWidth::Bits512})
    EXPECT_EQ(chooseVectorWidth(wanted, {0.0, true, false}), wanted);
}

TEST(VectorWidth, IsReadFromTheRenderersName) {
  EXPECT_EQ(vectorWidthOf("llvmpipe (LLVM 15.0.6, 256 bits)"), 256);
  EXPECT_EQ(vectorWidthOf("zink Vulkan 1.4(llvmpipe (LLVM 19.1.7, 512 bits) (MESA_LLVMPIPE))"), 512);
  EXPECT_EQ(vectorWidthOf("NVIDIA H200/PCIe/SSE2"), 0);
  EXPECT_EQ(vectorWidthOf(""), 0);
}

}  // namespace
}  // namespace fragtrace
