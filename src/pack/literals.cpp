// SPDX-License-Identifier: MIT
#include "pack/literals.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/text.h"
#include "pack/pack_tree.h"
#include "scene/hit_error.h"

namespace fragtrace {

namespace {

uint32_t pointIndex(std::vector<glm::vec3>& points, const glm::vec3& p) {
  const auto found = std::ranges::find(points, p);
  if (found != points.end()) return uint32_t(found - points.begin());
  points.push_back(p);
  return uint32_t(points.size() - 1);
}

glm::dvec3 pointAt(const LiteralFace& f, size_t corner, const std::vector<glm::vec3>& points) {
  return glm::dvec3(points[f.corner[corner % 4]]);
}

double largestCoordinate(const LiteralFace& f, const std::vector<glm::vec3>& points) {
  double largest = 0.0;
  for (size_t i = 0; i < 4; ++i) {
    const glm::dvec3 p = glm::abs(pointAt(f, i, points));
    largest = std::max({largest, p.x, p.y, p.z});
  }
  return largest;
}

/// The rounding error that corners may have, in parts of the largest coordinate.
constexpr double kTolerance = 0x1p-22;
/// The largest distance of the last corner from the others' plane, in parts of the least height of a corner
/// over the diagonal next to it. From directions so nearly edge-on that a larger distance shows, the
/// quadrilateral would not be convex.
constexpr double kBend = 0x1p-20;

bool isFlatAndConvex(const LiteralFace& f, const std::vector<glm::vec3>& points) {
  const auto at = [&](size_t i) { return pointAt(f, i, points); };
  const glm::dvec3 normal = glm::cross(at(2) - at(0), at(3) - at(1));
  if (glm::length(normal) <= 0.0) return false;
  const double off = glm::dot(glm::normalize(normal), at(3) - at(0) + at(1) - at(2));
  if (std::abs(off) > kTolerance * largestCoordinate(f, points)) return false;
  for (size_t i = 0; i < 4; ++i) {
    const glm::dvec3 turn = glm::cross(at(i + 1) - at(i), at(i + 2) - at(i + 1));
    if (glm::dot(normal, turn) <= 0.0) return false;
    if (std::abs(off) > kBend * glm::length(turn) / glm::length(at(i + 2) - at(i))) return false;
  }
  return true;
}

bool isParallelogram(const LiteralFace& f, const std::vector<glm::vec3>& points) {
  const auto at = [&](size_t i) { return pointAt(f, i, points); };
  return glm::length(at(0) - at(1) + at(2) - at(3)) <= kTolerance * largestCoordinate(f, points);
}

/// Joins two triangles that share an edge to a flat and convex quadrilateral.
std::optional<LiteralFace> joined(const LiteralFace& a, const LiteralFace& b, Joining joining,
                                  const std::vector<glm::vec3>& points) {
  for (uint32_t i = 0; i < 3; ++i) {
    for (uint32_t j = 0; j < 3; ++j) {
      // The first one's edge (i + 2, i) is the second one's (j + 1, j + 2) the other way round; j is the
      // corner opposite.
      if (a.corner[(i + 2) % 3] != b.corner[(j + 2) % 3] || a.corner[i] != b.corner[(j + 1) % 3]) continue;
      LiteralFace quad = a;
      quad.quad = true;
      quad.corner = {a.corner[i], a.corner[(i + 1) % 3], a.corner[(i + 2) % 3], b.corner[j]};
      if (!isFlatAndConvex(quad, points)) continue;
      quad.parallelogram = isParallelogram(quad, points);
      if (joining == Joining::Parallelograms && !quad.parallelogram) continue;
      quad.otherSlot = b.slot;
      quad.first = i;
      quad.otherFirst = (j + 2) % 3;
      return quad;
    }
  }
  return std::nullopt;
}

/// The leaves from `first` on; all of a tree in the order of its binary nodes, so that neighbours follow each
/// other.
std::vector<uint32_t> leavesFrom(const Bvh& bvh, uint32_t first) {
  std::vector<uint32_t> leaves;
  std::vector<uint32_t> open;
  if (first == 0 && !bvh.nodes.empty()) open.push_back(0);
  while (!open.empty()) {
    const uint32_t child = open.back();
    open.pop_back();
    if ((child & kBvhLeafBit) != 0) {
      leaves.push_back(child & ~kBvhLeafBit);
      continue;
    }
    // A lone leaf is both children of the root.
    const auto& [a, b] = bvh.nodes[child].child;
    if (a != b) open.push_back(b);
    open.push_back(a);
  }
  for (auto leaf = first + uint32_t(leaves.size()); leaf < bvh.leaves.size(); ++leaf) leaves.push_back(leaf);
  return leaves;
}

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
    return "  countPrimitivesTested(" + std::to_string(triangles) + "u);\n";
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

