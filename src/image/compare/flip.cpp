// SPDX-License-Identifier: MIT
// The names of the paper's parameters are kept: q_c, p_c, p_t, w, q_f.
#include "image/compare/flip.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "base/errors.h"
#include "image/compare/difference.h"
#include "image/display/tone_map.h"

namespace fragtrace {
namespace {

// Colour spaces

/// Linear Rec.709 to CIE XYZ, from the primaries and the white point of ITU-R BT.709.
glm::dmat3 makeXyzOfRgb() {
  const auto ofChromaticity = [](double x, double y) { return glm::dvec3(x / y, 1, (1 - x - y) / y); };
  const glm::dmat3 primaries(ofChromaticity(0.64, 0.33), ofChromaticity(0.30, 0.60),
                             ofChromaticity(0.15, 0.06));
  const glm::dvec3 weights = glm::inverse(primaries) * ofChromaticity(0.3127, 0.3290);
  return {primaries[0] * weights[0], primaries[1] * weights[1], primaries[2] * weights[2]};
}

const glm::dmat3 kXyzOfRgb = makeXyzOfRgb();
const glm::dmat3 kRgbOfXyz = glm::inverse(kXyzOfRgb);
const glm::dvec3 kWhite = kXyzOfRgb * glm::dvec3(1);

/// The linear opponent space of the spatial filters: CIELAB without its cube root ("Spatial Filtering").
glm::dvec3 ycxczOfRgb(glm::dvec3 linear) {
  const glm::dvec3 v = kXyzOfRgb * linear / kWhite;
  return {116 * v.y - 16, 500 * (v.x - v.y), 200 * (v.y - v.z)};
}

glm::dvec3 rgbOfYcxcz(glm::dvec3 color) {
  const double y = (color.x + 16) / 116;
  return kRgbOfXyz * (glm::dvec3(y + color.y / 500, y, y - color.z / 200) * kWhite);
}

/// CIELAB (CIE 15:2004) whose chroma shrinks with lightness, after Hunt: a and b times 0.01 L ("Perceptually
/// Uniform Color Space").
glm::dvec3 huntLabOfRgb(glm::dvec3 linear) {
  const auto curve = [](double t) {
    constexpr double kDelta = 6.0 / 29;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const glm::dvec3 v = kXyzOfRgb * linear / kWhite;
  const double lightness = 116 * curve(v.y) - 16;
  const double a = 500 * (curve(v.x) - curve(v.y));
  const double b = 200 * (curve(v.y) - curve(v.z));
  return {lightness, 0.01 * lightness * a, 0.01 * lightness * b};
}

// Filters

/// A value per pixel, row by row.
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<double> values;

  Plane(int w, int h) : width(w), height(h), values(size_t(w) * size_t(h)) {}
  double* row(int y) { return values.data() + size_t(y) * size_t(width); }
  const double* row(int y) const { return values.data() + size_t(y) * size_t(width); }
};

/// 2 radius + 1 weights, the middle one at the pixel itself.
using Kernel = std::vector<double>;

template <typename Function>
Kernel makeKernel(int radius, Function weight) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(weight(double(i)));
  return kernel;
}

double sumOf(const Kernel& kernel) {
  double sum = 0;
  for (const double weight : kernel) sum += weight;
  return sum;
}

Kernel normalized(Kernel kernel) {
  const double sum = sumOf(kernel);
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

/// The weights above 0 sum to 1, those below to -1 ("Feature Detection").
Kernel balanced(Kernel kernel) {
  double positive = 0;
  double negative = 0;
  for (const double weight : kernel) (weight > 0 ? positive : negative) += std::abs(weight);
  for (double& weight : kernel) weight /= weight > 0 ? positive : negative;
  return kernel;
}

Plane filterRows(const Plane& in, const Kernel& kernel) {
  const auto radius = int(kernel.size() / 2);
  Plane out(in.width, in.height);
  std::vector<double> padded(size_t(in.width) + kernel.size() - 1);
  for (int y = 0; y < in.height; ++y) {
    for (size_t i = 0; i < padded.size(); ++i)
      padded[i] = in.row(y)[std::clamp(int(i) - radius, 0, in.width - 1)];
    double* to = out.row(y);
    for (size_t k = 0; k < kernel.size(); ++k)
      for (int x = 0; x < in.width; ++x) to[x] += kernel[k] * padded[size_t(x) + k];
  }
  return out;
}

Plane filterColumns(const Plane& in, const Kernel& kernel) {
  const auto radius = int(kernel.size() / 2);
  Plane out(in.width, in.height);
  for (int y = 0; y < in.height; ++y) {
    double* to = out.row(y);
    for (size_t k = 0; k < kernel.size(); ++k) {
      const double* from = in.row(std::clamp(y + int(k) - radius, 0, in.height - 1));
      for (int x = 0; x < in.width; ++x) to[x] += kernel[k] * from[x];
    }
  }
  return out;
}

/// Both kernels are symmetric or antisymmetric. The sign of an antisymmetric one does not matter here.
Plane filter(const Plane& in, const Kernel& horizontal, const Kernel& vertical) {
  return filterColumns(filterRows(in, horizontal), vertical);
}

// The colour pipeline

/// A contrast sensitivity function a exp(-b f^2), f in cycles per degree, is the filter
/// a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees; the paper's table 1.
struct Sensitivity {
  double a;
  double b;
};
constexpr Sensitivity kAchromatic{1, 0.0047};
constexpr Sensitivity kRedGreen{1, 0.0053};
constexpr Sensitivity kBlueYellowWide{34.1, 0.04};
constexpr Sensitivity kBlueYellowNarrow{13.5, 0.025};

/// Three standard deviations of the widest of the filters.
int sensitivityRadius(double pixelsPerDegree) {
  const double deviation = std::sqrt(kBlueYellowWide.b / (2 * std::numbers::pi * std::numbers::pi));
  return int(std::ceil(3 * deviation * pixelsPerDegree));
}

/// The part along one axis, 1 at the middle.
Kernel sensitivityKernel(const Sensitivity& s, double pixelsPerDegree) {
  return makeKernel(sensitivityRadius(pixelsPerDegree), [&](double i) {
    const double x = i / pixelsPerDegree;
    return std::exp(-std::numbers::pi * std::numbers::pi * x * x / s.b);
  });
}

Plane filterSensitivity(const Plane& in, const Sensitivity& s, double pixelsPerDegree) {
  const Kernel kernel = normalized(sensitivityKernel(s, pixelsPerDegree));
  return filter(in, kernel, kernel);
}

/// The sum of two filters, normalised as one.
Plane filterBlueYellow(const Plane& in, double pixelsPerDegree) {
  const auto volume = [&](const Sensitivity& s) {
    const double sum = sumOf(sensitivityKernel(s, pixelsPerDegree));
    return s.a * std::sqrt(std::numbers::pi / s.b) * sum * sum;
  };
  const double wide = volume(kBlueYellowWide);
  const double part = wide / (wide + volume(kBlueYellowNarrow));
  Plane out = filterSensitivity(in, kBlueYellowWide, pixelsPerDegree);
  const Plane narrow = filterSensitivity(in, kBlueYellowNarrow, pixelsPerDegree);
  for (size_t i = 0; i < out.values.size(); ++i)
    out.values[i] = part * out.values[i] + (1 - part) * narrow.values[i];
  return out;
}

struct Opponent {
  Plane y, cx, cz;
};

Opponent opponentOf(const ColorReader& read) {
  const int width = read.image.width;
  const int height = read.image.height;
  Opponent result{Plane(width, height), Plane(width, height), Plane(width, height)};
  for (size_t i = 0; i < result.y.values.size(); ++i) {
    glm::dvec3 linear;
    for (size_t c = 0; c < 3; ++c) linear[int(c)] = decodeSrgb(std::clamp(read(i, c), 0.0, 1.0));
    const glm::dvec3 color = ycxczOfRgb(linear);
    result.y.values[i] = color.x;
    result.cx.values[i] = color.y;
    result.cz.values[i] = color.z;
  }
  return result;
}

/// The picture as the eye perceives it, in the space in which colours are compared.
std::vector<glm::dvec3> perceivedColors(const Opponent& picture, double pixelsPerDegree) {
  const Plane y = filterSensitivity(picture.y, kAchromatic, pixelsPerDegree);
  const Plane cx = filterSensitivity(picture.cx, kRedGreen, pixelsPerDegree);
  const Plane cz = filterBlueYellow(picture.cz, pixelsPerDegree);
  std::vector<glm::dvec3> colors;
  colors.reserve(y.values.size());
  for (size_t i = 0; i < y.values.size(); ++i) {
    glm::dvec3 linear = rgbOfYcxcz({y.values[i], cx.values[i], cz.values[i]});
    for (int c = 0; c < 3; ++c) linear[c] = std::clamp(linear[c], 0.0, 1.0);
    colors.push_back(huntLabOfRgb(linear));
  }
  return colors;
}

/// HyAB (Abasi, Amani Tehrani and Fairchild, "Distance metrics for very large color differences", 2019) to
/// the power q_c ("Color Metric").
double colorDistance(glm::dvec3 a, glm::dvec3 b) {
  constexpr double kQc = 0.7;
  return std::pow(std::abs(a.x - b.x) + glm::distance(glm::dvec2(a.y, a.z), glm::dvec2(b.y, b.z)), kQc);
}

/// Maps a distance to 0..1: [0, p_c c_max] goes to [0, p_t], the rest of [0, c_max] to what is left; c_max is
/// the distance of green from blue, the largest that a display has ("Color Metric").
double redistribute(double distance) {
  constexpr double kPc = 0.4;
  constexpr double kPt = 0.95;
  static const double largest = colorDistance(huntLabOfRgb({0, 1, 0}), huntLabOfRgb({0, 0, 1}));
  const double knee = kPc * largest;
  if (distance >= knee) return kPt + (distance - knee) / (largest - knee) * (1 - kPt);
  return kPt / knee * distance;
}

// The feature pipeline

/// The strengths of edges and of points at every pixel.
struct Features {
  std::vector<double> edges;
  std::vector<double> points;
};

/// The lengths of the gradients (vertical and horizontal) of the lightness under derivatives of a Gaussian as
/// wide as w degrees, from inflection to inflection.
Features detectFeatures(Plane y, double pixelsPerDegree) {
  constexpr double kW = 0.082;
  const double deviation = 0.5 * kW * pixelsPerDegree;
  const auto radius = int(std::ceil(3 * deviation));
  const auto gauss = [&](double x) { return std::exp(-x * x / (2 * deviation * deviation)); };
  const Kernel smooth = normalized(makeKernel(radius, gauss));
  const Kernel first = balanced(makeKernel(radius, [&](double x) { return -x * gauss(x); }));
  const Kernel second = balanced(
      makeKernel(radius, [&](double x) { return (x * x / (deviation * deviation) - 1) * gauss(x); }));

  for (double& value : y.values) value = (value + 16) / 116;
  const auto lengths = [&](const Kernel& derivative) {
    const Plane along = filter(y, derivative, smooth);
    const Plane across = filter(y, smooth, derivative);
    std::vector<double> result;
    result.reserve(along.values.size());
    for (size_t i = 0; i < along.values.size(); ++i)
      result.push_back(std::hypot(along.values[i], across.values[i]));
    return result;
  };
  return {lengths(first), lengths(second)};
}

/// Returns the difference to the power q_f, in 0..1 ("Feature Metric").
double featureDifference(const Features& a, const Features& b, size_t i) {
  const double difference = std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i]));
  return std::sqrt(difference / std::numbers::sqrt2);  // q_f = 0.5
}

}  // namespace

