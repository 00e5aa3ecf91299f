// SPDX-License-Identifier: MIT
#pragma once

#include <bitset>
#include <compare>

namespace fragtrace {

/// A set of members of an enumeration that ends with Count. Sets have an order, so that they can stand in a
/// key whose comparison is defaulted.
template <typename Member>
struct SetOf : std::bitset<size_t(Member::Count)> {
  using Bits = std::bitset<size_t(Member::Count)>;

  using Bits::Bits;
  SetOf(const Bits& bits) : Bits(bits) {}  // NOLINT(google-explicit-constructor): what its operators return

  std::strong_ordering operator<=>(const SetOf& other) const {
    return this->to_string() <=> other.to_string();
  }
};

}  // namespace fragtrace
