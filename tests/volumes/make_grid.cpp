// SPDX-License-Identifier: MIT
// make_grid SHAPE SIDE FILE.nvdb [none|zip] [float|fp8]: writes a grid of SIDE x SIDE x SIDE voxels over a
// cube with sides of 1, whose middle is the origin. Shapes: box (1 in all but the outermost voxels), ball,
// torus, plume (with a grid `temperature`), ember (the box at 2042 K), and empty, one, nan, infinite,
// levelset. FILE.raw gets the same densities as floats, X fastest.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <glm/glm.hpp>
#include <glm/gtc/noise.hpp>
#include <limits>
#include <string>
#include <vector>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wpedantic"
#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/IO.h>
#pragma GCC diagnostic pop

namespace {

using glm::vec3;

/// A shape has a density at each place in the cube.
using Shape = std::function<float(const vec3&)>;

float fading(float distance, float width) { return glm::clamp(0.5f - distance / width, 0.0f, 1.0f); }

float noise(vec3 p) {
  float sum = 0.0f;
  float size = 1.0f;
  for (int octave = 0; octave < 4; ++octave, size *= 0.5f, p *= 2.0f) sum += size * glm::perlin(p);
  return sum;
}

/// Returns how far a point is inside a column that widens upwards; 0 and less outside.
float insidePlume(const vec3& p) {
  const float height = p.y + 0.5f;
  const float radius = 0.08f + 0.28f * height;
  return (1.0f - glm::length(glm::vec2(p.x, p.z)) / radius) * fading(std::abs(p.y) - 0.42f, 0.08f);
}

float plume(const vec3& p) {
  const float dense = insidePlume(p) + 0.35f * noise(7.0f * p + vec3(3.1f, 0.0f, 1.7f));
  return insidePlume(p) > 0.0f ? glm::clamp(1.6f * dense, 0.0f, 1.0f) * (1.2f - 0.7f * (p.y + 0.5f)) : 0.0f;
}

float heat(const vec3& p) {
  return plume(p) > 0.0f ? 2600.0f * glm::max(0.0f, 0.9f - 1.4f * (p.y + 0.5f)) : 0.0f;
}

Shape shapeOf(const std::string& name) {
  if (name == "ball") return [](const vec3& p) { return fading(glm::length(p) - 0.4f, 0.05f); };
  if (name == "torus") {
    return [](const vec3& p) {
      return fading(glm::length(glm::vec2(glm::length(glm::vec2(p.x, p.z)) - 0.3f, p.y)) - 0.1f, 0.04f);
    };
  }
  if (name == "plume") return plume;
  if (name == "ember") return [](const vec3&) { return 1.0f; };
  if (name == "empty") return [](const vec3&) { return 0.0f; };
  if (name == "nan" || name == "infinite") {
    using Limits = std::numeric_limits<float>;
    const float value = name == "nan" ? Limits::quiet_NaN() : Limits::infinity();
    return [value](const vec3& p) { return glm::length(p) < 0.2f ? value : 1.0f; };
  }
  return [](const vec3&) { return 1.0f; };
}

template <typename Stored>
nanovdb::GridHandle<> gridOf(const std::string& kind, const char* name, int side, const Shape& shape,
                             bool inner, std::FILE* raw) {
  const bool levelSet = kind == "levelset";
  nanovdb::GridBuilder<float, Stored> builder(
      0.0f, levelSet ? nanovdb::GridClass::LevelSet : nanovdb::GridClass::FogVolume);
  auto voxels = builder.getAccessor();
  for (int z = 0; z < side; ++z) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const glm::ivec3 at(x, y, z);
        const bool edge =
            glm::any(glm::equal(at, glm::ivec3(0))) || glm::any(glm::equal(at, glm::ivec3(side - 1)));
        const float value = inner && edge ? 0.0f : shape((vec3(at) + 0.5f) / float(side) - 0.5f);
        if (value != 0.0f) voxels.setValue({x, y, z}, value);
        if (raw != nullptr) std::fwrite(&value, sizeof value, 1, raw);
      }
    }
  }
  const double voxel = 1.0 / side;
  return builder.getHandle(voxel, nanovdb::Vec3d(0.5 * voxel - 0.5), name);
}

}  // namespace

int main(int count, char** arguments) {  // NOLINT(bugprone-exception-escape): a tool of the tests
  if (count < 4) {
    std::fputs("make_grid SHAPE SIDE FILE.nvdb [none|zip] [float|fp8]\n", stderr);
    return 2;
  }
  const std::string name = arguments[1];
  const int side = std::stoi(arguments[2]);
  const std::string file = arguments[3];
  const bool zip = count > 4 && std::string(arguments[4]) == "zip";
  const bool small = count > 5 && std::string(arguments[5]) == "fp8";
  const bool inner = name != "one";
  std::FILE* const raw = std::fopen((file.substr(0, file.rfind('.')) + ".raw").c_str(), "wb");
  const Shape shape = shapeOf(name);
  std::vector<nanovdb::GridHandle<>> grids;
  grids.push_back(small ? gridOf<nanovdb::Fp8>(name, "density", side, shape, inner, raw)
                        : gridOf<float>(name, "density", side, shape, inner, raw));
  std::fclose(raw);
  if (name == "ember")
    grids.push_back(gridOf<float>(
        name, "temperature", side, [](const vec3&) { return 2042.0f; }, false, nullptr));
  if (name == "plume")
    grids.push_back(small ? gridOf<nanovdb::Fp8>(name, "temperature", side, heat, inner, nullptr)
                          : gridOf<float>(name, "temperature", side, heat, inner, nullptr));
  nanovdb::io::writeGrids(file, grids, zip ? nanovdb::io::Codec::ZIP : nanovdb::io::Codec::NONE);
  return 0;
}
