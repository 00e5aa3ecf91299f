// SPDX-License-Identifier: MIT
// Tests whether equivalent forms of a scene give the same picture.
#pragma once

#include "tests/instruments/stress/forms.h"
#include "tests/instruments/stress/scene_drawing.h"

namespace fragtrace {

/// The likeness of the drawings of a sketch and of its form. Scaled and moved scenes are drawn with the same
/// random numbers, the others with their own, since theirs pick other lights with the same number.
struct Likeness {
  uint32_t seed = 0;
  Form form = Form::Scaled;
  double meanApart = 0.0;   ///< relative difference of the whole pictures' means
  double meanErrors = 0.0;  ///< the same in standard errors
  double worstBlock = 0.0;  ///< largest difference of blocks of 8 x 8 pixels, in standard errors
  size_t pixels = 0;
  size_t otherHits = 0;  ///< number of pixels whose depths in one sample differ by over 0.1 %
  std::string wrong;     ///< why they do not show the same; empty: they do
};

/// Draws randomSketch(seed) and its form, of 24 x 24 pixels. The limits: for the same random numbers, 0.1 %
/// of the mean and 3 standard errors in each block; else 5 standard errors in the mean and in each of the 9
/// blocks, which one scene of 170,000 exceeds by chance.
Likeness likenessOf(const Context& context, uint32_t seed, Form form, Schedule schedule,
                    const SceneDrawing::GoOn& goOn);

/// Its hits alone: of 64 x 64 pixels.
Likeness hitsOf(const Context& context, uint32_t seed, Form form, const SceneDrawing::GoOn& goOn);

/// One line: seed, form and figures.
std::string likenessLine(const Likeness& likeness);

}  // namespace fragtrace
