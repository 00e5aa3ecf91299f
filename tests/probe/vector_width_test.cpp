// SPDX-License-Identifier: MIT
// The width of llvmpipe's vectors, as the driver tells it.
#include <gtest/gtest.h>

#include "gl/driver_choice.h"

namespace fragtrace {
namespace {

TEST(VectorWidth, IsReadFromTheRenderersName) {
  EXPECT_EQ(vectorWidthOf("llvmpipe (LLVM 15.0.6, 256 bits)"), 256);
  EXPECT_EQ(vectorWidthOf("zink Vulkan 1.4(llvmpipe (LLVM 19.1.7, 512 bits) (MESA_LLVMPIPE))"), 512);
  EXPECT_EQ(vectorWidthOf("NVIDIA H200/PCIe/SSE2"), 0);
  EXPECT_EQ(vectorWidthOf(""), 0);
}

}  // namespace
}  // namespace fragtrace
