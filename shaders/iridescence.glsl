// SPDX-License-Identifier: MIT
// Reflectance of a surface under a thin film (Belcour and Barla, A Practical Extension to Microfacet Theory for the
// Modeling of Varying Iridescence, 2017), with the approximations of KHR_materials_iridescence: Schlick's reflectances,
// real indices, two orders of interference.

/// The response of three sensors for red, green and blue to a wave with this optical path difference (nm) and phase
/// shifts. Their sensitivities are Gaussians over the wave number; this evaluates the Fourier transforms of these.
vec3 filmInterference(float pathDifference, vec3 shift) {
  float phase = 2.0f * kPi * pathDifference * float(1e-9);
  float squared = phase * phase;
  const vec3 place = vec3(float(1.6810e6), float(1.7953e6), float(2.2084e6));
  const vec3 width = vec3(float(4.3278e9), float(9.3046e9), float(6.6121e9));
  const vec3 height = vec3(float(5.4856e-13), float(4.4201e-13), float(5.2481e-13));
  vec3 xyz = height * sqrt(2.0f * kPi * width) * cos(place * phase + shift) * exp(-squared * width);
  // The red sensor has a second bump, in the blue.
  const float blueWidth = float(4.5282e9);
  xyz.x += float(9.7470e-14) * sqrt(2.0f * kPi * blueWidth) * cos(float(2.2399e6) * phase + shift.x) *
           exp(-squared * blueWidth);
  xyz = xyz / float(1.0685e-7);
  return vec3(dot(xyz, vec3(float(3.2404542), float(-1.5371385), float(-0.4985314))),
              dot(xyz, vec3(float(-0.9692660), float(1.8760108), float(0.0415560))),
              dot(xyz, vec3(float(0.0556434), float(-0.2040259), float(1.0572252))));
}

/// Reflectance seen at `cosine` from air, between 0 and 1. baseF0: the reflectance of the surface without the film, at
/// normal incidence. index and thickness (nm) are the film's.
vec3 filmReflectance(vec3 baseF0, float index, float thickness, float cosine) {
  float inside = sqrt(max(0.0f, 1.0f - (1.0f - cosine * cosine) / (index * index)));
  float root = (index - 1.0f) / (index + 1.0f);
  float top = fresnelSchlick(vec3(root * root), 1.0f, cosine).x;
  vec3 rootF0 = sqrt(clamp(baseF0, float(0.0), float(0.9998)) + float(1e-4));
  vec3 baseIndex = (vec3(1.0f) + rootF0) / (vec3(1.0f) - rootF0);
  vec3 ratio = (baseIndex - index) / (baseIndex + index);
  vec3 bottom = fresnelSchlick(ratio * ratio, 1.0f, inside);
  // The film is denser than air. Light that meets a less dense material behind it keeps its phase.
  vec3 shift = vec3(kPi) + vec3(baseIndex.x < index ? kPi : 0.0f, baseIndex.y < index ? kPi : 0.0f,
                                baseIndex.z < index ? kPi : 0.0f);
  vec3 both = clamp(top * bottom, float(1e-5), float(0.9999));
  vec3 order = sqrt(both);
  float through = 1.0f - top;
  vec3 sum = through * through * bottom / (vec3(1.0f) - both);
  float pathDifference = 2.0f * index * thickness * inside;
  vec3 result = top + sum;
  vec3 factor = (sum - through) * order;
  result = result + float(2.0) * factor * filmInterference(pathDifference, shift);
  factor = factor * order;
  result = result + float(2.0) * factor * filmInterference(2.0f * pathDifference, float(2.0) * shift);
  return clamp(result, float(0.0), float(1.0));
}