  /// Returns true if the face is so small compared with the mesh, or the sides at a corner so close together,
  /// that the edge functions are only rounding for rays that pass far away (docs/design/numerics.md, "Zero
  /// from far away").
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

/// Returns the text of traverseLiterals() of shaders/literals.glsl for this mesh: the test of Woop, Benthin
/// and Wald (shaders/intersect.glsl) of all its faces, unrolled. Points are projected once for all faces that
/// share them, and an edge function is computed once for both faces of its edge. So no ray passes between
/// neighbours, even if the compiler fuses operations.
std::string literalTraversal(const LiteralMesh& mesh, const LiteralOptions& options) {
  return TraversalText(mesh, options).text(options.whole);
}

std::string word(uint32_t x) { return formatted("0x%xu", x); }

/// An expression for values[index], by bisection. Equal values need no choice, and values that nobody asks
/// for may be anything.
std::string chosen(const std::string& index, const std::vector<std::optional<uint32_t>>& values, size_t from,
                   size_t to) {
  std::optional<uint32_t> only;
  bool same = true;
  for (size_t i = from; i < to; ++i) {
    if (!values[i]) continue;
    same = same && (!only || *only == *values[i]);
    only = values[i];
  }
  if (same) return word(only.value_or(0u));
  const size_t mid = (from + to) / 2;
  return "(" + index + " < " + std::to_string(mid) + " ? " + chosen(index, values, from, mid) + " : " +
         chosen(index, values, mid, to) + ")";
}

/// The row of the index-th entry of a buffer that holds `rows` rows per entry.
std::string chosenRow(const Words& words, const std::string& index, size_t count, size_t rows, size_t row,
                      const std::vector<bool>& used) {
  std::string text = "uvec4(";
  for (size_t c = 0; c < 4; ++c) {
    std::vector<std::optional<uint32_t>> values(count);
    for (size_t i = 0; i < count; ++i) {
      if (used.empty() || used[i]) values[i] = words[(i * rows + row) * 4 + c];
    }
    text += (c > 0 ? ", " : "") + chosen(index, values, 0, count);
  }
  return text + ")";
}

/// Writes a function of an entry and a row; callers pass a constant row.
std::string rowFunction(const std::string& head, const std::string& index, const Words& words, size_t count,
                        size_t rows, const std::vector<bool>& used = {}) {
  std::string text = head + " {\n";
  for (size_t row = 0; row + 1 < rows; ++row)
    text += "  if (row == " + std::to_string(row) + ") return " +
            chosenRow(words, index, count, rows, row, used) + ";\n";
  return text + "  return " + chosenRow(words, index, count, rows, rows - 1, used) + ";\n}\n";
}

constexpr const char* kNoRows = R"(
uvec4 literalFace(int slot, int row) { return uvec4(0u); }
uvec4 literalInset(int slot, int row) { return uvec4(0u); }
uvec4 literalMaterial(uint material, uint row) { return uvec4(0u); }
uvec4 literalEmitter(int emitter, int row) { return uvec4(0u); }
)";

// Instructions for eight rays, counted on llvmpipe: a face with its part of the points and edges, a visit of
// a node or a leaf. Rays in lockstep wait for the longest of them.
constexpr double kFace = 55.0;
constexpr double kVisit = 380.0;
constexpr double kLockstep = 1.6;
// Measured on the same machine with two cores: the time saved in the Cornell box over the instructions above,
// and the time by which a face makes compilation longer.
constexpr double kNanosecondsAnInstruction = 0.25;
constexpr double kCompilationOfAFace = 4e6;  // nanoseconds
constexpr double kRaysAPath = 7.0;

/// Both triangles of a parallelogram have the same formula for barycentric weights.
Joining joiningFor(bool weights) { return weights ? Joining::Parallelograms : Joining::ConvexQuadrilaterals; }

/// The light tree needs the triangles of a lamp apart.
bool partsLamps(const ShaderVariant& variant) { return has(variant.traits, Trait::LightTree); }

LiteralOptions optionsOf(const ShaderVariant& variant, bool whole) {
  return {.weights = keepsWeights(variant),
          .whole = whole,
          .passing = passesSurfaces(variant) || testsAlpha(variant),
          .backFaces = has(variant.traits, Trait::Caustics)};
}

}  // namespace

LiteralMesh literalMesh(const Scene& scene, const Bvh& bvh, uint32_t firstLeaf, Joining joining,
                        bool emissiveApart) {
  LiteralMesh mesh;
  std::vector<uint32_t> materials;
  for (const uint32_t leaf : leavesFrom(bvh, firstLeaf)) {
    for (uint32_t side = 0; side < 2; ++side) {
      const uint32_t primitive = bvh.leaves[leaf].primitive[side];
      if (primitive == kMissIndex) continue;
      const Triangle& t = scene.triangles[primitive];
      const Material& m = scene.materials[t.material];
      LiteralFace face;
      for (int i = 0; i < 3; ++i)
        face.corner[size_t(i)] = pointIndex(mesh.points, scene.vertices.position[t.vertex[i]]);
      face.culled = m.culled();
      face.slot = leaf * 2 + side;
      const bool alone = joining == Joining::None || (emissiveApart && m.emissive());
      bool taken = false;
      for (size_t i = 0; !alone && !taken && i < mesh.faces.size(); ++i) {
        if (mesh.faces[i].quad || materials[i] != t.material) continue;
        const std::optional<LiteralFace> quad = joined(mesh.faces[i], face, joining, mesh.points);
        if (quad) mesh.faces[i] = *quad;
        taken = quad.has_value();
      }
      if (taken) continue;
      mesh.faces.push_back(face);
      materials.push_back(t.material);
    }
  }
  return mesh;
}

