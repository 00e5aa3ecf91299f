// SPDX-License-Identifier: MIT
#include "scene/volume/read_grid.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <ranges>
#include <stdexcept>

#include <glm/gtc/packing.hpp>

#include "advice.h"
#include "base/errors.h"
#include "base/message.h"
#include "base/worker.h"
#include "image/files/whole_file.h"
#include "scene/volume/decode.h"

namespace fragtrace {

namespace {

/// One lobe of the fit; wavelengths in nanometres.
double lobe(double wavelength, double middle, double below, double above) {
  const double t = (wavelength - middle) * (wavelength < middle ? below : above);
  return std::exp(-0.5 * t * t);
}

/// Spectral radiance, W / (m^2 sr m).
double planck(double wavelength, double temperature) {
  constexpr double kFirst = 1.191042972e-16;  // 2 h c^2
  constexpr double kSecond = 1.438776877e-2;  // h c / k
  return kFirst / (std::pow(wavelength, 5.0) * std::expm1(kSecond / (wavelength * temperature)));
}

/// Radiance of a black body (Planck) as linear sRGB whose luminance is in cd/m^2; colours outside of sRGB are
/// clamped. By the fit of the CIE's 1931 observer of Wyman, Sloan and Shirley (Simple Analytic Approximations
/// to the CIE XYZ Color Matching Functions, JCGT 2(2), 2013). 0 for a temperature (kelvin) that is not above
/// 0.
glm::dvec3 blackBodyRadiance(double temperature) {
  if (!(temperature > 0.0)) return glm::dvec3(0.0);
  constexpr double kLumens = 683.002;  // a watt at 555 nm
  constexpr int kFirst = 380;          // nm
  constexpr int kLast = 780;
  glm::dvec3 xyz(0.0);
  for (int nm = kFirst; nm < kLast; ++nm) {
    const double w = nm + 0.5;
    xyz += observer(w) * planck(w * 1e-9, temperature) * (1e-9 * kLumens);
  }
  return glm::max(srgbOf(xyz), glm::dvec3(0.0));
}

const WorkerKind kVolumeCodecs{"libfragtrace_volumes.so", "the library that reads .nvdb files", kVolumeAdvice,
                               ""};

template <size_t N>
std::string textOf(const std::array<char, N>& text) {
  return {text.data(), ::strnlen(text.data(), N)};
}

WorkResult ask(Worker& worker, const GridRequest& request, std::span<const uint8_t> file, uint64_t room,
               uint64_t memoryBytes) {
  constexpr uint64_t kLibraries = uint64_t(64) << 20;
  constexpr uint64_t kBytesASecond = 10'000'000;
  const uint64_t bytes = std::max<uint64_t>(file.size(), std::min(room, memoryBytes));
  return worker.perform(
      {asMessage(request), file}, room,
      {.memoryBytes = kLibraries + memoryBytes, .cpuSeconds = unsigned(4 + bytes / kBytesASecond)});
}

std::vector<GridDescription> list(Worker& worker, std::span<const uint8_t> file, uint64_t memoryBytes) {
  GridRequest request;
  request.list = 1;
  const WorkResult result =
      ask(worker, request, file, sizeof(GridListing) + kMostGrids * sizeof(GridEntry), memoryBytes);
  std::span<const uint8_t> bytes = result.output;
  const uint64_t count = takeMessage<GridListing>(bytes).count;
  std::vector<GridDescription> grids;
  for (uint64_t i = 0; i < count; ++i) {
    const auto entry = takeMessage<GridEntry>(bytes);
    GridDescription grid{textOf(entry.name), textOf(entry.type), entry.isDensity != 0, glm::ivec3(0),
                         entry.activeVoxels};
    for (int axis = 0; axis < 3; ++axis) {
      const int64_t voxels = int64_t(entry.maximum[size_t(axis)]) - entry.minimum[size_t(axis)] + 1;
      grid.voxels[axis] = int(std::clamp<int64_t>(voxels, 0, 1 << 30));
    }
    grids.push_back(std::move(grid));
  }
  return grids;
}

uint64_t bricksOf(const GridDescription& grid) {
  uint64_t bricks = 1;
  // The box may begin and end anywhere in its bricks.
  for (int axis = 0; axis < 3; ++axis)
    bricks *= uint64_t(grid.voxels[axis] + 2 * kBrickSide - 1) / kBrickSide;
  return bricks;
}

VolumeGrid decode(Worker& worker, std::span<const uint8_t> file, const GridDescription& chosen,
                  uint64_t memoryBytes) {
  GridRequest request;
  std::ranges::copy(chosen.name, request.name.begin());
  // Room for all bricks costs nothing until it is used.
  constexpr uint64_t kOfABrick = sizeof(uint32_t) + kBrickVoxels * sizeof(uint16_t);
  const uint64_t room = std::min(sizeof(GridHeader) + bricksOf(chosen) * kOfABrick, memoryBytes);
  VolumeGrid grid = gridOfAnswer(ask(worker, request, file, room, memoryBytes).output);
  if (!(std::abs(glm::determinant(glm::dmat3(grid.toWorld))) > 0.0) ||
      !std::isfinite(glm::determinant(grid.toWorld)))
    throw std::runtime_error("its grid has no transform that can be undone");
  return grid;
}

const GridDescription& choose(const std::vector<GridDescription>& grids,
                              const std::optional<std::string>& name) {
  std::string names;
  for (const GridDescription& grid : grids)
    names.append(names.empty() ? "'" : ", '").append(grid.name).append("'");
  const std::string wanted = name.value_or("density");
  auto found = std::ranges::find(grids, wanted, &GridDescription::name);
  if (found == grids.end() && !name) found = std::ranges::find(grids, true, &GridDescription::isDensity);
  if (found == grids.end())
    throw std::runtime_error((name ? "has no grid '" + *name + "'" : "has no grid of densities") + ", but " +
                             names);
  if (!found->isDensity)
    throw std::runtime_error("grid '" + found->name + "' holds no densities (" + found->type +
                             "); the file has " + names);
  return *found;
}

/// The value of a voxel, as a part of the largest.
float valueAt(const VolumeGrid& grid, glm::ivec3 voxel) {
  const glm::ivec3 place = voxel - grid.minimum;
  const uint32_t stored = grid.entryOf(place >> 3);
  if (stored == 0) return 0.0f;
  const glm::ivec3 inside = place & 7;
  const size_t voxelInside =
      (size_t(inside.z) * kBrickSide + size_t(inside.y)) * kBrickSide + size_t(inside.x);
  return glm::unpackHalf1x16(grid.values[(stored - 1) * kBrickVoxels + voxelInside]);
}

/// Black bodies by temperature, in steps of an octave's sixteenth; between them, each channel by its
/// logarithm.
class BlackBodies {
 public:
  glm::dvec3 at(double temperature) {
    if (!(temperature > kColdest)) return glm::dvec3(0.0);
    const double place = kSteps * std::log2(std::min(temperature, kHottest) / kColdest);
    const auto step = size_t(place);
    return glm::exp(glm::mix(node(step), node(step + 1), place - double(step)));
  }

