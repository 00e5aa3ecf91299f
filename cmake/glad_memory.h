// SPDX-License-Identifier: MIT
// Included into the generated loader of OpenGL, which uses what malloc gives without a look at it.
#pragma once

#include <stdlib.h>
#include <new>

inline void* allocated(std::size_t size) {
  void* memory = ::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

#define malloc allocated
