// SPDX-License-Identifier: MIT
#include "pack/literal_traversal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/text.h"
#include "pack/pack_faces.h"
#include "scene/hit_error.h"

namespace fragtrace {

namespace {

std::string number(double x) {
  std::string s = formatted("%.9g", double(float(x)));
  if (s.find_first_of(".e") == std::string::npos) s += ".0";
  return x < 0.0 ? "(" + s + ")" : s;
}

/// A number that is known by its name or by the name of its opposite, because negating would cost an
/// instruction.
struct Term {
  std::string name;
  bool negated = false;
};

/// The sum of products of terms and factors (an empty factor: the term alone), positive ones first.
std::string sumOf(std::vector<std::pair<Term, std::string>> products) {
  std::ranges::stable_sort(products, {}, [](const auto& p) { return p.first.negated; });
  std::string text;
  for (const auto& [term, factor] : products) {
    const char* sign = term.negated ? " - " : " + ";
    text += text.empty() ? (term.negated ? "-" : "") : sign;
    text += factor.empty() ? term.name : term.name + " * " + factor;
  }
  return text;
}

/// The rows turn a point into the sheared plane (x mirrored, so that fronts count as positive) and into the
/// distance along the ray; w is the origin's part. The plane is scaled by kLiteralScale, a power of two that
/// makes the mesh about one wide, so that products of areas and distances neither overflow nor underflow.
constexpr const char* kHead = R"(
vec4 literalRow(vec3 row, vec3 origin) { return vec4(row, -dot(row, origin)); }

Traversal traverseLiterals(vec3 origin, vec3 direction, Traversal s, bool anyHit) {
  RayShear r = makeShear(direction);
  float side = r.z < 0.0 ? -kLiteralScale : kLiteralScale;
  vec4 rx = literalRow(side * (r.axis == 0 ? vec3(-r.x, 1.0, 0.0) : (r.axis == 1 ? vec3(0.0, -r.x, 1.0) : vec3(1.0, 0.0, -r.x))), origin);
  vec4 ry = literalRow(kLiteralScale * (r.axis == 0 ? vec3(-r.y, 0.0, 1.0) : (r.axis == 1 ? vec3(1.0, -r.y, 0.0) : vec3(0.0, 1.0, -r.y))), origin);
  vec4 rz = literalRow(r.axis == 0 ? vec3(r.z, 0.0, 0.0) : (r.axis == 1 ? vec3(0.0, r.z, 0.0) : vec3(0.0, 0.0, r.z)), origin);
  float best = s.t;
  float bestSum = 1.0;
  vec2 weights = s.weights;
  float sum;
  float area;
  bool inFirst;
  float t;
  bool hit;
)";
constexpr const char* kWeightsTail = "  s.weights = weights / bestSum;\n";
constexpr const char* kWholeTail = "  s.node = kTraversalDone;\n";
constexpr const char* kNearestTail = "  s.t = best;\n  return s;\n}\n";
constexpr const char* kTail = R"(  if (!anyHit) s.t = best / bestSum;
  return s;
}
)";

class TraversalText {
 public:
  TraversalText(const LiteralMesh& mesh, const LiteralOptions& options)
      : mesh_(mesh),
        weights_(options.weights),
        passing_(options.passing),
        backFaces_(options.backFaces),
        single_(singleAxis()),
        size_(size()) {}

  std::string text(bool whole) {
    for (const LiteralFace& face : mesh_.faces) test(face);
    const int exponent = size_ > 0.0 ? std::ilogb(size_) : 0;
    const std::string scale = "const float kLiteralScale = " + number(std::ldexp(1.0, -exponent)) + ";\n";
    return scale + kHead + countText() + body_ + (weights_ ? kWeightsTail : "") + (whole ? kWholeTail : "") +
           (passing_ ? kNearestTail : kTail);
  }

 private:
  /// Counts the triangles that are tested.
  std::string countText() const {
    size_t triangles = 0;
    for (const LiteralFace& face : mesh_.faces) triangles += face.quad ? 2 : 1;
    return "  if (kCountWork) countWork(kWorkPrimitives, " + std::to_string(triangles) + "u);\n";
  }

  static constexpr const char* kAxes[3] = {".x", ".y", ".z"};

