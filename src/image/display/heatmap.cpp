// SPDX-License-Identifier: MIT
#include "image/display/heatmap.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.h"

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

using Color = std::array<float, 3>;

Color heatColor(double x) {
  const double h = 4.0 * std::clamp(x, 0.0, 1.0);
  const auto ramp = [](double v) { return float(std::clamp(v, 0.0, 1.0)); };
  return {ramp(h - 2.0), ramp(std::min(h, 4.0 - h)), ramp(2.0 - h) * float(0.25 + 0.75 * std::min(h, 1.0))};
}

/// Digits and the point, 3 x 5 cells, a row an octal digit from the top.
constexpr std::array<unsigned, 11> kGlyphs = {075557, 026227, 071747, 071717, 055711, 074717,
                                              074757, 071111, 075757, 075717, 000002};

/// number: digits, and a point at most.
void drawNumber(Image& image, const std::string& number, int left, int top, int scale) {
  for (size_t i = 0; i < number.size(); ++i) {
    const unsigned rows = number[i] == '.' ? kGlyphs[10] : kGlyphs[size_t(number[i] - '0')];
    for (int y = 0; y < 5 * scale; ++y) {
      for (int x = 0; x < 3 * scale; ++x) {
        const unsigned bit = (rows >> (3 * (4 - y / scale))) >> (2 - x / scale) & 1u;
        const int px = left + int(i) * 4 * scale + x;
        const int py = top + y;
        if (bit == 0 || px < 0 || px >= image.width || py < 0 || py >= image.height) continue;
        std::fill_n(image.pixel(px, py), 3, 1.0f);
      }
    }
  }
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

double heatmapLimit(const Image& counts) {
  std::vector<float> sorted;
  for (int y = 0; y < counts.height; ++y) {
    for (int x = 0; x < counts.width; ++x) sorted.push_back(*counts.pixel(x, y));
  }
  if (sorted.empty()) return 1.0;
  const size_t rank = std::min(sorted.size() - 1, size_t(0.995 * double(sorted.size())));
  std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(rank), sorted.end());
  const double value = std::max(1.0, double(sorted[rank]));
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (double step : {1.0, 2.0, 4.0, 5.0, 8.0}) {
    if (value <= step * power) return step * power;
  }
  return 10.0 * power;
}

Image paintHeatmap(const Image& counts, const std::string& countsAs) {
  const double limit = heatmapLimit(counts);
  Image image;
  image.width = counts.width;
  image.height = counts.height;
  image.channels = {"R", "G", "B"};
  if (!countsAs.empty()) image.channels.push_back(countsAs);
  image.values.resize(size_t(image.width) * size_t(image.height) * image.channelCount());
  const int scale = std::max(1, image.height / 180);
  const int barTop = image.height - 4 * scale;
  const int textTop = barTop - 7 * scale;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float visits = *counts.pixel(x, y);
      const bool bar = y >= barTop;
      Color color = heatColor(bar ? (x + 0.5) / image.width : visits / limit);
      if (!bar && y >= textTop - scale) color = {0.0f, 0.0f, 0.0f};
      float* pixel = image.pixel(x, y);
      std::copy(color.begin(), color.end(), pixel);
      if (!countsAs.empty()) pixel[3] = visits;
    }
  }
  for (int part = 0; part <= 4; ++part) {
    const std::string number = formatted("%.12g", limit * part / 4.0);
    const int width = int(number.size()) * 4 * scale;
    drawNumber(image, number, std::clamp(image.width * part / 4 - width / 2, scale, image.width - width),
               textTop, scale);
  }
  return image;
}

}  // namespace fragtrace
