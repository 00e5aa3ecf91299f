// SPDX-License-Identifier: MIT
// Options whose value is one of some names.
#pragma once

#include <string>

#include "base/errors.h"
#include "base/text.h"
#include "scene/parts.h"

namespace fragtrace {

/// "'x' is none of a, b, c"
template <typename Names>
std::string whyNoneOf(const std::string& name, const Names& names) {
  return "'" + name + "' is none of " + joined(names);
}

/// The value of a name in a list of names whose order is that of the values. The case of letters does not
/// count. Throws UsageError.
template <typename Value, typename Names>
Value choose(const char* option, const std::string& name, const Names& names) {
  int index = 0;
  for (const auto& candidate : names) {
    if (isSameButForCase(name, candidate)) return Value(index);
    ++index;
  }
  throw UsageError(std::string(option) + ": " + whyNoneOf(name, names));
}

}  // namespace fragtrace