  /// The axis along which most points share both other coordinates; their part of the projection is computed
  /// once.
  int singleAxis() const {
    int best = 0;
    size_t fewest = SIZE_MAX;
    for (int axis = 0; axis < 3; ++axis) {
      std::set<std::pair<float, float>> pairs;
      for (const glm::vec3& p : mesh_.points) pairs.insert({p[(axis + 1) % 3], p[(axis + 2) % 3]});
      if (pairs.size() < fewest) best = axis;
      fewest = std::min(fewest, pairs.size());
    }
    return best;
  }

  double size() const {
    BoundsDouble box;
    for (const glm::vec3& p : mesh_.points) box.include(glm::dvec3(p));
    return glm::length(box.extent());
  }

  /// A variable that holds an expression. It is made where it is first needed, so that few are alive at a
  /// time.
  std::string variable(const std::string& expression) {
    const auto found = variables_.find(expression);
    if (found != variables_.end()) return found->second;
    std::string name = "v";
    name += std::to_string(variables_.size());
    body_ += "  float " + name + " = " + expression + ";\n";
    return variables_.emplace(expression, name).first->second;
  }

  static std::string product(double x, const std::string& row, int axis) {
    if (x == 0.0) return {};
    return x == 1.0 ? row + kAxes[axis] : number(x) + " * " + row + kAxes[axis];
  }

  static std::string added(const std::string& a, const std::string& b) {
    return a.empty() || b.empty() ? a + b : a + " + " + b;
  }

  /// The expression for the coordinate of a point along a row of the ray's shear.
  std::string place(const std::string& row, uint32_t point) {
    const glm::vec3& p = mesh_.points[point];
    const int a = (single_ + 1) % 3;
    const int b = (single_ + 2) % 3;
    const std::string pair = added(product(p[a], row, a), product(p[b], row, b));
    const std::string rest = variable(added(product(p[single_], row, single_), row + ".w"));
    return pair.empty() ? rest : variable(variable(pair) + " + " + rest);
  }

  /// Twice the distance along the ray from one point to another; parallel sides of faces share it.
  Term twiceApart(uint32_t from, uint32_t to) {
    glm::dvec3 d = 2.0 * (glm::dvec3(mesh_.points[to]) - glm::dvec3(mesh_.points[from]));
    const bool negated = d.x < 0.0 || (d.x == 0.0 && (d.y < 0.0 || (d.y == 0.0 && d.z < 0.0)));
    if (negated) d = -d;
    std::string text;
    for (int axis = 0; axis < 3; ++axis) text = added(text, product(d[axis], "rz", axis));
    return {text.empty() ? "0.0" : variable(text), negated};
  }

  /// The edge function from one corner to another, x_i y_j - y_i x_j, made once for both directions.
  Term edge(uint32_t i, uint32_t j) {
    const uint32_t low = std::min(i, j);
    const uint32_t high = std::max(i, j);
    const std::string xi = place("rx", low);
    const std::string yi = place("ry", low);
    const std::string xj = place("rx", high);
    const std::string yj = place("ry", high);
    return {variable(xi + " * " + yj + " - " + yi + " * " + xj), i > j};
  }

  /// Returns true if the face is so small beside the mesh, or the sides at a corner so close together, that
  /// the edge functions are only rounding for rays that pass far away (docs/design/numerics.md, "Zero from
  /// far away").
  bool isTiny(const LiteralFace& f) const {
    constexpr double kShare = 0x1p-18;
    constexpr double kSmall = 0x1p-10;
    const size_t corners = f.quad ? 4 : 3;
    double least = HUGE_VAL;
    double longest = 0.0;
    for (size_t i = 0; i < corners; ++i) {
      const glm::dvec3 corner(mesh_.points[f.corner[i]]);
      const glm::dvec3 a = glm::dvec3(mesh_.points[f.corner[(i + 1) % corners]]) - corner;
      const glm::dvec3 b = glm::dvec3(mesh_.points[f.corner[(i + corners - 1) % corners]]) - corner;
      least = std::min(least, glm::length(glm::cross(a, b)) / std::max(glm::length(a), glm::length(b)));
      longest = std::max(longest, glm::length(a));
    }
    return !(least >= kShare * size_) || longest < kSmall * size_;
  }

  /// A condition: all corners have one sign in a row, so the ray passes outside their box (zeroBeyond of
  /// shaders/intersect.glsl).
  std::string sameSigns(const std::string& row, const LiteralFace& f, size_t corners) {
    std::string text;
    for (size_t i = 0; i + 1 < corners; ++i)
      text +=
          (i > 0 ? " && " : "") + place(row, f.corner[i]) + " * " + place(row, f.corner[i + 1]) + " > 0.0";
    return text;
  }

