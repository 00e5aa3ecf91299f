// SPDX-License-Identifier: MIT
// shaders/intersect.glsl against exact integers and long doubles.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "shader_one_triangle.h"
#include "shader_statistics.h"

namespace fragtrace {
namespace {

using glm::dvec3;
using glm::vec3;
using Integers = glm::vec<3, int64_t>;

/// Ray and triangle with integer coordinates, and what follows from them without rounding.
struct ExactCase {
  Integers origin;
  Integers direction;
  std::array<Integers, 3> vertex;

  // Twice the areas of the three parts, seen along the ray, and their sum: as u, v, w of the shader.
  int64_t u = 0;
  int64_t v = 0;
  int64_t w = 0;
  int64_t volume = 0;

  void measure() {
    const Integers a = vertex[0] - origin;
    const Integers b = vertex[1] - origin;
    const Integers c = vertex[2] - origin;
    auto dot = [](const Integers& p, const Integers& q) { return p.x * q.x + p.y * q.y + p.z * q.z; };
    auto cross = [](const Integers& p, const Integers& q) {
      return Integers(p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x);
    };
    u = dot(direction, cross(c, b));
    v = dot(direction, cross(a, c));
    w = dot(direction, cross(b, a));
    volume = dot(a, cross(c, b));
  }
  int64_t sum() const { return u + v + w; }
  bool onEdge() const { return u == 0 || v == 0 || w == 0; }
  /// Returns true if a rounded shear decides the result: on an edge, or for a ray that starts in the
  /// triangle's plane.
  bool isDecidedByRounding() const { return onEdge() || volume == 0; }
  bool hit() const {
    const bool inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
    return inside && sum() != 0 && volume != 0 && (volume > 0) == (sum() > 0);
  }
  long double t() const { return static_cast<long double>(volume) / static_cast<long double>(sum()); }
};

Integers integersWithin(Draw& draw, int limit) {
  const int x = draw.integer(-limit, limit);
  const int y = draw.integer(-limit, limit);
  return {x, y, draw.integer(-limit, limit)};
}

bool isPowerOfTwo(int64_t x) { return x > 0 && (x & (x - 1)) == 0; }

/// The shear divides by the largest component: with a power of two nothing is rounded.
bool shearIsExact(const Integers& d) {
  return isPowerOfTwo(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}));
}

ExactCase drawCase(Draw& draw, int limit) {
  ExactCase c;
  do c.direction = integersWithin(draw, limit);
  while (c.direction == Integers(0));
  c.origin = integersWithin(draw, limit);
  for (Integers& v : c.vertex) v = integersWithin(draw, limit);
  // A third are aimed inside, an edge or a vertex: origin = point - direction * k.
  if (draw.integer(0, 2) == 0) {
    const int kind = draw.integer(0, 2);
    const int64_t third = kind == 0 ? 1 : 0;
    const int64_t second = kind <= 1 ? 1 : 0;
    const int64_t first = 3 - second - third;
    for (Integers& v : c.vertex) v *= 3;
    const Integers point = (first * c.vertex[0] + second * c.vertex[1] + third * c.vertex[2]) / int64_t(3);
    c.origin = point - c.direction * int64_t(draw.integer(-1, 3));
  }
  c.measure();
  return c;
}

template <typename Vector, typename Test>
void expectExact(int limit, int cases, double tolerance, Test test) {
  Draw draw{uint32_t(limit)};
  int hits = 0;
  int edges = 0;
  for (int k = 0; k < cases; ++k) {
    const ExactCase c = drawCase(draw, limit);
    if (c.isDecidedByRounding() && !shearIsExact(c.direction)) continue;
    const auto h = test(Vector(c.origin), Vector(c.direction), Vector(c.vertex[0]), Vector(c.vertex[1]),
                        Vector(c.vertex[2]));
    ASSERT_EQ(h.hit, c.hit()) << "case " << k;
    if (!c.hit()) continue;
    ++hits;
    edges += c.onEdge() ? 1 : 0;
    EXPECT_EQ(h.front, c.sum() > 0) << "case " << k;
    EXPECT_NEAR(double(h.t), double(c.t()), tolerance * (1.0 + std::abs(double(c.t())))) << "case " << k;
    EXPECT_NEAR(double(h.weight1), double(c.v) / double(c.sum()), tolerance) << "case " << k;
    EXPECT_NEAR(double(h.weight2), double(c.w) / double(c.sum()), tolerance) << "case " << k;
  }
  EXPECT_GT(hits, cases / 20);  // else it tests misses only
  EXPECT_GT(edges, 20);
}

