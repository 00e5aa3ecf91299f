// SPDX-License-Identifier: MIT
// Pure shader functions run by the driver on a table of cases, and compared with the same text compiled as
// C++.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "gl_probe.h"
#include "glsl.h"
#include "probe_program.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::vec2;
using glm::vec3;

/// Rows of floats, one a case.
struct Table {
  int width;
  std::vector<float> values;
  explicit Table(int columns) : width(columns) {}
  int rows() const { return int(values.size()) / width; }
  const float* row(int i) const { return &values[size_t(i) * size_t(width)]; }
  vec3 vector(int i, int column) const { return {row(i)[column], row(i)[column + 1], row(i)[column + 2]}; }
  void add(const vec3& v) { values.insert(values.end(), {v.x, v.y, v.z}); }
};

class Probe : public GlProbe {
 protected:
  /// Runs `body`, which reads given(k) and writes result(k, x), for every row of the table.
  static Table runOnDriver(const Table& given, int resultWidth, const std::string& body) {
    std::string text = probePrelude() + "layout(local_size_x = 64) in;\n";
    text +=
        "layout(std430, binding = 0) readonly buffer Given { float givenValues[]; };\n"
        "layout(std430, binding = 1) writeonly buffer Results { float resultValues[]; };\n"
        "float given(int k) { return givenValues[int(gl_GlobalInvocationID.x) * " +
        std::to_string(given.width) +
        " + k]; }\n"
        "vec3 givenVector(int k) { return vec3(given(k), given(k + 1), given(k + 2)); }\n"
        "void result(int k, float x) { resultValues[int(gl_GlobalInvocationID.x) * " +
        std::to_string(resultWidth) +
        " + k] = x; }\n"
        "void result(int k, vec3 v) { result(k, v.x); result(k + 1, v.y); result(k + 2, v.z); }\n"
        "void main() {\n  if (gl_GlobalInvocationID.x >= " +
        std::to_string(given.rows()) + "u) return;\n" + body + "}\n";
    const GlProgram program = buildComputeProgram(text);
    const GlBuffer input = makeBuffer();
    const GlBuffer output = makeBuffer();
    Table results(resultWidth);
    results.values.resize(size_t(given.rows()) * size_t(resultWidth));
    glNamedBufferStorage(input.name(), GLsizeiptr(given.values.size() * 4), given.values.data(), 0);
    glNamedBufferStorage(output.name(), GLsizeiptr(results.values.size() * 4), nullptr, 0);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, input.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, output.name());
    glUseProgram(program.name());
    glDispatchCompute(GLuint(given.rows() + 63) / 64, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(output.name(), 0, GLsizeiptr(results.values.size() * 4), results.values.data());
    glUseProgram(0);
    checkGl("running a probe");
    return results;
  }
};

/// Returns the distance of two numbers, in units in the last place of numbers as large as `scale`.
// Limits leave room for what the specification lets a driver round (division 2.5 ulps, sine and cosine 2^-11
// in theory, a few ulps in practice); llvmpipe rounds as C++ does, except for sine and cosine.
double ulpsApart(double a, double b, double scale) { return std::abs(a - b) / (scale * 0x1p-23); }
double ulpsApart(const vec3& a, const vec3& b) { return double(glm::distance(a, b)) * 0x1p23; }

TEST_P(Probe, RandomNumbersAreTheSameBits) {
  Table given(2);
  Draw draw(1);
  for (int i = 0; i < 20000; ++i)
    given.values.insert(given.values.end(), {float(draw.integer(0, 1 << 24)), float(draw.integer(0, 4096))});
  const Table results = runOnDriver(
      given, 2,
      "  result(0, randomFloat(mixBits(uint(given(0))), uint(given(1))));\n"
      "  result(1, randomFloat(pathKey(pixelKey(uint(given(0)), uint(given(1)), 4u), 3u), 5u));\n");
  for (int i = 0; i < given.rows(); ++i) {
    const auto a = uint32_t(given.row(i)[0]);
    const auto b = uint32_t(given.row(i)[1]);
    ASSERT_EQ(results.row(i)[0], glsl_float::randomFloat(glsl_float::mixBits(a), b));
    ASSERT_EQ(results.row(i)[1],
              glsl_float::randomFloat(glsl_float::pathKey(glsl_float::pixelKey(a, b, 4), 3), 5));
  }
}