  /// Returns true if distances are measured to the face's plane (shaders/intersect.glsl, distanceToPlane).
  bool isSliverFace(const LiteralFace& f) const {
    const auto at = [&](size_t i) { return mesh_.points[f.corner[i]]; };
    return isSliver({at(0), at(1), at(2)}) || (f.quad && isSliver({at(0), at(2), at(3)}));
  }

  /// The plane's distance is the better one if the cosine between ray and normal exceeds this
  /// (distanceToPlane).
  static double roughFacing(const std::array<glm::vec3, 3>& v) {
    const double largest = hitPointError(v) * 0x1p19;
    return 3.0 * largest / sliverLength(v);
  }

  /// A sum of products with the components of a vector.
  static std::string dotWith(const glm::dvec3& v, const std::string& vector) {
    std::string text;
    for (int axis = 0; axis < 3; ++axis) text = added(text, product(v[axis], vector, axis));
    return text;
  }

  /// The distance to the face's plane replaces t over sum where it is the better one (shaders/intersect.glsl,
  /// distanceToPlane). `area` keeps the sum of the edges.
  void planeDistance(const LiteralFace& f) {
    const auto at = [&](size_t i) { return mesh_.points[f.corner[i]]; };
    const glm::dvec4 plane(planeOf(at(0), at(1), at(2)));
    std::string nearest = place("rz", f.corner[0]);
    std::string farthest = nearest;
    for (size_t i = 1; i < (f.quad ? 4 : 3); ++i) {
      const std::string z = place("rz", f.corner[i]);
      nearest.insert(0, "min(").append(", ").append(z).append(")");
      farthest.insert(0, "max(").append(", ").append(z).append(")");
    }
    nearest = variable(nearest);
    farthest = variable(farthest);
    double rough = roughFacing({at(0), at(1), at(2)});
    if (f.quad) rough = std::min(rough, roughFacing({at(0), at(2), at(3)}));
    const std::string facing = variable(dotWith(-glm::dvec3(plane), "direction"));
    body_ += "  area = sum;\n  if (t <= 0.015625 * sum * (" + farthest + " - " + nearest + ") || abs(" +
             facing + ") > " + number(rough) + ") {\n";
    body_ += "    sum = " + facing + ";\n";
    body_ += "    t = " + added(dotWith(glm::dvec3(plane), "origin"), number(-plane.w)) + ";\n";
    body_ += "    t = sum < 0.0 ? -t : t;\n    sum = abs(sum);\n";
    body_ += "    t = max(sum * " + nearest + ", min(t, sum * " + farthest + "));\n  }\n";
  }

  static Term times(const Term& a, bool negated) { return {a.name, a.negated != negated}; }

  void test(const LiteralFace& f) {
    const size_t corners = f.quad ? 4 : 3;
    std::vector<Term> e;
    std::vector<std::pair<Term, std::string>> all;
    std::string positive;
    std::string negative;
    for (size_t i = 0; i < corners; ++i) {
      e.push_back(edge(f.corner[(i + 1) % corners], f.corner[i]));
      all.push_back({e[i], ""});
      positive += e[i].name + (e[i].negated ? " <= 0.0 && " : " >= 0.0 && ");
      negative += e[i].name + (e[i].negated ? " >= 0.0 && " : " <= 0.0 && ");
    }
    const std::string z0 = place("rz", f.corner[0]);
    std::string t;
    if (f.parallelogram) {
      // The first corner's two sides lead away from it: edge 3 grows along side 0, edge 0 along side 3.
      const Term along = twiceApart(f.corner[0], f.corner[1]);
      const Term up = twiceApart(f.corner[0], f.corner[3]);
      t = sumOf({{{z0, false}, "sum"},
                 {times(e[3], along.negated), along.name},
                 {times(e[0], up.negated), up.name}});
    } else {
      // Corner i lies opposite of edge i + 1. A quadrilateral's plane is that of its first three corners.
      const Term last = f.quad ? edge(f.corner[0], f.corner[2]) : e[2];
      all = {{e[0], ""}, {e[1], ""}, {last, ""}};
      t = sumOf({{e[1], z0}, {last, place("rz", f.corner[1])}, {e[0], place("rz", f.corner[2])}});
    }
    body_ += "  sum = " + sumOf(all) + ";\n  t = " + t + ";\n";
    tellTriangle(f);
    const bool sliver = isSliverFace(f);
    if (f.culled) {
      // If all edges are zero, t is zero too, except where it is the plane's.
      const std::string front = positive + (sliver ? "sum > 0.0" : "t > 0.0");
      if (backFaces_) {
        // Light paths may hit back faces (Traversal.both of shaders/tree/state.glsl).
        body_ += "  hit = " + front + " || (kLightPaths && s.both && (" + negative + "sum < 0.0));\n";
        body_ += "  t = sum < 0.0 ? -t : t;\n  sum = abs(sum);\n  hit = hit && t > 0.0;\n";
      } else {
        body_ += "  hit = " + front + ";\n";
      }
    } else {
      body_ += "  hit = (" + positive + "sum > 0.0) || (" + negative + "sum < 0.0);\n";
      body_ += "  t = sum < 0.0 ? -t : t;\n  sum = abs(sum);\n";
    }
    if (sliver) planeDistance(f);
    if (sliver || !f.culled) body_ += "  hit = hit && t > 0.0;\n";
    const std::string weights = "abs(" + weightsOf(f, e) + (sliver ? " / area) * sum" : ")");
    keepNearest(f, weights);
  }

