// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "image/image.h"

namespace fragtrace {

/// Returns the probability that Student's t with `freedom` degrees of freedom (more than 0, not always whole)
/// is at least as far from 0 as `t` is, on either side. The relative error is below 1e-8 up to 1e8 degrees.
double studentTails(double t, double freedom);

// Tells whether two noisy pictures have the same limit. Jung, Hanika and Dachsbacher, "Detecting Bias in
// Monte Carlo Renderers using Welch's t-test", Journal of Computer Graphics Techniques 9(2), 2020.

inline constexpr int kBiasTile = 16;  ///< pixels of a tile's side, if nobody asks for others

/// Two pictures' tiles, compared by Welch's test of their mean luminances. p is the chance that tiles of the
/// same limit differ as much.
struct BiasTest {
  /// The chance that pictures of the same limit look as different: 2 x the smaller of two chances, at most 1.
  /// One is that of the smallest p among so many tiles (Sidak), the other that of so many small p
  /// (Kolmogorov and Smirnov, one-sided: a variance that is stated too high finds no bias).
  double chance = 1;
  int tiles = 0;                    ///< number of tiles of the whole picture
  int noisy = 0;                    ///< tiles with a p, which all but those of equal constants have
  double smallest = 1;              ///< p of the tile that differs most
  std::array<int, 2> place{};       ///< its upper left pixel; of the first tile that is not finite, if one is
  std::array<int, 10> histogram{};  ///< tiles by p, in tenths from 0 to 1
  Image map;  ///< R, G, B: tiles from white (p = 1) to red where the picture is brighter, blue where darker
              ///< (p = 1e-6 and less); grey without a p
};

/// Compares colours by the layer variance.Y of both pictures (of the mean's luminance) and their samples per
/// pixel (samples.Y, or the attributes of a render where all pixels have as many), in tiles of `side` x
/// `side` pixels, at the right and lower edges perhaps fewer. Pixels without samples in either are left out.
/// A value that is not finite makes the chance NaN. Throws RenderError when a layer is missing, a pixel has
/// one sample, the sizes differ, a picture has no colour, or no pixel has samples in both.
BiasTest testBias(const Image& picture, const Image& reference, int side = kBiasTile);

}  // namespace fragtrace
