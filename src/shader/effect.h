// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace fragtrace {

/// The kind of change that a change of an option or a stage makes.
enum class Effect : uint8_t {
  Report,   ///< what is said, written beside the picture, or allowed
  Method,   ///< how the same samples are drawn: their time and rounding
  Layers,   ///< what a file holds beside the picture
  Count,    ///< how many samples
  Display,  ///< what is made of finished samples
  Noise,    ///< which samples; their mean stays
  View,     ///< from where the scene is seen
  Picture   ///< what the samples converge to
};

}  // namespace fragtrace