TEST_P(Probe, FresnelIsWithinEightUlps) {
  Table given(2);
  Draw draw(2);
  for (int i = 0; i < 20000; ++i) {
    const double eta = draw.between(1.05, 2.5);
    given.values.insert(given.values.end(), {draw.unit(), float(i % 2 == 0 ? eta : 1.0 / eta)});
  }
  const Table results = runOnDriver(given, 2,
                                    "  result(0, fresnelDielectric(given(0), given(1)));\n"
                                    "  result(1, schlickDielectric(given(0), given(1)));\n");
  double worst = 0.0;
  for (int i = 0; i < given.rows(); ++i) {
    const float cosine = given.row(i)[0];
    const float eta = given.row(i)[1];
    // Close to the critical angle, a square root magnifies the rounding errors of the divisions.
    const double left = std::max(std::abs(1.0 - (1.0 - double(cosine) * cosine) / (double(eta) * eta)), 1e-7);
    worst = std::max(worst, ulpsApart(results.row(i)[0], glsl_float::fresnelDielectric(cosine, eta), 1.0) *
                                std::sqrt(left));
    worst = std::max(worst, ulpsApart(results.row(i)[1], glsl_float::schlickDielectric(cosine, eta), 1.0) *
                                std::sqrt(left));
  }
  EXPECT_LE(worst, 8.0);
}

TEST_P(Probe, CosineDirectionsAreWithinSixteenUlps) {
  Table given(2);
  Draw draw(3);
  for (int i = 0; i < 40000; ++i) given.values.push_back(draw.unit());
  const Table results = runOnDriver(given, 3, "  result(0, sampleCosineHemisphere(given(0), given(1)));\n");
  double worst = 0.0;
  for (int i = 0; i < given.rows(); ++i) {
    const vec3 expected = glsl_float::sampleCosineHemisphere(given.row(i)[0], given.row(i)[1]);
    // The third component is a square root of what the others leave.
    worst = std::max(worst, ulpsApart(results.vector(i, 0), expected) * std::max(double(expected.z), 1e-3));
  }
  EXPECT_LE(worst, 16.0);
}

TEST_P(Probe, VisibleNormalsAreWithinAThousandUlps) {
  Table given(6);
  Draw draw(4);
  for (int i = 0; i < 20000; ++i) {
    given.add(vec3(draw.directionAbove()));
    given.values.insert(given.values.end(), {float(draw.between(0.01, 1.0)), draw.unit(), draw.unit()});
  }
  const Table results =
      runOnDriver(given, 3, "  result(0, sampleVisibleGgx(givenVector(0), given(3), given(4), given(5)));\n");
  double worst = 0.0;
  for (int i = 0; i < given.rows(); ++i) {
    const float* g = given.row(i);
    worst = std::max(worst, ulpsApart(results.vector(i, 0),
                                      glsl_float::sampleVisibleGgx(given.vector(i, 0), g[3], g[4], g[5])));
  }
  EXPECT_LE(worst, 1024.0);
}

TEST_P(Probe, PerlinNormalsAreWithinSixtyFourUlps) {
  Table given(2);
  Draw draw(5);
  for (int i = 0; i < 40000; ++i) given.values.push_back(float(draw.between(-4.0, 4.0)));
  const Table results =
      runOnDriver(given, 3, "  result(0, perlinNormal(vec2(given(0), given(1)), 8.0, 0.5, 3));\n");
  double worst = 0.0;
  for (int i = 0; i < given.rows(); ++i) {
    const vec3 expected = glsl_float::perlinNormal(vec2(given.row(i)[0], given.row(i)[1]), 8.0f, 0.5f, 3);
    worst = std::max(worst, ulpsApart(results.vector(i, 0), expected));
  }
  EXPECT_LE(worst, 64.0);
}