/// Hits in front of the origin.
auto testInFloat = [](const auto& o, const auto& d, const auto& v0, const auto& v1, const auto& v2) {
  auto h = glsl_float::intersectTriangle(o, glsl_float::makeShear(d), v0, v1, v2);
  h.hit = h.hit && h.t > 0.0f;
  return h;
};
auto testInDouble = [](const auto& o, const auto& d, const auto& v0, const auto& v1, const auto& v2) {
  auto h = glsl_double::intersectTriangle(o, glsl_double::makeShear(d), v0, v1, v2);
  h.hit = h.hit && h.t > 0.0;
  return h;
};

TEST(ShaderTriangle, FloatHitsWhatExactIntegersHit) { expectExact<vec3>(8, 300000, 2e-4, testInFloat); }

TEST(ShaderTriangle, DoubleHitsWhatExactIntegersHit) {
  expectExact<dvec3>(8, 300000, 1e-12, testInDouble);
  expectExact<dvec3>(1000, 300000, 1e-7, testInDouble);
}

TEST(ShaderTriangle, SidesTurnWithTheOrderOfTheVertices) {
  const dvec3 a(-1, -1, 0);
  const dvec3 b(1, -1, 0);
  const dvec3 c(0, 1, 0);
  // Counter-clockwise seen from +z.
  for (double z : {-2.0, 2.0}) {
    const auto shear = glsl_double::makeShear(dvec3(0, 0, -z));
    const auto h = glsl_double::intersectTriangle(dvec3(0, 0, z), shear, a, b, c);
    EXPECT_TRUE(h.hit);
    EXPECT_EQ(h.front, z > 0.0);
    EXPECT_EQ(glsl_double::intersectTriangle(dvec3(0, 0, z), shear, a, c, b).front, z < 0.0);
  }
}

TEST(ShaderTriangle, WeightsBelongToTheirVertices) {
  const std::array<dvec3, 3> v = {dvec3(1, 2, 3), dvec3(-2, 5, 1), dvec3(0, -1, 4)};
  const dvec3 origin(3, 3, -5);
  const std::array<glm::dvec2, 3> weights = {glm::dvec2(0.1, 0.2), glm::dvec2(0.8, 0.1),
                                             glm::dvec2(0.1, 0.8)};
  for (const glm::dvec2& w : weights) {
    const dvec3 target = (1.0 - w.x - w.y) * v[0] + w.x * v[1] + w.y * v[2];
    const dvec3 direction = glm::normalize(target - origin);
    const auto h = testInDouble(origin, direction, v[0], v[1], v[2]);
    ASSERT_TRUE(h.hit);
    EXPECT_NEAR(h.weight1, w.x, 1e-12);
    EXPECT_NEAR(h.weight2, w.y, 1e-12);
    EXPECT_NEAR(h.t, glm::distance(target, origin), 1e-12);
  }
}

TEST(ShaderTriangle, WithoutAreaIsNeverHit) {
  Draw draw(3);
  for (int k = 0; k < 10000; ++k) {
    const vec3 a(draw.inCube(1.0));
    const vec3 b(draw.inCube(1.0));
    const vec3 direction(glm::normalize(dvec3(a) + dvec3(b) + draw.inCube(0.01)));
    EXPECT_FALSE(testInFloat(vec3(0), direction, a, b, a).hit);
    EXPECT_FALSE(testInFloat(vec3(0), direction, a, a, a).hit);
  }
}

/// Returns the distance along the ray, by the plain quadratic in long double. A negative result means that
/// there is no hit.
long double sphereDistance(const vec3& origin, const vec3& direction, const vec3& center, float radius,
                           bool far) {
  std::array<long double, 3> f;
  long double b = 0.0L;
  long double c = -static_cast<long double>(radius) * radius;
  long double a = 0.0L;
  for (int axis = 0; axis < 3; ++axis) {
    f[size_t(axis)] = static_cast<long double>(origin[axis]) - center[axis];
    b += f[size_t(axis)] * direction[axis];
    c += f[size_t(axis)] * f[size_t(axis)];
    a += static_cast<long double>(direction[axis]) * direction[axis];
  }
  const long double discriminant = b * b - a * c;
  if (discriminant < 0.0L) return -1.0L;
  return (far ? -b + std::sqrt(discriminant) : -b - std::sqrt(discriminant)) / a;
}

