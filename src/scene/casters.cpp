// SPDX-License-Identifier: MIT
#include "scene/casters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace fragtrace {

namespace {

/// Two balls replace one only if together they cover at most this share of its solid angle.
constexpr float kLeastSaving = 0.7f;

struct Group {
  std::vector<Ball> balls;
  Ball around;
};

Ball ballAround(const std::vector<Ball>& balls) {
  Bounds box;
  for (const Ball& b : balls) {
    box.include(b.middle - b.radius);
    box.include(b.middle + b.radius);
  }
  Ball around{box.center(), 0.0f};
  for (const Ball& b : balls)
    around.radius = std::max(around.radius, glm::distance(b.middle, around.middle) + b.radius);
  // This covers the rounding of sums in the shader.
  around.radius *= 1.0f + 1e-5f;
  return around;
}

Ball ballOfTriangle(const std::array<glm::vec3, 3>& corners) {
  Bounds box;
  for (const glm::vec3& c : corners) box.include(c);
  Ball ball{box.center(), 0.0f};
  for (const glm::vec3& c : corners) ball.radius = std::max(ball.radius, glm::distance(c, ball.middle));
  return ball;
}

/// The ball after a matrix, which stretches no direction by more than its norm.
Ball transformed(const Ball& ball, const glm::dmat4& matrix) {
  const glm::dmat3 turn(matrix);
  const double stretch =
      std::sqrt(glm::dot(turn[0], turn[0]) + glm::dot(turn[1], turn[1]) + glm::dot(turn[2], turn[2]));
  return {glm::vec3(matrix * glm::dvec4(ball.middle, 1.0)), float(double(ball.radius) * stretch)};
}

std::vector<Ball> ballsOfTriangles(const Scene& scene, size_t first, size_t count) {
  std::vector<Ball> balls;
  for (size_t i = first; i < first + count; ++i) {
    const Triangle& t = scene.triangles[i];
    if (castsCaustics(scene.materials[t.material])) balls.push_back(ballOfTriangle(cornersOf(scene, t)));
  }
  return balls;
}

std::vector<Ball> allBalls(const Scene& scene) {
  size_t shared = scene.triangles.size();
  for (const SharedMesh& mesh : scene.sharedMeshes) shared = std::min(shared, size_t(mesh.firstTriangle));
  std::vector<Ball> balls = ballsOfTriangles(scene, 0, shared);
  for (const Sphere& s : scene.spheres) {
    if (castsCaustics(scene.materials[s.material])) balls.push_back({s.center, s.radius});
  }
  std::vector<std::vector<Ball>> ofMeshes;
  for (const SharedMesh& mesh : scene.sharedMeshes)
    ofMeshes.push_back(ballsOfTriangles(scene, mesh.firstTriangle, mesh.triangleCount));
  for (const Instance& instance : scene.instances) {
    const std::vector<Ball>& own = ofMeshes[instance.mesh];
    if (!own.empty()) balls.push_back(transformed(ballAround(own), instance.toLocal));
  }
  return balls;
}

/// The squared radius of a ball around a box.
float ballSquared(const Bounds& box) {
  const glm::vec3 half = box.extent() * 0.5f;
  return glm::dot(half, half);
}

/// A plane across an axis that divides balls by their middles.
struct Cut {
  int axis = 0;
  float place = 0.0f;
  float squared = std::numeric_limits<float>::infinity();  ///< radii of balls round both boxes, squared
};

/// The best of the planes between equal slices of the box of the middles: the one whose sides have the
/// smallest balls.
Cut bestCut(const std::vector<Ball>& balls) {
  constexpr int kSlices = 16;
  Bounds middles;
  for (const Ball& b : balls) middles.include(b.middle);
  Cut best;
  for (int axis = 0; axis < 3; ++axis) {
    const float low = middles.minimum[axis];
    const float slice = middles.extent()[axis] / float(kSlices);
    if (slice <= 0.0f) continue;
    std::array<Bounds, kSlices> boxes;
    for (const Ball& b : balls) {
      Bounds& box = boxes[size_t(std::min(int((b.middle[axis] - low) / slice), kSlices - 1))];
      box.include(b.middle - b.radius);
      box.include(b.middle + b.radius);
    }
    std::array<Bounds, kSlices> above = boxes;
    for (size_t i = kSlices - 1; i-- > 0;) above[i].include(above[i + 1]);
    Bounds below;
    for (size_t i = 0; i + 1 < kSlices; ++i) {
      below.include(boxes[i]);
      const float squared = ballSquared(below) + ballSquared(above[i + 1]);
      if (squared < best.squared) best = {axis, low + slice * float(i + 1), squared};
    }
  }
  return best;
}

std::pair<Group, Group> halves(const Group& group) {
  const Cut cut = bestCut(group.balls);
  std::pair<Group, Group> parts;
  for (const Ball& b : group.balls)
    (b.middle[cut.axis] < cut.place ? parts.first : parts.second).balls.push_back(b);
  for (Group* part : {&parts.first, &parts.second}) {
    if (!part->balls.empty()) part->around = ballAround(part->balls);
  }
  return parts;
}

}  // namespace

bool castsCaustics(const Material& m) {
  if (m.scattersInside() || m.scattersThinly()) return false;
  if (m.unlit || m.layered() || m.specularGlossiness) return false;
  return m.mirrorLike() && !m.anisotropic() && (m.transmissive() || m.metallicFactor > 0.0f);
}

std::vector<Ball> casterBalls(const Scene& scene, size_t most) {
  std::vector<Ball> all = allBalls(scene);
  if (all.empty()) return {};
  std::vector<Group> groups{{std::move(all), {}}};
  groups[0].around = ballAround(groups[0].balls);
  // Groups are divided breadth first, so that the largest ones are divided before their number reaches the
  // limit.
  for (size_t i = 0, tried = 0; groups.size() < most && tried < groups.size();) {
    const auto [first, second] = halves(groups[i]);
    const float whole = groups[i].around.radius * groups[i].around.radius;
    const bool parts =
        !first.balls.empty() && !second.balls.empty() &&
        first.around.radius * first.around.radius + second.around.radius * second.around.radius <
            kLeastSaving * whole;
    if (parts) {
      groups[i] = first;
      groups.push_back(second);
      tried = 0;
    } else {
      ++tried;
      i = (i + 1) % groups.size();
    }
  }
  std::vector<Ball> balls;
  balls.reserve(groups.size());
  for (const Group& group : groups) balls.push_back(group.around);
  return balls;
}

}  // namespace fragtrace
