// SPDX-License-Identifier: MIT
#include "image/compare/difference.h"

#include <cmath>
#include <limits>

#include "base/errors.h"
#include "image/channels.h"

namespace fragtrace {

namespace {

std::string sizeText(const Image& image) {
  return std::to_string(image.width) + " x " + std::to_string(image.height);
}

constexpr std::array<std::string_view, 7> kMetricNames{"rmse", "mse",  "relmse", "psnr",
                                                       "max",  "flip", "bias"};
constexpr std::array kMeanings{
    "root of the mean squared difference of the values; 0 is equal, smaller is better",
    "mean squared difference of the values; 0 is equal, smaller is better",
    "mean squared difference relative to the reference; 0 is equal, smaller is better",
    "peak signal to noise ratio in dB, for a peak of 1; inf is equal, larger is better",
    "largest difference of a value; 0 is equal, smaller is better",
    "mean difference as seen on a display, from 0, which is equal, to 1; smaller is better",
    "chance that pictures without bias differ as much; larger is better, and below 0.001 there is bias"};
static_assert(kMeanings.size() == kMetricNames.size());

}  // namespace

ColorReader colorReader(const Image& image, const char* which) {
  const auto channels = findColorChannels(image);
  if (!channels) throw RenderError(std::string("cannot compare: the ") + which + " has no colour channels");
  return {image, *channels};
}

size_t commonPixelCount(const Image& picture, const Image& reference) {
  if (picture.width != reference.width || picture.height != reference.height)
    throw RenderError("cannot compare: the sizes differ, " + sizeText(picture) + " against " +
                      sizeText(reference) + " pixels");
  return size_t(picture.width) * size_t(picture.height);
}

Difference compare(const Image& picture, const Image& reference) {
  const size_t pixelCount = commonPixelCount(picture, reference);
  const ColorReader a = colorReader(picture, "picture");
  const ColorReader b = colorReader(reference, "reference");
  const double count = 3.0 * double(pixelCount);

  double referenceSum = 0;
  for (size_t i = 0; i < pixelCount; ++i)
    for (size_t c = 0; c < 3; ++c) referenceSum += b(i, c);
  const double floor = 0.01 * (referenceSum / count) * (referenceSum / count);

  double squareSum = 0;
  double relativeSum = 0;
  double maximum = 0;
  for (size_t i = 0; i < pixelCount; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const double difference = std::abs(a(i, c) - b(i, c));
      const double square = difference * difference;
      squareSum += square;
      // A NaN is not equal to 0, so it passes into the sum; where the whole reference is black, x / 0 is
      // infinite.
      if (square != 0) relativeSum += square / (b(i, c) * b(i, c) + floor);
      // Comparisons with NaN are false, so a maximum that is NaN stays so.
      if (difference > maximum || std::isnan(difference)) maximum = difference;
    }
  }

  Difference result;
  result.mse = squareSum / count;
  result.rmse = std::sqrt(result.mse);
  result.relmse = relativeSum / count;
  result.psnr = 10 * std::log10(1 / result.mse);
  result.maximum = maximum;
  return result;
}

Image differenceImage(const Image& picture, const Image& reference) {
  const size_t pixelCount = commonPixelCount(picture, reference);
  const ColorReader a = colorReader(picture, "picture");
  const ColorReader b = colorReader(reference, "reference");
  Image result{picture.width, picture.height, {"R", "G", "B"}, {}, {}};
  result.values.reserve(pixelCount * 3);
  for (size_t i = 0; i < pixelCount; ++i)
    for (size_t c = 0; c < 3; ++c) result.values.push_back(float(std::abs(a(i, c) - b(i, c))));
  return result;
}

std::span<const std::string_view> metricNames() { return kMetricNames; }

const char* meaningOf(Metric metric) { return kMeanings[size_t(metric)]; }

double metricValue(const Difference& difference, Metric metric) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const std::array values{
      difference.rmse, difference.mse, difference.relmse, difference.psnr, difference.maximum, kNone, kNone};
  return values[size_t(metric)];
}

bool isWithin(Metric metric, double value, double threshold) {
  return metric == Metric::Psnr || metric == Metric::Bias ? value >= threshold : value <= threshold;
}

}  // namespace fragtrace
