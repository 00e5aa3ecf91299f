// SPDX-License-Identifier: MIT
// The rays that `fragtrace bench traversal --rays FILE` wrote, traced by Embree 3 one at a time on all cores.
// Usage: embree_rays FILE ROUNDS. One line of JSON per kind of rays: rays, hits, milliseconds of each round,
// and on how many rays Embree differs from what the file says was hit.
#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

namespace {

struct FileRay {
  float origin[3];
  float limit;  // 0: there is no ray
  float direction[3];
  float t;  // the distance that fragtrace found; -1: nothing
};

struct Input {
  std::vector<float> corners;  // nine per triangle
  std::array<std::vector<FileRay>, 3> sets;
};

Input readInput(const char* path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  size_t at = 8;
  const auto take = [&](void* to, size_t count) {
    if (at + count > bytes.size()) {
      std::fprintf(stderr, "embree_rays: %s: not a whole file of rays\n", path);
      std::exit(3);
    }
    std::memcpy(to, bytes.data() + at, count);
    at += count;
  };
  if (bytes.size() < 16 || std::memcmp(bytes.data(), "FTRAYS1", 8) != 0) {
    std::fprintf(stderr, "embree_rays: %s: no file of rays\n", path);
    std::exit(3);
  }
  uint32_t triangles = 0;
  uint32_t rays = 0;
  take(&triangles, 4);
  take(&rays, 4);
  Input input;
  input.corners.resize(size_t(triangles) * 9);
  take(input.corners.data(), input.corners.size() * sizeof(float));
  for (std::vector<FileRay>& set : input.sets) {
    set.resize(rays);
    take(set.data(), set.size() * sizeof(FileRay));
  }
  return input;
}

RTCScene makeScene(RTCDevice device, const std::vector<float>& corners) {
  const size_t triangles = corners.size() / 9;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices =
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, triangles * 3);
  std::memcpy(vertices, corners.data(), corners.size() * sizeof(float));
  auto* indices = static_cast<uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles));
  for (size_t i = 0; i < triangles * 3; ++i) indices[i] = uint32_t(i);
  rtcCommitGeometry(geometry);
  RTCScene scene = rtcNewScene(device);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  return scene;
}

void fill(RTCRay& ray, const FileRay& from) {
  ray.org_x = from.origin[0];
  ray.org_y = from.origin[1];
  ray.org_z = from.origin[2];
  ray.dir_x = from.direction[0];
  ray.dir_y = from.direction[1];
  ray.dir_z = from.direction[2];
  ray.tnear = 0.0f;
  ray.tfar = from.limit;
  ray.time = 0.0f;
  ray.mask = ~0u;
  ray.id = 0;
  ray.flags = 0;
}

/// The distance of the hit; 0 for an occlusion ray that is blocked; -1 if nothing is hit.
float traceOne(RTCScene scene, const FileRay& from, bool anyHit) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (anyHit) {
    RTCRay ray;
    fill(ray, from);
    rtcOccluded1(scene, &context, &ray);
    return ray.tfar < 0.0f ? 0.0f : -1.0f;
  }
  RTCRayHit hit;
  fill(hit.ray, from);
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene, &context, &hit);
  return hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? -1.0f : hit.ray.tfar;
}

double traceAll(RTCScene scene, const std::vector<FileRay>& rays, bool anyHit, std::vector<float>& found) {
  constexpr size_t kBlock = 4096;
  const auto start = std::chrono::steady_clock::now();
  std::atomic<size_t> next = 0;
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i) {
    threads.emplace_back([&] {
      for (size_t first = next.fetch_add(kBlock); first < rays.size(); first = next.fetch_add(kBlock)) {
        for (size_t r = first; r < std::min(first + kBlock, rays.size()); ++r) {
          if (rays[r].limit > 0.0f) found[r] = traceOne(scene, rays[r], anyHit);
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: embree_rays FILE ROUNDS\n");
    return 2;
  }
  const Input input = readInput(argv[1]);
  const int rounds = std::max(1, std::atoi(argv[2]));
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = makeScene(device, input.corners);
  const char* names[] = {"primary", "diffuse", "shadow"};
  for (size_t kind = 0; kind < 3; ++kind) {
    const std::vector<FileRay>& rays = input.sets[kind];
    std::vector<float> found(rays.size(), -1.0f);
    traceAll(scene, rays, kind == 2, found);  // warm up
    std::printf("{\"kind\":\"%s\",\"ms\":[", names[kind]);
    for (int round = 0; round < rounds; ++round)
      std::printf("%s%.4f", round > 0 ? "," : "", traceAll(scene, rays, kind == 2, found));
    size_t count = 0;
    size_t hits = 0;
    size_t differing = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      if (!(rays[i].limit > 0.0f)) continue;
      ++count;
      hits += found[i] >= 0.0f ? 1 : 0;
      const bool same = (found[i] >= 0.0f) == (rays[i].t >= 0.0f);
      differing += same && std::abs(found[i] - rays[i].t) <= 1e-3f * (1.0f + std::abs(rays[i].t)) ? 0 : 1;
    }
    std::printf("],\"rays\":%zu,\"hits\":%zu,\"differing\":%zu}\n", count, hits, differing);
  }
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
  return 0;
}