TEST(ShaderSphere, IsHitFromAFarWithinTheRoundingOfTheDistance) {
  Draw draw(5);
  for (double distance : {2.0, 10.0, 1e3, 1e5}) {
    int disagree = 0;
    constexpr int kRays = 20000;
    for (int k = 0; k < kRays; ++k) {
      const vec3 center(draw.inCube(1.0));
      const vec3 origin(dvec3(center) + distance * draw.direction());
      const dvec3 target = dvec3(center) + draw.inCube(1.5);
      const vec3 direction(glm::normalize(target - dvec3(origin)));
      const float t = glsl_float::intersectSphere(origin, direction, center, 1.0f, true, 0.0f, false);
      const long double expected = sphereDistance(origin, direction, center, 1.0f, false);
      if ((t > 0.0f) != (expected > 0.0L)) {
        ++disagree;
        continue;
      }
      if (t <= 0.0f) continue;
      // Seen at grazing incidence the distance moves with the square root of the rounding; both ends together
      // bound it.
      const double chord = double(sphereDistance(origin, direction, center, 1.0f, true) - expected);
      const double slack = 4e-7 * distance * (1.0 + 2.0 / std::max(chord, std::sqrt(1e-6 * distance)));
      EXPECT_NEAR(double(t), double(expected), slack) << "distance " << distance;
    }
    EXPECT_LE(disagree, 1e-6 * distance * kRays + 2) << "distance " << distance;
  }
}

TEST(ShaderSphere, FromInsideItsFarSideIsHit) {
  Draw draw(7);
  for (int k = 0; k < 20000; ++k) {
    const vec3 center(draw.inCube(10.0));
    const float radius = float(draw.between(0.1, 10.0));
    const vec3 origin(dvec3(center) + 0.99 * radius * std::cbrt(draw.between(0.0, 1.0)) * draw.direction());
    const vec3 direction(draw.direction());
    const float t = glsl_float::intersectSphere(origin, direction, center, radius, true, 0.0f, false);
    const double expected = double(sphereDistance(origin, direction, center, radius, true));
    EXPECT_NEAR(double(t), expected, 2e-5 * radius + 2e-6 * glm::length(dvec3(center)));
    EXPECT_EQ(glsl_float::intersectSphere(origin, direction, center, radius, false, 0.0f, false), -1.0f);
  }
}

TEST(ShaderSphere, BehindTheOriginIsNotHit) {
  for (double z : {1.5, 3.0, 100.0}) {
    EXPECT_EQ(glsl_double::intersectSphere(dvec3(0, 0, z), dvec3(0, 0, 1), dvec3(0), 1.0, true, 0.0, false),
              -1.0);
    EXPECT_DOUBLE_EQ(
        glsl_double::intersectSphere(dvec3(0, 0, z), dvec3(0, 0, -1), dvec3(0), 1.0, true, 0.0, false),
        z - 1.0);
    EXPECT_DOUBLE_EQ(
        glsl_double::intersectSphere(dvec3(0, 0, z), dvec3(0, 0, -1), dvec3(0), 1.0, false, 0.0, false),
        z - 1.0);
  }
}

/// A triangle of any size, about the origin or away from it; every third lies in an axis's plane.
std::array<vec3, 3> drawTriangle(Draw& draw, int k) {
  const double scale = std::pow(10.0, draw.between(-3.0, 3.0));
  const dvec3 place = draw.inCube(k % 2 == 0 ? 0.0 : 10.0 * scale);
  std::array<vec3, 3> v;
  for (vec3& corner : v) corner = vec3(place + draw.inCube(scale));
  if (k % 3 == 0) {
    const int axis = k / 3 % 3;
    const float height = k % 4 == 0 ? 0.0f : v[0][axis];
    for (vec3& corner : v) corner[axis] = height;
  }
  return v;
}

/// Returns the point at which a random ray from nearby hits the triangle, as shaders/surface.glsl computes
/// it, or nothing if it misses.
std::optional<vec3> hitPoint(Draw& draw, const std::array<vec3, 3>& v, const glm::vec4& plane) {
  const float u = draw.unit();
  const glm::vec2 w = glsl_float::sampleTriangle(u, draw.unit());
  const vec3 aim = v[0] + w.x * (v[1] - v[0]) + w.y * (v[2] - v[0]);
  const float size =
      std::max({glm::distance(v[0], v[1]), glm::distance(v[1], v[2]), glm::distance(v[2], v[0])});
  const vec3 origin = aim + size * std::exp2(6.0f * draw.unit() - 3.0f) * vec3(draw.direction());
  const vec3 direction = glm::normalize(aim - origin);
  const float t = distanceTo(v, origin, direction);
  if (t <= 0.0f) return std::nullopt;
  return glsl_float::pointOnPlane(origin, direction, t, vec3(plane), plane.w);
}

