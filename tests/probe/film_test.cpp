// SPDX-License-Identifier: MIT
// shaders/film_pixel.glsl on the driver: a compiler that reorders sums would undo the compensation.
#include <gtest/gtest.h>

#include <array>

#include "gl/gl.h"
#include "gl_probe.h"
#include "probe_program.h"

namespace fragtrace {
namespace {

class FilmSums : public GlProbe {};

/// One pixel, brought from dispatch to dispatch: each stays below llvmpipe's limit of loop iterations.
TEST_P(FilmSums, SixteenMillionThirdsAverageToAThird) {
  constexpr int kDispatches = 1 << 9;
  constexpr int kSamples = 1 << 15;
  const GlProgram program = buildComputeProgram(probePrelude() + R"(
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Pixel { vec4 sum; vec4 compensation; uvec4 counts; };
void main() {
  FilmPixel f = FilmPixel(sum.rgb, sum.a, compensation.rgb, compensation.a, counts.x, counts.y, counts.z, counts.w);
  for (int i = 0; i < 32768; ++i) f = addSample(f, vec3(1.0 / 3.0, 1.0e6 / 3.0, i % 1024 == 0 ? 1.0e6 : 0.001), 1.0);
  sum = vec4(f.sum, f.alpha);
  compensation = vec4(f.compensation, f.m2);
  counts = uvec4(f.samples, f.rays, f.nonfinite, f.flags);
}
)");
  const GlBuffer buffer = makeBuffer();
  const std::array<float, 12> zero{};
  glNamedBufferStorage(buffer.name(), sizeof zero, zero.data(), 0);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer.name());
  glUseProgram(program.name());
  for (int i = 0; i < kDispatches; ++i) {
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  }
  std::array<float, 8> film{};
  glGetNamedBufferSubData(buffer.name(), 0, sizeof film, film.data());
  glUseProgram(0);
  checkGl("adding samples");
  const double samples = double(kDispatches) * kSamples;
  const auto mean = [&](size_t c) { return (double(film[c]) - double(film[c + 4])) / samples; };
  EXPECT_EQ(double(film[3]), samples);
  EXPECT_NEAR(mean(0), 1.0 / 3.0, 1e-6);
  EXPECT_NEAR(mean(1), 1e6 / 3.0, 1.0);
  EXPECT_NEAR(mean(2) / ((1e6 + 1023 * 0.001) / 1024.0), 1.0, 1e-7);
}

INSTANTIATE_TEST_SUITE_P(Backends, FilmSums, bothBackends(), backendName);

}  // namespace
}  // namespace fragtrace
