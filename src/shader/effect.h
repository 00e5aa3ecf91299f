// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace fragtrace {

/// The kind of change that a change of an option or a stage makes.
enum class Effect : uint8_t {
  Report,   ///< messages, files beside the picture, or permission
  Method,   ///< the way in which the same samples are drawn: their time and rounding
  Layers,   ///< content of a file beside the picture
  Count,    ///< number of samples
  Display,  ///< processing of finished samples
  Noise,    ///< choice of samples; their mean stays
  View,     ///< the point of view
  Picture   ///< the limit to which samples converge
};

}  // namespace fragtrace
