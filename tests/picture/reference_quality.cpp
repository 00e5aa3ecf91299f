// SPDX-License-Identifier: MIT
// Tests whether the stored references are good enough to judge by: the standard error of every one that
// Mitsuba rendered, relative to the picture's mean, is bounded in the median pixel and in every block. And
// whether every row holds the noise of our own picture. usage: reference_quality FOLDER
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "image/image.h"

namespace {

using fragtrace::Image;

constexpr double kMedianBound = 0.003;
constexpr double kBlockBound = 0.01;
constexpr int kBlock = 8;

double meanOf(const Image& image) {
  double sum = 0.0;
  for (const float value : image.values) sum += value;
  return sum / double(image.values.size());
}

double medianError(const Image& variance) {
  std::vector<float> values = variance.values;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return std::sqrt(*middle);
}

/// The largest standard error of a block's mean, in any channel; pixels are independent.
double worstBlockError(const Image& variance) {
  double worst = 0.0;
  for (int top = 0; top < variance.height; top += kBlock) {
    for (int left = 0; left < variance.width; left += kBlock) {
      const int bottom = std::min(top + kBlock, variance.height);
      const int right = std::min(left + kBlock, variance.width);
      for (int c = 0; c < 3; ++c) {
        double sum = 0.0;
        for (int y = top; y < bottom; ++y) {
          for (int x = left; x < right; ++x) sum += variance.pixel(x, y)[c];
        }
        worst = std::max(worst, std::sqrt(sum) / ((bottom - top) * (right - left)));
      }
    }
  }
  return worst;
}

bool goodEnough(const std::filesystem::path& folder, const std::string& name) {
  const double mean = meanOf(fragtrace::readImage(folder / (name + ".exr")));
  const Image variance = fragtrace::readImage(folder / (name + ".variance.exr"));
  const double median = medianError(variance) / mean;
  const double block = worstBlockError(variance) / mean;
  const bool good = median < kMedianBound && block < kBlockBound;
  std::printf("%-32s standard error / mean: median %.3f %%, worst block %.2f %%%s\n", name.c_str(),
              100.0 * median, 100.0 * block,
              good ? "" : "  TOO NOISY: raise spp in references.json and rerun render_mitsuba.py");
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    const std::filesystem::path folder = argv[1];
    std::ifstream file(folder / "references.json");
    const nlohmann::json list = nlohmann::json::parse(file)["references"];
    bool good = true;
    for (const auto& entry : list) {
      const bool rendered = entry["made_by"] == "render_mitsuba" && !entry.contains("same_as");
      if (rendered) good = goodEnough(folder, entry["name"]) && good;
      if (entry.contains("noise")) continue;
      std::printf("%s has no noise: tests/reference/renew_noise.py\n",
                  entry["name"].get<std::string>().c_str());
      good = false;
    }
    return good ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