constexpr const char* kTwoTriangles =
    "  RayShear s = makeShear(givenVector(3));\n"
    "  TriangleHit a = intersectTriangle(givenVector(0), s, givenVector(6), givenVector(9), "
    "givenVector(12));\n"
    "  TriangleHit b = intersectTriangle(givenVector(0), s, givenVector(15), givenVector(12), "
    "givenVector(9));\n"
    "  result(0, vec3(a.hit ? 1.0 : 0.0, a.front ? 1.0 : 0.0, a.t));\n"
    "  result(3, vec3(a.weight1, a.weight2, b.hit ? 1.0 : 0.0));\n";

TEST_P(Probe, TrianglesAreHitAlikeAndWithinSixteenUlps) {
  Table given(18);
  Draw draw(6);
  constexpr int kCases = 50000;
  for (int i = 0; i < kCases; ++i) {
    const vec3 origin(draw.inCube(2.0));
    std::array<vec3, 4> v;
    for (vec3& corner : v) corner = vec3(draw.inCube(1.0));
    given.add(origin);
    given.add(vec3(glm::normalize((glm::dvec3(v[0]) + glm::dvec3(v[1]) + glm::dvec3(v[2])) / 3.0 +
                                  draw.inCube(0.5) - glm::dvec3(origin))));
    for (const vec3& corner : v) given.add(corner);
  }
  const Table results = runOnDriver(given, 6, kTwoTriangles);
  int differ = 0;
  int hits = 0;
  double worst = 0.0;
  for (int i = 0; i < kCases; ++i) {
    const auto h =
        glsl_float::intersectTriangle(given.vector(i, 0), glsl_float::makeShear(given.vector(i, 3)),
                                      given.vector(i, 6), given.vector(i, 9), given.vector(i, 12));
    const float* r = results.row(i);
    if (h.hit != (r[0] != 0.0f)) {
      ++differ;
      continue;
    }
    if (!h.hit) continue;
    ++hits;
    EXPECT_EQ(h.front, r[1] != 0.0f);
    // Seen edge-on the distance is the quotient of two small numbers.
    const vec3 normal = glm::normalize(
        glm::cross(given.vector(i, 9) - given.vector(i, 6), given.vector(i, 12) - given.vector(i, 6)));
    const double facing = std::abs(double(glm::dot(normal, given.vector(i, 3))));
    worst = std::max(worst, ulpsApart(r[2], h.t, 4.0) * facing * facing);
  }
  EXPECT_GT(hits, kCases / 10);
  EXPECT_LE(differ, kCases / 10000);  // a driver may divide in its own way, which moves edges by an ulp
  EXPECT_LE(worst, 16.0);
}

TEST_P(Probe, NoRayPassesASharedEdge) {
  // Seen edge-on, as near as directions come: one fused product instead of two rounded ones opens gaps here.
  Table given(18);
  Draw draw(7);
  constexpr int kCases = 200000;
  for (int i = 0; i < kCases; ++i) {
    const vec3 origin(draw.inCube(0.5));
    const vec3 b(draw.inCube(1.0) + glm::dvec3(3.0, 0.0, 0.0));
    const vec3 c(draw.inCube(1.0) + glm::dvec3(3.0, 0.0, 0.0));
    const vec3 target = b + draw.unit() * (c - b);
    const vec3 direction = glm::normalize(target - origin);
    // The two triangles lie to either side of the edge as seen by the ray, and a little or a lot behind it.
    const glm::dvec3 aside = glm::normalize(glm::cross(glm::dvec3(c) - glm::dvec3(b), glm::dvec3(direction)));
    const double reach = i % 2 == 0 ? 0.5 : 1e-3;
    const vec3 a(glm::dvec3(target) + reach * aside + draw.between(-1.0, 1.0) * glm::dvec3(direction));
    const vec3 d(glm::dvec3(target) - reach * aside + draw.between(-1.0, 1.0) * glm::dvec3(direction));
    for (const vec3& v : {origin, direction, a, b, c, d}) given.add(v);
  }
  const Table results = runOnDriver(given, 6, kTwoTriangles);
  int passed = 0;
  for (int i = 0; i < kCases; ++i) passed += results.row(i)[0] == 0.0f && results.row(i)[5] == 0.0f ? 1 : 0;
  EXPECT_EQ(passed, 0);
}

INSTANTIATE_TEST_SUITE_P(Driver, Probe, bothBackends(), backendName);

}  // namespace
}  // namespace fragtrace