FlipError flipError(const Image& picture, const Image& reference, double pixelsPerDegree) {
  if (!(pixelsPerDegree >= 1 && pixelsPerDegree <= 1000))
    throw RenderError("cannot compare: the pixels per degree must be from 1 to 1000");
  const size_t pixelCount = commonPixelCount(picture, reference);
  const Opponent a = opponentOf(colorReader(picture, "picture"));
  const Opponent b = opponentOf(colorReader(reference, "reference"));
  const std::vector<glm::dvec3> colorsA = perceivedColors(a, pixelsPerDegree);
  const std::vector<glm::dvec3> colorsB = perceivedColors(b, pixelsPerDegree);
  const Features featuresA = detectFeatures(a.y, pixelsPerDegree);
  const Features featuresB = detectFeatures(b.y, pixelsPerDegree);

  FlipError result{{picture.width, picture.height, {"Y"}, {}, {}}, 0};
  result.map.values.reserve(pixelCount);
  double sum = 0;
  for (size_t i = 0; i < pixelCount; ++i) {
    const double color = redistribute(colorDistance(colorsA[i], colorsB[i]));
    const double error = std::pow(color, 1 - featureDifference(featuresA, featuresB, i));
    sum += error;
    result.map.values.push_back(float(error));
  }
  result.mean = sum / double(pixelCount);
  return result;
}

}  // namespace fragtrace
