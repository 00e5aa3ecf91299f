// SPDX-License-Identifier: MIT
// Ctrl-C while something is measured: nothing is written.
#pragma once

#include <cstdio>

#include "cli/interrupt.h"
#include "render/renderer.h"

namespace fragtrace {

struct Interrupted {};

inline Renderer::Progress untilInterrupted() {
  return [](double) {
    if (interrupts() > 0) throw Interrupted();
    return true;
  };
}

/// Says so; the exit status.
inline int sayInterrupted() {
  constexpr int kInterruptedStatus = 130;
  std::fprintf(stderr, "fragtrace: interrupted, nothing is written\n");
  return kInterruptedStatus;
}

}  // namespace fragtrace
