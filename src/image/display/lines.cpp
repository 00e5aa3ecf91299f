// SPDX-License-Identifier: MIT
#include "image/display/lines.h"

#include <algorithm>
#include <cmath>

namespace fragtrace {

namespace {

/// Cuts the part from begin to end of a line down to what lies within 0 and `size` on one axis (Liang and
/// Barsky, A New Concept and Method for Line Clipping, 1984). False when nothing is left.
bool clip(double from, double step, double size, double& begin, double& end) {
  if (step == 0.0) return from >= 0.0 && from <= size;
  const double a = -from / step;
  const double b = (size - from) / step;
  begin = std::max(begin, std::min(a, b));
  end = std::min(end, std::max(a, b));
  return begin <= end;
}

}  // namespace

void drawLine(Image& image, glm::dvec2 from, glm::dvec2 to, const glm::vec3& color) {
  const glm::dvec2 step = to - from;
  if (!std::isfinite(from.x + from.y + step.x + step.y)) return;
  double begin = 0.0;
  double end = 1.0;
  if (!clip(from.x, step.x, image.width, begin, end) || !clip(from.y, step.y, image.height, begin, end))
    return;
  const glm::dvec2 first = from + begin * step;
  const glm::dvec2 way = (end - begin) * step;
  // A pixel each step along the longer axis.
  const int count = std::max(1, int(std::ceil(std::max(std::abs(way.x), std::abs(way.y)))));
  const bool alpha = image.channelCount() > 3 && image.channels[3] == "A";
  for (int i = 0; i <= count; ++i) {
    const glm::dvec2 place = first + way * (double(i) / count);
    const int x = std::clamp(int(std::floor(place.x)), 0, image.width - 1);
    const int y = std::clamp(int(std::floor(place.y)), 0, image.height - 1);
    for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = color[c];
    if (alpha) image.pixel(x, y)[3] = 1.0f;
  }
}

}  // namespace fragtrace