/// Small for their distance from the ray, all edge functions are rounding: the worst case of `bench stress
/// --rows huge-and-tiny`, and rays in the planes of small triangles.
TEST(ShaderTriangle, SmallTrianglesAreNotHitFromFarBeside) {
  EXPECT_FALSE(testInFloat(vec3(1.48330891f, -0.767524838f, -2.81794262f),
                           vec3(-0.586030364f, 0.138488322f, 0.798366725f),
                           vec3(-0.728496492f, -0.533028781f, 0.803178906f),
                           vec3(-0.728497446f, -0.533028364f, 0.803179622f),
                           vec3(-0.728496671f, -0.533028245f, 0.803178012f))
                   .hit);
  Draw draw(53);
  for (int k = 0; k < 200000; ++k) {
    const vec3 middle(draw.inCube(1.0));
    const dvec3 a = 1e-6 * draw.direction();
    const dvec3 b = 1e-6 * draw.direction();
    // The ray runs along the triangle's plane and passes next to it, by about half of its distance.
    const vec3 direction(glm::normalize(a + 0.3 * b));
    const vec3 origin = middle + vec3(1e6 * (0.5 * a + double(draw.unit()) * b)) - 2.0f * direction;
    const vec3 v1 = middle + vec3(a);
    const vec3 v2 = middle + vec3(b);
    if (glm::length(glm::cross(dvec3(origin - middle), dvec3(direction))) < 0.1) continue;
    ASSERT_FALSE(testInFloat(origin, direction, middle, v1, v2).hit) << "case " << k;
  }
}

TEST(ShaderOffset, BoundsHowFarAHitPointLiesOffItsPlane) {
  Draw draw(11);
  int hits = 0;
  for (int k = 0; k < 200000; ++k) {
    const std::array<vec3, 3> v = drawTriangle(draw, k);
    const auto point = hitPoint(draw, v, planeOf(v[0], v[1], v[2]));
    if (!point) continue;
    ++hits;
    const dvec3 normal = glm::normalize(glm::cross(dvec3(v[1]) - dvec3(v[0]), dvec3(v[2]) - dvec3(v[0])));
    ASSERT_LE(std::abs(glm::dot(normal, dvec3(*point) - dvec3(v[0]))), hitPointError(v)) << "case " << k;
  }
  EXPECT_GT(hits, 50000);
}

TEST(ShaderOffset, ARayNeverHitsTheTriangleItLeaves) {
  Draw draw(13);
  for (int k = 0; k < 400000; ++k) {
    const std::array<vec3, 3> v = drawTriangle(draw, k);
    const glm::vec4 plane = planeOf(v[0], v[1], v[2]);
    const vec3 normal(plane);
    const auto point = hitPoint(draw, v, plane);
    if (!point) continue;
    const float error = float(hitPointError(v));
    vec3 direction(draw.direction());
    // Half of the rays graze.
    const float graze = 1.0f - std::pow(10.0f, -float(k % 8));
    if (k % 2 == 1) direction = glm::normalize(direction - graze * glm::dot(direction, normal) * normal);
    const vec3 origin = glsl_float::offsetOrigin(*point, error, normal, direction);
    ASSERT_LE(distanceTo(v, origin, direction), 0.0f) << "case " << k;
    // It stays close: what is in contact stays in contact.
    ASSERT_LE(glm::distance(origin, *point), 1.1f * error);
  }
}

TEST(ShaderOffset, MovesToTheSideOfTheDirection) {
  const dvec3 normal(0, 0.6, 0.8);
  const dvec3 up = glsl_double::offsetOrigin(dvec3(1), 1e-3, normal, dvec3(0, 0, 1));
  const dvec3 down = glsl_double::offsetOrigin(dvec3(1), 1e-3, normal, dvec3(0, 0, -1));
  EXPECT_NEAR(glm::dot(up - dvec3(1), normal), 1e-3, 1e-15);
  EXPECT_NEAR(glm::dot(down - dvec3(1), normal), -1e-3, 1e-15);
}

}  // namespace
}  // namespace fragtrace