  /// The edge functions opposite to the second and third vertex of the triangle that is hit, as parts of the
  /// sum of all edges; their signs are not settled. `inFirst` tells which of a parallelogram's two triangles
  /// is hit.
  std::string weightsOf(const LiteralFace& f, const std::vector<Term>& e) {
    if (!f.quad) return "vec2(" + e[2].name + ", " + e[0].name + ")";
    if (!weights_) return {};
    const std::string diagonal = edge(f.corner[0], f.corner[2]).name;
    const std::array<std::string, 3> ofFirst{e[1].name, diagonal, e[0].name};
    const std::array<std::string, 3> ofOther{e[3].name, diagonal, e[2].name};
    const auto vertex = [](const std::array<std::string, 3>& corners, uint32_t first, uint32_t i) {
      return corners[(i + 3 - first) % 3];
    };
    std::string text;
    for (const uint32_t i : {1u, 2u}) {
      text += (i == 1 ? "" : ", ");
      text += "inFirst ? " + vertex(ofFirst, f.first, i) + " : " + vertex(ofOther, f.otherFirst, i);
    }
    return "(2.0 * vec2(" + text + "))";
  }

  /// Decides which of both triangles a line meets that meets the parallelogram.
  void tellTriangle(const LiteralFace& f) {
    if (!f.quad || !weights_) return;
    const Term diagonal = edge(f.corner[0], f.corner[2]);
    body_ +=
        "  inFirst = (" + diagonal.name + (diagonal.negated ? " <= 0.0" : " >= 0.0") + ") == (sum >= 0.0);\n";
  }

  /// A hit at t over sum replaces the best one if it is nearer; `weights` over sum are the barycentric
  /// weights.
  void keepNearest(const LiteralFace& f, const std::string& weights) {
    if (isTiny(f)) {
      for (const std::string row : {"rx", "ry"})
        body_ += "  hit = hit && !(" + sameSigns(row, f, f.quad ? 4 : 3) + ");\n";
    }
    std::string slot = std::to_string(f.slot);
    if (f.quad && weights_) slot = "(inFirst ? " + slot + " : " + std::to_string(f.otherSlot) + ")";
    if (passing_) {
      body_ += "  s.t = best;\n  hit = hit && isNearer(s, t / sum, " + slot + ");\n";
      body_ += "  best = hit ? t / sum : best;\n";
      if (weights_) body_ += "  weights = hit ? " + weights + " / sum : weights;\n";
    } else {
      body_ += "  hit = hit && t * bestSum < best * sum;\n";
      body_ += "  if (!anyHit) {\n    best = hit ? t : best;\n    bestSum = hit ? sum : bestSum;\n  }\n";
      if (weights_) body_ += "  weights = hit ? " + weights + " : weights;\n";
    }
    body_ += "  s.slot = hit ? " + slot + " : s.slot;\n";
  }

  const LiteralMesh& mesh_;
  bool weights_;
  bool passing_;
  bool backFaces_;
  int single_;
  double size_;  // size of the mesh, metres
  std::map<std::string, std::string> variables_;
  std::string body_;
};

}  // namespace

std::string literalTraversal(const LiteralMesh& mesh, const LiteralOptions& options) {
  return TraversalText(mesh, options).text(options.whole);
}

}  // namespace fragtrace
