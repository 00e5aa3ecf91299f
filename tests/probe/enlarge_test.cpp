// SPDX-License-Identifier: MIT
// shaders/picture/enlarge.glsl: how far from a sharp edge a coarse picture of it is, once it is enlarged.
// `bench motion` judges what it makes of a picture.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "bench/command/window_picture.h"
#include "gl_probe.h"
#include "probe_program.h"
#include "render/picture_passes.h"

namespace fragtrace {
namespace {

constexpr glm::ivec2 kCoarse{24, 20};
constexpr int kTimes = 4;
constexpr glm::ivec2 kFine = kCoarse * kTimes;

/// A picture that is bright on one side of a line near the middle; `place` is in pixels of the coarse
/// picture.
float edgeAt(glm::dvec2 place, double angle) {
  const glm::dvec2 away = place - 0.5 * glm::dvec2(kCoarse) - 0.1;
  return std::cos(angle) * away.x + std::sin(angle) * away.y > 0.0 ? 0.9f : 0.1f;
}

std::vector<float> edge(double angle) {
  std::vector<float> coarse;
  for (int y = 0; y < kCoarse.y; ++y) {
    for (int x = 0; x < kCoarse.x; ++x) coarse.push_back(edgeAt(glm::dvec2(x, y) + 0.5, angle));
  }
  return coarse;
}

struct Enlarged {
  double byEdges = 0.0;  ///< squared error
  double linearly = 0.0;
};

class Enlarging : public GlProbe {
 protected:
  /// Enlarges a grey picture in both ways.
  std::vector<float> enlarged(const std::vector<float>& grey) {
    const GlProgram program =
        buildComputeProgram("#version 450 core\n" + shaderText("picture/enlarge.glsl") + R"(
layout(local_size_x = 1) in;
layout(binding = 0) uniform sampler2D picture;
layout(std430, binding = 0) buffer Values { vec2 values[]; };
void main() {
  uvec2 at = gl_WorkGroupID.xy;
  vec2 uv = (vec2(at) + 0.5) / vec2(gl_NumWorkGroups.xy);
  values[at.y * gl_NumWorkGroups.x + at.x] = vec2(enlarged(picture, uv).r, textureLod(picture, uv, 0.0).r);
}
)");
    const GlTexture texture = makePictureTexture(GL_RGBA32F, kCoarse);
    std::vector<float> texels;
    for (const float value : grey) texels.insert(texels.end(), {value, value, value, 1.0f});
    writePictureTexture(texture, GL_RGBA, 4, GL_FLOAT, kCoarse, texels, "writing a picture");
    glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glBindTextureUnit(0, texture.name());
    std::vector<float> values(size_t(kFine.x) * size_t(kFine.y) * 2);
    const GlBuffer buffer = makeBuffer();
    const auto bytes = GLsizeiptr(values.size() * sizeof(float));
    glNamedBufferStorage(buffer.name(), bytes, nullptr, 0);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer.name());
    glUseProgram(program.name());
    glDispatchCompute(GLuint(kFine.x), GLuint(kFine.y), 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(buffer.name(), 0, bytes, values.data());
    glUseProgram(0);
    checkGl("enlarging");
    return values;
  }

  Enlarged errors(double angle) {
    const std::vector<float> values = enlarged(edge(angle));
    Enlarged sum;
    for (int y = 0; y < kFine.y; ++y) {
      for (int x = 0; x < kFine.x; ++x) {
        const size_t at = 2 * (size_t(y) * size_t(kFine.x) + size_t(x));
        const float right = edgeAt((glm::dvec2(x, y) + 0.5) / double(kTimes), angle);
        EXPECT_GE(values[at], 0.1f - 1e-6f);
        EXPECT_LE(values[at], 0.9f + 1e-6f);
        sum.byEdges += std::pow(double(values[at] - right), 2.0);
        sum.linearly += std::pow(double(values[at + 1] - right), 2.0);
      }
    }
    return sum;
  }
};

TEST_P(Enlarging, EdgesOfAnyDirectionAreNearerToSharpOnes) {
  for (int step = 0; step < 24; ++step) {
    const double angle = 0.13 + step * 2.0 * M_PI / 24.0;
    const Enlarged error = errors(angle);
    EXPECT_LT(error.byEdges, 0.9 * error.linearly) << angle;
  }
}

TEST_P(Enlarging, AnEvenPictureStaysAsItIs) {
  const auto pixels = size_t(kCoarse.x) * size_t(kCoarse.y);
  for (const float value : enlarged(std::vector<float>(pixels, 0.25f))) EXPECT_NEAR(value, 0.25f, 1e-6f);
}

TEST_P(Enlarging, TheBenchmarkOfMotionJudgesWhatTheWindowShows) {
  const std::vector<float> coarse = edge(0.4);
  Image image{kCoarse.x, kCoarse.y, {"R", "G", "B"}, {}, {}};
  for (const float value : coarse) image.values.insert(image.values.end(), 3, value);
  const Image shown = WindowPicture().of(image, kFine);
  const std::vector<float> values = enlarged(coarse);
  constexpr float kStep = 1.0f / 255.0f;
  for (size_t i = 0; i < values.size() / 2; ++i) EXPECT_NEAR(shown.values[3 * i], values[2 * i], kStep) << i;
  EXPECT_EQ(WindowPicture().of(shown, kFine).values, shown.values);
}

INSTANTIATE_TEST_SUITE_P(Backends, Enlarging, bothBackends(), backendName);

}  // namespace
}  // namespace fragtrace
