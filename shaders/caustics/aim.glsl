// SPDX-License-Identifier: MIT
// Light paths are aimed at the balls that enclose everything that makes caustics.

/// A ray towards a caster, and its pdf: over solid angle, or over the area across parallel rays. A pdf of 0
/// means that there is no ray.
struct Aim {
  vec3 origin;
  vec3 direction;
  float pdf;
};

/// 1 minus the cosine of half the angle under which a ball is seen, which is its solid angle over 2 pi. From inside the
/// ball it is that of the whole sphere.
float spreadOf(vec4 ball, vec3 point) {
  vec3 towards = vec3(ball) - point;
  float part = ball.w * ball.w / max(dot(towards, towards), float(1e-30));
  return part < 1.0f ? part / (1.0f + sqrt(1.0f - part)) : 2.0f;
}

/// Does the same, but 0 for a ball that lies behind the plane of a lamp that shines to one side. A normal of zero means
/// a lamp that shines to all sides.
float seenSpread(int caster, vec3 point, vec3 normal) {
  vec4 ball = vec4(casters[caster]);
  bool behind = dot(normal, normal) > 0.0f && dot(normal, vec3(ball) - point) <= -ball.w;
  return behind ? 0.0f : spreadOf(ball, point);
}

/// A ray from a point to a caster, which is chosen by its solid angle. The direction is uniform over the cone of the
/// caster's ball.
Aim aimFrom(vec3 point, vec3 normal, float choice, vec2 uv) {
  Aim a;
  a.origin = point;
  a.direction = vec3(0.0f, 0.0f, 1.0f);
  a.pdf = 0.0f;
  float sum = 0.0f;
  for (int i = 0; i < casterCount; ++i) sum += seenSpread(i, point, normal);
  if (sum <= 0.0f) return a;
  float left = choice * sum;
  int chosen = -1;
  float spread = 0.0f;
  for (int i = 0; i < casterCount; ++i) {
    float own = seenSpread(i, point, normal);
    bool here = own > 0.0f && left >= 0.0f;
    chosen = here ? i : chosen;
    spread = here ? own : spread;
    left -= own;
  }
  vec3 towards = vec3(casters[chosen]) - point;
  vec3 axis = dot(towards, towards) > 0.0f ? normalize(towards) : vec3(0.0f, 0.0f, 1.0f);
  a.direction = normalize(toWorld(frameAround(axis), sampleCone(spread, uv)));
  // Every cone that holds the direction could have drawn it.
  float cones = 0.0f;
  for (int i = 0; i < casterCount; ++i) {
    float own = seenSpread(i, point, normal);
    vec3 apart = normalize(vec3(casters[i]) - point) - a.direction;
    bool holds = i == chosen || own >= 2.0f || dot(apart, apart) <= 2.0f * own;
    cones += own > 0.0f && holds ? 1.0f : 0.0f;
  }
  a.pdf = cones / (2.0f * kPi * sum);
  return a;
}

/// A ray along a direction that starts outside the scene and passes through the disk of a caster, which is chosen by
/// its area.
Aim aimAlong(vec3 direction, float choice, vec2 uv) {
  float sum = 0.0f;
  for (int i = 0; i < casterCount; ++i) sum += casters[i].w * casters[i].w;
  float left = choice * sum;
  int chosen = 0;
  for (int i = 0; i < casterCount; ++i) {
    chosen = left >= 0.0f ? i : chosen;
    left -= casters[i].w * casters[i].w;
  }
  Frame3 around = frameAround(direction);
  vec4 ball = vec4(casters[chosen]);
  vec2 disk = ball.w * sampleDisk(uv.x, uv.y);
  vec3 point = vec3(ball) + disk.x * around.tangent + disk.y * around.bitangent;
  float disks = 0.0f;
  for (int i = 0; i < casterCount; ++i) {
    vec3 apart = point - vec3(casters[i]);
    apart -= dot(apart, direction) * direction;
    disks += i == chosen || dot(apart, apart) <= casters[i].w * casters[i].w ? 1.0f : 0.0f;
  }
  Aim a;
  a.origin = point - 2.0f * length(vec3(frame.sceneExtent)) * direction;  // two diagonals of the scene's box
  a.direction = direction;
  a.pdf = disks / (kPi * max(sum, float(1e-30)));
  return a;
}