 private:
  static constexpr double kColdest = 300.0;
  static constexpr double kHottest = 1e6;
  static constexpr double kSteps = 64.0;

  const glm::dvec3& node(size_t step) {
    while (nodes_.size() <= step) {
      const glm::dvec3 radiance = blackBodyRadiance(kColdest * std::exp2(double(nodes_.size()) / kSteps));
      nodes_.push_back(glm::log(glm::max(radiance, glm::dvec3(1e-60))));
    }
    return nodes_[step];
  }

  std::vector<glm::dvec3> nodes_;
};

/// Gives the grid the radiance of its temperatures, voxel by voxel.
void heat(VolumeGrid& grid, const VolumeGrid& temperature) {
  if (grid.toWorld != temperature.toWorld)
    throw std::runtime_error("the grids of density and temperature have other transforms");
  BlackBodies bodies;
  std::vector<glm::vec3> radiance(grid.values.size());
  size_t brick = 0;
  for (const uint32_t stored : grid.table) {
    const auto x = int(brick % size_t(grid.bricks.x));
    const auto y = int(brick / size_t(grid.bricks.x) % size_t(grid.bricks.y));
    const auto z = int(brick / size_t(grid.bricks.x) / size_t(grid.bricks.y));
    ++brick;
    if (stored == 0) continue;
    for (int i = 0; i < int(kBrickVoxels); ++i) {
      const glm::ivec3 voxel =
          grid.minimum + kBrickSide * glm::ivec3(x, y, z) + glm::ivec3(i & 7, (i >> 3) & 7, i >> 6);
      const glm::dvec3 light = bodies.at(double(valueAt(temperature, voxel)) * temperature.largest);
      radiance[(stored - 1) * kBrickVoxels + size_t(i)] = glm::vec3(light);
      grid.brightest = std::max({grid.brightest, light.x, light.y, light.z});
    }
  }
  if (grid.brightest <= 0.0) return;
  grid.radiance.reserve(radiance.size() * 3);
  for (const glm::vec3& light : radiance) {
    for (int c = 0; c < 3; ++c) grid.radiance.push_back(glm::packHalf1x16(light[c] / float(grid.brightest)));
  }
}

}  // namespace

glm::dvec3 observer(double w) {
  return {0.362 * lobe(w, 442.0, 0.0624, 0.0374) + 1.056 * lobe(w, 599.8, 0.0264, 0.0323) -
              0.065 * lobe(w, 501.1, 0.0490, 0.0382),
          0.821 * lobe(w, 568.8, 0.0213, 0.0247) + 0.286 * lobe(w, 530.9, 0.0613, 0.0322),
          1.217 * lobe(w, 437.0, 0.0845, 0.0278) + 0.681 * lobe(w, 459.0, 0.0385, 0.0725)};
}

glm::dvec3 srgbOf(const glm::dvec3& xyz) {
  const glm::dmat3 toSrgb(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314,
                          0.0415560, 1.0572252);
  return toSrgb * xyz;
}

VolumeGrid gridOfAnswer(std::span<const uint8_t> bytes) {
  const auto header = takeMessage<GridHeader>(bytes);
  const auto check = [](bool holds) {
    if (!holds) throw std::runtime_error("the worker process sent a broken answer");
  };
  VolumeGrid grid;
  uint64_t bricks = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const int32_t count = header.bricks[size_t(axis)];
    check(count >= 0 && count < (1 << 16) && bricks < (uint64_t(1) << 32));
    grid.minimum[axis] = header.minimum[size_t(axis)];
    grid.bricks[axis] = count;
    bricks *= uint64_t(count);
    grid.toWorld[axis] = glm::dvec4(header.axes[size_t(axis) * 3], header.axes[size_t(axis) * 3 + 1],
                                    header.axes[size_t(axis) * 3 + 2], 0.0);
  }
  grid.toWorld[3] = glm::dvec4(header.origin[0], header.origin[1], header.origin[2], 1.0);
  check(std::isfinite(header.largest) && header.largest >= 0.0 && header.stored <= bricks &&
        bytes.size() == bricks * sizeof(uint32_t) + header.stored * kBrickVoxels * sizeof(uint16_t));
  grid.largest = header.largest;
  grid.table.resize(bricks);
  grid.values.resize(header.stored * kBrickVoxels);
  const auto fill = [&](auto& values, size_t from) {
    if (!values.empty()) std::memcpy(values.data(), bytes.data() + from, std::span(values).size_bytes());
  };
  fill(grid.table, 0);
  fill(grid.values, bricks * sizeof(uint32_t));
  constexpr uint16_t kOne = 0x3c00;
  check(std::ranges::all_of(grid.table, [&](uint32_t brick) { return brick <= header.stored; }) &&
        std::ranges::all_of(grid.values, [](uint16_t half) { return half <= kOne; }));
  return grid;
}

