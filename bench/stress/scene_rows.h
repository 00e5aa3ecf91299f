// SPDX-License-Identifier: MIT
// Rows of whole scenes: equivalent forms of random ones, trees of the worst shapes, very many samples.
#pragma once

#include "bench/stress/forms.h"
#include "bench/stress/stress.h"

namespace fragtrace {

/// Random scenes and their form: scenes that do not show the same.
StressOutcome drawForms(const StressSetting& setting, Form form);

/// The same: pixels in which one sample hits something else.
StressOutcome hitForms(const StressSetting& setting, Form form);

/// A million identical triangles (quick: 20,000), 64 samples per pixel: pixels that differ from one
/// triangle's in a bit, or in which a loop was cut.
StressOutcome drawIdentical(const StressSetting& setting);

/// 50,000 triangles of shrinking sizes (quick: 20,000), a fifth of them within one cell of the boxes' grid;
/// one ray of the framing camera a pixel: hits that double precision does not find. More would take a ray
/// more steps than RayCaster allows.
StressOutcome castAtShrinking(const StressSetting& setting);

/// 16 million samples of 1/3 (quick: a million) in each of 4 pixels: channels that are more than 1e-6 off.
StressOutcome addThirds(const StressSetting& setting);

/// Scenes with a number in a file that is NaN, infinite or as large as floats can be: those that are neither
/// refused nor drawn without a sample that is not finite.
StressOutcome drawNoNumbers(const StressSetting& setting);

}  // namespace fragtrace
