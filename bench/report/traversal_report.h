// SPDX-License-Identifier: MIT
// What `bench traversal` measured.
#pragma once

#include <string>
#include <vector>

namespace fragtrace {

/// One kind of rays.
struct TraversalRow {
  std::string kind;
  size_t rays = 0;
  size_t hits = 0;
  std::vector<double> ms;   ///< one a round
  size_t wrong = 0;         ///< rays whose hit is not that of double precision
  size_t wrongAllowed = 0;  ///< as ties at edges may come out
  size_t provedByAll =
      0;  ///< rays on which double precision by the tree was itself held against all primitives

  double megaRaysPerSecond() const;  ///< of the median round; 0 without any
};

struct TraversalReport {
  std::string scene;
  size_t triangles = 0;
  size_t spheres = 0;
  int width = 0;  ///< of the field of rays
  int height = 0;
  std::string renderer;  ///< of OpenGL
  std::string variant;
  std::string clock;  ///< "wall clock": round glFinish; "gpu timer"
  double sahCost = 0.0;
  double gpuBytesPerTriangle = 0.0;
  std::vector<TraversalRow> rows;
};

std::string traversalTable(const TraversalReport& report);
/// One line of JSON a kind of rays.
std::string traversalJson(const TraversalReport& report);

}  // namespace fragtrace