VolumeSource volumeFile(const std::string& text) {
  constexpr std::string_view kSuffix = ".nvdb";
  const size_t suffix = text.rfind(std::string(kSuffix) + ':');
  VolumeSource source;
  source.file = text.substr(0, suffix == std::string::npos ? suffix : suffix + kSuffix.size());
  if (suffix != std::string::npos) source.grid = text.substr(suffix + kSuffix.size() + 1);
  return source;
}

std::array<glm::dvec3, 8> Volume::corners() const {
  const glm::dmat4 place = voxelsToWorld();
  std::array<glm::dvec3, 8> points{};
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 side(i & 1, (i >> 1) & 1, i >> 2);
    const glm::dvec3 voxel(grid->minimum + kBrickSide * side * grid->bricks);
    points[size_t(i)] = glm::dvec3(place * glm::dvec4(voxel, 1.0));
  }
  return points;
}

std::vector<GridDescription> listGrids(const std::filesystem::path& path, uint64_t memoryBytes) {
  const std::vector<uint8_t> file = readWholeFile(path, memoryBytes);
  try {
    Worker worker(kVolumeCodecs);
    std::vector<GridDescription> grids = list(worker, file, memoryBytes);
    if (grids.empty()) throw std::runtime_error("holds no grid");
    for (GridDescription& grid : grids) {
      if (!grid.isDensity) continue;
      const Volume volume{.grid =
                              std::make_shared<const VolumeGrid>(decode(worker, file, grid, memoryBytes))};
      grid.largest = volume.grid->largest;
      if (volume.grid->empty()) continue;
      for (const glm::dvec3& corner : volume.corners()) grid.box.include(corner);
    }
    return grids;
  } catch (const std::runtime_error& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

VolumeGrid readGrid(const VolumeSource& source, std::span<const uint8_t> file, uint64_t memoryBytes) {
  std::vector<uint8_t> read;
  if (file.empty()) file = read = readWholeFile(source.file, memoryBytes);
  try {
    Worker worker(kVolumeCodecs);
    const std::vector<GridDescription> grids = list(worker, file, memoryBytes);
    if (grids.empty()) throw std::runtime_error("holds no grid");
    VolumeGrid grid = decode(worker, file, choose(grids, source.grid), memoryBytes);
    if (source.emits() && !grid.empty())
      heat(grid, decode(worker, file, choose(grids, "temperature"), memoryBytes));
    return grid;
  } catch (const std::runtime_error& error) {
    throw InputError(source.file.string() + ": " + error.what());
  }
}

}  // namespace fragtrace
