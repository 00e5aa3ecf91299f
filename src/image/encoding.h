// SPDX-License-Identifier: MIT
// The encoding of a picture file's numbers, where its format leaves a choice.
#pragma once

namespace fragtrace {

struct Encoding {
  bool half =
      false;  ///< .exr: 16-bit floats in the channels that isStoredAsHalf() names, 32-bit ones elsewhere
  int pngBits = 8;  ///< .png: 8 or 16 bits a channel

  bool operator==(const Encoding&) const = default;
};

}  // namespace fragtrace
