// SPDX-License-Identifier: MIT
// LDR-FLIP: the difference that a person sees when flipping between two pictures. Andersson, Nilsson,
// Akenine-Moller, Oskarsson, Astrom and Fairchild, "FLIP: A Difference Evaluator for Alternating Images",
// Proceedings of the ACM on Computer Graphics and Interactive Techniques 3 (2), HPG 2020.
#pragma once

#include "image/image.h"

namespace fragtrace {

/// The paper's viewing condition: a display 0.7 m and 3840 pixels wide, seen from 0.7 m.
inline constexpr double kFlipPixelsPerDegree = 0.7 * (3840 / 0.7) * 3.14159265358979323846 / 180;

struct FlipError {
  Image map;        ///< one channel "Y", as large as the pictures: 0 where none is seen, 1 at most
  double mean = 0;  ///< mean of the map, in double precision
};

/// Compares display pictures: R, G and B (or grey) sRGB-encoded in 0..1, as toDisplay makes them and
/// readImage returns .png and .jpg. Values outside are clamped; other channels are left out. A NaN in either
/// makes the map NaN around it, and the mean NaN. The measure is symmetric in both pictures; edges are
/// continued by their last pixel. `pixelsPerDegree` of visual angle is from 1 to 1000. Throws RenderError
/// when it is not, when the sizes differ or when a picture has no colour.
FlipError flipError(const Image& picture, const Image& reference,
                    double pixelsPerDegree = kFlipPixelsPerDegree);

}  // namespace fragtrace
