// SPDX-License-Identifier: MIT
// Tests of OSMesa are skipped by name where its library is missing: Mesa 25.1 and later have none.
#pragma once

#include <dlfcn.h>

#include <initializer_list>

namespace fragtrace {

/// ctest counts a test that ends with this status as skipped.
inline constexpr int kSkipped = 77;

inline bool hasOsMesa() {
  for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}) {
    if (dlopen(name, RTLD_LAZY | RTLD_LOCAL)) return true;
  }
  return false;
}

}  // namespace fragtrace