std::string whyNoLiterals(const Scene& scene, const GpuScene& packed) {
  constexpr size_t kMostTriangles = 256;
  constexpr size_t kMostMaterials = 16;
  constexpr size_t kMostEmitters = 16;
  const auto tooMany = [](size_t count, size_t most, const char* what) {
    return count <= most
               ? std::string()
               : std::to_string(count) + " " + what + ", at most " + std::to_string(most) + " can be";
  };
  if (!scene.spheres.empty()) return "the scene has spheres";
  if (std::ranges::count(packed.cutOut, false) == 0 && scene.triangles.size() == packed.cutOut.size())
    return "the scene has no triangle";
  if (!scene.instances.empty()) return "the scene shares meshes";
  if (std::ranges::any_of(scene.triangles, [](const Triangle& t) { return t.reach > 0; }))
    return "surfaces of the scene coincide";
  std::string reason = tooMany(scene.triangles.size(), kMostTriangles, "triangles");
  if (reason.empty()) reason = tooMany(scene.materials.size(), kMostMaterials, "materials");
  if (reason.empty()) reason = tooMany(packed.emitterCount, kMostEmitters, "emitters");
  return reason;
}

bool paysAsLiterals(const Scene& scene, const Bvh& bvh, const GpuScene& packed, double paths) {
  if (!whyNoLiterals(scene, packed).empty()) return false;
  const Bvh drawn = pruned(bvh, packed.cutOut);
  const double faces = double(literalMesh(scene, drawn, 0, Joining::None).faces.size());
  const double saved = bvhQuality(drawn).sahCost * kLockstep * kVisit - faces * kFace;
  return paths * kRaysAPath * saved / 8.0 * kNanosecondsAnInstruction > faces * kCompilationOfAFace;
}

bool paysBeside(const Bvh& tree, const Bvh& beside) {
  const double faces = 2.0 * beside.besideTree;
  return faces * kFace < (bvhQuality(tree).sahCost - bvhQuality(beside).sahCost) * kLockstep * kVisit;
}

std::string largeFirst(const Scene& scene, const Bvh& bvh, const ShaderVariant& variant) {
  const bool weights = keepsWeights(variant);
  const LiteralMesh mesh = literalMesh(scene, bvh, uint32_t(bvh.leaves.size()) - bvh.besideTree,
                                       joiningFor(weights), partsLamps(variant));
  return "const bool kLiterals = false;\nconst bool kLargeFirst = true;\n" +
         literalTraversal(mesh, optionsOf(variant, false)) + kNoRows;
}

std::string literalScene(const Scene& scene, const Bvh& bvh, const GpuScene& packed,
                         const ShaderVariant& variant) {
  const bool weights = keepsWeights(variant);
  const LiteralMesh mesh =
      literalMesh(scene, pruned(bvh, packed.cutOut), 0, joiningFor(weights), partsLamps(variant));
  const size_t slots = bvh.leaves.size() * 2;
  std::vector<bool> used(slots, false);
  for (const LiteralFace& face : mesh.faces) {
    used[face.slot] = true;
    if (weights && face.quad) used[face.otherSlot] = true;
  }
  Words faces = packed.buffers[layout::kFacesBinding];
  for (size_t slot = 0; slot < slots && !weights; ++slot) {
    // Vertices are read by their index only where they have attributes.
    for (size_t c = 1; c < 4; ++c) faces[(slot * layout::kFaceRows + 1) * 4 + c] = 0u;
  }
  std::string text = "const bool kLiterals = true;\nconst bool kLargeFirst = false;\n";
  text += literalTraversal(mesh, optionsOf(variant, true));
  text += rowFunction("uvec4 literalFace(int slot, int row)", "slot", faces, slots, layout::kFaceRows, used);
  if (has(variant.traits, Trait::Creases)) {
    const Words insets(faces.begin() + ptrdiff_t(slots * layout::kFaceRows * 4), faces.end());
    text += rowFunction("uvec4 literalInset(int slot, int row)", "slot", insets, slots, 1, used);
  } else {
    text += "uvec4 literalInset(int slot, int row) { return uvec4(0u); }\n";
  }
  text +=
      rowFunction("uvec4 literalMaterial(uint material, uint row)", "material",
                  packed.buffers[layout::kMaterialsBinding], scene.materials.size(), layout::kMaterialRows);
  if (packed.emitterCount > 0) {
    text += rowFunction("uvec4 literalEmitter(int emitter, int row)", "emitter",
                        packed.buffers[layout::kEmittersBinding], packed.emitterCount, layout::kEmitterRows);
  } else {
    text += "uvec4 literalEmitter(int emitter, int row) { return uvec4(0u); }\n";
  }
  return text;
}

}  // namespace fragtrace
