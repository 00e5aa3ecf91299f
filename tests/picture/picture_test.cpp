// SPDX-License-Identifier: MIT
// One picture test: renders through the real command line and compares with a reference EXR, noise taken into
// account. usage: picture_test NAME BACKEND FRAGTRACE SOURCE_FOLDER OUTPUT_FOLDER [OPTION...]
// The options go to `render`. References may be .pfm, too (bench/gpu/pack).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>

#include "image/compare/difference.h"
#include "image/image.h"
#include "osmesa.h"

namespace {

using fragtrace::Image;

/// Two-sided significance of the whole test; shared between the pixels (Bonferroni).
constexpr double kSignificance = 1e-3;
/// Bound on the bias of the picture's mean.
constexpr double kMeanBias = 0.005;
/// The largest difference of two renderers in float and double without any noise, relative to a pixel plus a
/// tenth of the picture's mean: texels are half floats (2^-12 = 2.4e-4).
constexpr double kRounding = 3e-4;
/// The noise of a picture may be so many times that of references.json: the square root of its relmse at its
/// fixed seed, which any change of what is drawn changes.
constexpr double kMoreNoise = 1.03;
constexpr int kBlocks[] = {1,
                           4};  // pixels per side: each pixel, and averages that show what is small and wide
constexpr int kOptions = 6;     // the first argument that is one

/// The z above which a normal variable lies with probability p on either side (bisection on erfc).
double normalQuantile(double p) {
  double low = 0.0;
  double high = 40.0;
  for (int i = 0; i < 200; ++i) {
    const double mid = 0.5 * (low + high);
    (std::erfc(mid / std::sqrt(2.0)) > p ? low : high) = mid;
  }
  return low;
}

double luminance(const float* p) { return 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]; }

/// Variance of a pixel's mean as the picture's last channel estimates it, but no less than the mean of its
/// neighbourhood: samples that all met the same surface say nothing of an edge that a few would have met.
double pixelVariance(const Image& picture, int x, int y) {
  double sum = 0.0;
  int count = 0;
  for (int ny = std::max(0, y - 1); ny <= std::min(picture.height - 1, y + 1); ++ny) {
    for (int nx = std::max(0, x - 1); nx <= std::min(picture.width - 1, x + 1); ++nx) {
      sum += picture.pixel(nx, ny)[picture.channelCount() - 1];
      ++count;
    }
  }
  return std::max(double(picture.pixel(x, y)[picture.channelCount() - 1]), sum / count);
}

struct Block {
  double difference = 0.0;
  double variance = 0.0;
  double magnitude = 0.0;  ///< sum of the reference's luminance
  int pixels = 0;
};

/// Mean difference of luminance and its variance, by blocks.
std::vector<Block> blocksOf(const Image& picture, const Image& reference, const Image& variance, int side) {
  const int columns = (picture.width + side - 1) / side;
  const int rows = (picture.height + side - 1) / side;
  std::vector<Block> blocks(size_t(columns) * size_t(rows));
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      Block& block = blocks[size_t(y / side) * size_t(columns) + size_t(x / side)];
      const float* v = variance.pixel(x, y);
      // Channels of one pixel are positively correlated, so this bounds the luminance's variance from above.
      const double spread = 0.2126 * std::sqrt(v[0]) + 0.7152 * std::sqrt(v[1]) + 0.0722 * std::sqrt(v[2]);
      block.difference += luminance(picture.pixel(x, y)) - luminance(reference.pixel(x, y));
      block.variance += pixelVariance(picture, x, y) + spread * spread;
      block.magnitude += luminance(reference.pixel(x, y));
      block.pixels += 1;
    }
  }
  return blocks;
}

double meanOf(const Image& image, size_t channel) {
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) sum += image.pixel(x, y)[channel];
  }
  return sum / (double(image.width) * image.height);
}

std::string quoted(const std::string& text) { return "'" + text + "'"; }

Image readReference(const std::filesystem::path& folder, const std::string& name) {
  const std::filesystem::path exr = folder / (name + ".exr");
  return fragtrace::readImage(std::filesystem::exists(exr) ? exr : folder / (name + ".pfm"));
}

/// The largest z of a block, and the block.
std::pair<double, size_t> worstOf(const std::vector<Block>& blocks, double mean) {
  std::pair<double, size_t> worst{0.0, 0};
  for (size_t i = 0; i < blocks.size(); ++i) {
    const Block& block = blocks[i];
    const double slack = kRounding * (block.magnitude + 0.1 * mean * block.pixels);
    const double z = std::max(0.0, std::abs(block.difference) - slack) / std::sqrt(block.variance + 1e-20);
    if (z > worst.first) worst = {z, i};
  }
  return worst;
}

