// SPDX-License-Identifier: MIT
// The arithmetic that GLSL leaves to GPUs, for all tests of this program, and tests of what it is.
#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <thread>

#include "glsl.h"

namespace fragtrace {
namespace {

using glm::vec3;

/// Makes the processor flush operands and results below 1.2e-38 to zero; threads inherit this. It runs before
/// all code that needs the fused instructions.
[[gnu::constructor(101)]] void flushToZero() {
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("fma")) {
    std::puts("skipped: this processor has no fused multiply-adds");
    std::fflush(stdout);
    std::_Exit(77);
  }
  constexpr unsigned kFlushResults = 0x8000;
  constexpr unsigned kFlushOperands = 0x0040;
  _mm_setcsr(_mm_getcsr() | kFlushResults | kFlushOperands);
}

/// Keeps the compiler from computing with the number.
float atRunTime(float x) {
  volatile float kept = x;
  return kept;
}

TEST(GpuArithmetic, FlushesWhatIsTooSmallToZeroOnAllThreads) {
  const auto check = [] {
    // Compared by bits, since a comparison flushes its operands, too.
    EXPECT_EQ(std::bit_cast<uint32_t>(atRunTime(std::numeric_limits<float>::min()) * atRunTime(0.5f)), 0u);
    EXPECT_EQ(atRunTime(std::numeric_limits<float>::denorm_min()) * atRunTime(0x1p24f), 0.0f);
  };
  check();
  std::thread(check).join();
}

// (1 + 2^-12)^2 is 1 + 2^-11 + 2^-24, whose last term is rounded away from the product of two floats.

TEST(GpuArithmetic, FusesProductsAndSums) {
  const float x = atRunTime(1.0f + 0x1p-12f);
  EXPECT_EQ(x * x - (1.0f + 0x1p-11f), 0x1p-24f);
  const vec3 v(x, 1.0f, 0.0f);
  EXPECT_EQ(glm::dot(v, vec3(x, -(1.0f + 0x1p-11f), 0.0f)), 0x1p-24f);
}

/// Expects that a ray from the origin hits the triangle, in every order of its vertices.
void expectHit(const vec3& direction, std::array<vec3, 3> v) {
  const glsl_float::RayShear shear = glsl_float::makeShear(direction);
  for (int turn = 0; turn < 3; ++turn) {
    EXPECT_TRUE(glsl_float::intersectTriangle(vec3(0.0f), shear, v[0], v[1], v[2]).hit) << "turn " << turn;
    std::rotate(v.begin(), v.begin() + 1, v.end());
  }
}

TEST(GpuArithmetic, FusesNothingInPreciseStatements) {
  const float x = atRunTime(1.0f + 0x1p-12f);
  const float square = 1.0f + 0x1p-11f;
  EXPECT_EQ(glsl_float::onItsWay(vec3(-square), vec3(x - square), x), vec3(0.0f));
  // Triangles on both sides of a place that the ray runs through: whatever is fused, the ray misses one of
  // them.
  for (const float side : {-1.0f, 1.0f}) {
    for (const bool swapped : {false, true}) {
      const auto at = [&](float u, float v, float z) { return swapped ? vec3(v, u, z) : vec3(u, v, z); };
      // An edge, by products that differ by 2^-24.
      const vec3 along(0.0f, 0.0f, 1.0f);
      expectHit(along, {at(x, square, 1.0f), at(-1.0f, -x, 1.0f), at(side, -side, 1.0f)});
      // A vertex, where the shear takes x^2 from `square`.
      const vec3 sheared = at(0.5f * x, 0.0f, 1.0f);
      expectHit(sheared, {at(square, 0.0f, 2.0f * x), at(x + side, 1.0f, 2.0f), at(x + side, -1.0f, 2.0f)});
    }
  }
}

}  // namespace
}  // namespace fragtrace
