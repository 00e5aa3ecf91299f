// SPDX-License-Identifier: MIT
// Places of camera samples within and around their pixel. They are drawn with the pdf of the pixel filter, so that
// all samples have the same weight (Ernst, Stamminger and Greiner, Filter Importance Sampling, 2006).

const int kBoxFilter = 0;
const int kGaussianFilter = 1;
const int kBlackmanHarrisFilter = 2;

/// In pixels: the standard deviation of the Gaussian, which is cut off at 4 of them, and the width of the window of
/// Blackman and Harris.
const float kGaussianDeviation = float(0.5);
const float kBlackmanHarrisWidth = float(3.0);
const float kGaussianKept = float(0.99966453737209749);  // 1 - exp(-4^2 / 2), within the cut

/// Density of the window over its width 0..1 and its integral from 0 (Harris, On the Use of Windows for Harmonic
/// Analysis, 1978: four terms, 92 dB), both over the window's area.
vec2 blackmanHarris(float t) {
  float x = 2.0f * kPi * t;
  float pdf = float(0.35875) - float(0.48829) * cos(x) + float(0.14128) * cos(2.0f * x) -
                  float(0.01168) * cos(3.0f * x);
  float integral = float(0.35875) * t -
                   (float(0.48829) * sin(x) - float(0.07064) * sin(2.0f * x) + float(0.0038933333) * sin(3.0f * x)) /
                       (2.0f * kPi);
  return vec2(pdf, integral) / float(0.35875);
}

/// Undoes the integral by five steps of Newton's method, which leave 2e-6 pixels.
float sampleBlackmanHarris(float u) {
  float low = min(u, 1.0f - u);
  float t = max(0.5f - float(0.141) * sqrt(max(0.0f, -log(max(4.0f * low * (1.0f - low), float(1e-12))))), float(0.03));
  for (int i = 0; i < 5; ++i) {
    vec2 f = blackmanHarris(t);
    t = clamp(t - (f.y - low) / max(f.x, float(1e-9)), 0.0f, 0.5f);
  }
  return kBlackmanHarrisWidth * (u < 0.5f ? t - 0.5f : 0.5f - t);
}

/// The place of a sample from the middle of its pixel, in pixels.
vec2 samplePixelFilter(int filterKind, float u, float v) {
  if (filterKind == kGaussianFilter) {
    // Box and Muller's polar form, the radius cut off.
    float radius = kGaussianDeviation * sqrt(max(0.0f, -2.0f * log(1.0f - kGaussianKept * u)));
    vec2 around = unitCircle(v);
    return vec2(radius * around.x, radius * around.y);
  }
  if (filterKind == kBlackmanHarrisFilter) return vec2(sampleBlackmanHarris(u), sampleBlackmanHarris(v));
  return vec2(u - 0.5f, v - 0.5f);
}

/// The pdf of the filter at a place from the middle of its pixel, in pixels.
float pixelFilterPdf(int filterKind, vec2 offset) {
  if (filterKind == kGaussianFilter) {
    float squared = dot(offset, offset) / (kGaussianDeviation * kGaussianDeviation);
    float scale = 1.0f / (2.0f * kPi * kGaussianDeviation * kGaussianDeviation * kGaussianKept);
    return squared < 16.0f ? scale * exp(-0.5f * squared) : 0.0f;
  }
  if (filterKind == kBlackmanHarrisFilter) {
    vec2 t = offset / kBlackmanHarrisWidth + vec2(0.5f);
    bool inside = t.x > 0.0f && t.x < 1.0f && t.y > 0.0f && t.y < 1.0f;
    float pdf = blackmanHarris(t.x).x * blackmanHarris(t.y).x / (kBlackmanHarrisWidth * kBlackmanHarrisWidth);
    return inside ? pdf : 0.0f;
  }
  return abs(offset.x) <= 0.5f && abs(offset.y) <= 0.5f ? 1.0f : 0.0f;
}