bool meansAgree(const Image& a, const Image& b, double noise) {
  bool ok = true;
  for (size_t c = 0; c < 3; ++c) {
    const double bias = meanOf(a, c) - meanOf(b, c);
    ok = ok && std::abs(bias) <= std::max(kMeanBias * meanOf(b, c), noise);
    std::printf("mean %c: %.6g, reference %.6g, bias %.3f %%\n", "RGB"[c], meanOf(a, c), meanOf(b, c),
                100.0 * bias / std::max(1e-9, meanOf(b, c)));
  }
  return ok;
}

/// Returns true if the picture is no noisier than the row says. A row without a number is not judged.
bool isAsQuiet(const nlohmann::json& entry, double noise) {
  if (!entry.contains("noise")) return true;
  const double stored = entry["noise"]["value"];
  std::printf("noise: %.6g, %.4f times that of references.json (limit %.2f)\n", noise, noise / stored,
              kMoreNoise);
  if (noise <= kMoreNoise * stored) return true;
  std::printf("FAILED: noisier. If other random numbers are why: tests/reference/renew_noise.py\n");
  return false;
}

/// The arguments of the program that draw a row of references.json.
std::string renderWords(const nlohmann::json& entry, const std::string& output, const std::string& backend) {
  const int spp = entry.value("test_spp", entry["stage"] == "gi" ? 256 : 64);
  std::string words = " render scenes/" + entry["scene"].get<std::string>() + ".gltf -o " + quoted(output) +
                      " --quiet --stage " + entry["stage"].get<std::string>() + " --rendering-backend " +
                      backend + " --aov variance --spp " + std::to_string(spp) + " --resolution " +
                      std::to_string(entry["resolution"][0].get<int>()) + "," +
                      std::to_string(entry["resolution"][1].get<int>());
  for (const auto& option : entry["options"]) words.append(" ").append(quoted(option.get<std::string>()));
  return words;
}

int run(std::span<char*> argv) {
  const std::string name = argv[1];
  const std::string backend = argv[2];
  if (backend == "osmesa" && !fragtrace::hasOsMesa()) {
    std::printf("skipped: libOSMesa is not installed\n");
    return fragtrace::kSkipped;
  }
  const std::filesystem::path source = argv[4];
  const std::filesystem::path folder = argv[5];
  const std::filesystem::path references = source / "tests/reference";
  std::ifstream file(references / "references.json");
  const nlohmann::json list = nlohmann::json::parse(file)["references"];
  const auto entry = std::find_if(list.begin(), list.end(), [&](const auto& e) { return e["name"] == name; });
  if (entry == list.end()) {
    std::fprintf(stderr, "%s is not in references.json\n", name.c_str());
    return 1;
  }

  std::filesystem::create_directories(folder);
  const std::string base = (folder / (name + "." + backend)).string();
  std::string command = "cd " + quoted(source.string()) + " && " + quoted(argv[3]) +
                        renderWords(*entry, base + ".exr", backend);
  for (const char* option : argv.subspan(kOptions)) command.append(" ").append(quoted(option));
  std::printf("rerun: %s\n", command.c_str());
  if (std::system(command.c_str()) != 0) return 1;

  const std::string reference = entry->value("same_as", name);
  const Image a = fragtrace::readImage(base + ".exr");
  const Image b = readReference(references, reference);
  const Image variance = readReference(references, reference + ".variance");
  const fragtrace::Difference difference = fragtrace::compare(a, b);
  const double mean = std::max(1e-6, (meanOf(b, 0) + meanOf(b, 1) + meanOf(b, 2)) / 3.0);

  bool ok = true;
  double sumVariance = 0.0;
  for (const int side : kBlocks) {
    const std::vector<Block> blocks = blocksOf(a, b, variance, side);
    const double limit = normalQuantile(kSignificance / std::size(kBlocks) / double(blocks.size()));
    sumVariance = 0.0;
    for (const Block& block : blocks) sumVariance += block.variance;
    const auto [worst, worstBlock] = worstOf(blocks, mean);
    const int columns = (a.width + side - 1) / side;
    ok = ok && worst <= limit;
    std::printf("%s %s: rmse %.5g, blocks of %d x %d: worst z %.2f (limit %.2f) at pixel (%d, %d)\n",
                name.c_str(), backend.c_str(), difference.rmse, side, side, worst, limit,
                int(worstBlock) % columns * side, int(worstBlock) / columns * side);
  }
  const double meanNoise = 4.0 * std::sqrt(sumVariance) / (double(a.width) * a.height);
  ok = meansAgree(a, b, meanNoise) && ok;
  ok = isAsQuiet(*entry, std::sqrt(difference.relmse)) && ok;
  if (ok) return 0;
  fragtrace::writeImage(base + ".reference.exr", b);
  fragtrace::writeImage(base + ".difference.exr", fragtrace::differenceImage(a, b));
  std::printf(
      "FAILED: see %s.exr, .reference.exr and .difference.exr; to remake the reference: "
      "tests/reference/%s.py\n",
      base.c_str(), (*entry)["made_by"].get<std::string>().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < kOptions) return 2;
  try {
    return run({argv, size_t(argc)});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
