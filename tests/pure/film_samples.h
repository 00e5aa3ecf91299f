// SPDX-License-Identifier: MIT
// Films as the shader would fill them, one sample after the other.
#pragma once

#include "render/film/film_pixels.h"
#include "shader_statistics.h"

namespace fragtrace {

/// Adds one sample to a pixel (Welford, 1962).
inline void addSample(FilmPixel& p, const glm::dvec3& color) {
  const double luminance = glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722));
  const double before = p.luminance();
  p.sum += color;
  p.samples += 1;
  p.m2 += (luminance - before) * (luminance - p.luminance());
}

inline FilmPixels emptyFilm(glm::ivec2 size) {
  FilmPixels film;
  film.size = size;
  film.pixels.resize(size_t(size.x) * size_t(size.y));
  return film;
}

/// A film whose pixel (x, y), y from the bottom, has the grey samples that samplesOf(x, y) returns.
template <typename SamplesOf>
FilmPixels filmOf(glm::ivec2 size, SamplesOf samplesOf) {
  FilmPixels film = emptyFilm(size);
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      for (double sample : samplesOf(x, y))
        addSample(film.pixels[size_t(y) * size_t(size.x) + size_t(x)], glm::dvec3(sample));
    }
  }
  return film;
}

}  // namespace fragtrace
