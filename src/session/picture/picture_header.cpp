// SPDX-License-Identifier: MIT
#include "session/picture/picture_header.h"

#include <array>

#include "scene/projection.h"

namespace fragtrace {

namespace {

/// The four columns by which a row vector is multiplied, as rows of numbers.
std::vector<float> matrixOf(const std::array<glm::dvec4, 4>& columns) {
  std::vector<float> numbers;
  for (int row = 0; row < 4; ++row) {
    for (const glm::dvec4& column : columns) numbers.push_back(float(column[row]));
  }
  return numbers;
}

/// The coordinate of a point (x, y, z, 1) along an axis from an origin.
glm::dvec4 along(const glm::dvec3& axis, const glm::dvec3& origin) { return {axis, -glm::dot(axis, origin)}; }

}  // namespace

void setCamera(Image& image, const Camera& camera, glm::ivec2 size) {
  const Projection view = projectionOf(camera, double(size.x) / size.y);
  const glm::dvec4 right = along(glm::normalize(view.right), view.position);
  const glm::dvec4 up = along(glm::normalize(view.up), view.position);
  const glm::dvec4 depth = along(view.forward, view.position);
  const glm::dvec4 one(0.0, 0.0, 0.0, 1.0);
  const bool perspective = view.type == CameraType::Perspective;
  const glm::dvec4 w = perspective ? depth : one;
  const double halfWidth = glm::length(view.right);
  const double halfHeight = glm::length(view.up);
  image.numbers["worldToCamera"] = matrixOf({right, up, depth, one});
  if (!isRectilinear(view.type)) return;
  // The third coordinate only makes the matrix invertible: 1 - 1 / depth of a perspective, else the depth.
  image.numbers["worldToNDC"] =
      matrixOf({0.5 * (w + right / halfWidth - view.shift.x * w),
                0.5 * (w - up / halfHeight + view.shift.y * w), perspective ? depth - one : depth, w});
  if (perspective) image.numbers["screenWindowWidth"] = {float(2.0 * halfWidth)};
}

void setChromaticities(Image& image) {
  image.numbers["chromaticities"] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
}

}  // namespace fragtrace
