// SPDX-License-Identifier: MIT
// The film is kept in three images, one texel per pixel.

layout(rgba32f, binding = kFilmSumBinding) uniform restrict image2D filmSum;
layout(rgba32f, binding = kFilmCompensationBinding) uniform restrict image2D filmCompensation;
layout(rgba32ui, binding = kFilmCountsBinding) uniform restrict uimage2D filmCounts;

FilmPixel loadFilm(ivec2 pixel) {
  vec4 sum = imageLoad(filmSum, pixel);
  vec4 compensation = imageLoad(filmCompensation, pixel);
  uvec4 counts = imageLoad(filmCounts, pixel);
  return FilmPixel(sum.rgb, sum.a, compensation.rgb, compensation.a, counts.x, counts.y, counts.z, counts.w);
}

void storeFilm(ivec2 pixel, FilmPixel f) {
  if (!kLightPaths && !kStoresReservoirs) {
    imageStore(filmSum, pixel, vec4(f.sum, f.alpha));
    imageStore(filmCompensation, pixel, vec4(f.compensation, f.m2));
  }
  imageStore(filmCounts, pixel, uvec4(f.samples, f.rays, f.nonfinite, f.flags));
}

/// The film of light paths holds records, two texels per path: the light that the camera sees at its first rough
/// surface, and, in the upper half of the film, light that it sees later. A pixel's records are its part of a column of
/// texels.
ivec2 recordOf(ivec2 pixel, uint path) { return ivec2(pixel.x, pixel.y * frame.samplesWanted + int(path)); }

/// Stores where a light path lands (src/pack/guiding.h).
void storePhoton(ivec2 record, vec3 point, vec3 wi, float flux, uint chain) {
  imageStore(filmSum, record, vec4(point, isNonfinite(flux) ? 0.0 : flux));
  imageStore(filmCompensation, record, vec4(wi, float(chain >> 8)));
}

/// Stores the light that a light path sends to the camera, and the place in the picture where it is seen.
void storeRecord(ivec2 record, bool later, vec3 light, vec2 place) {
  ivec2 texel = record + ivec2(0, later ? imageSize(filmSum).y / 2 : 0);
  bool whole = !isNonfinite(light.x) && !isNonfinite(light.y) && !isNonfinite(light.z);
  imageStore(filmSum, texel, vec4(whole ? light : vec3(0.0), place.x));
  imageStore(filmCompensation, texel, vec4(place.y, 0.0, 0.0, 0.0));
}
