// SPDX-License-Identifier: MIT
// The context in which programs are compiled while another thread draws.
#pragma once

#include <functional>

#include "gl/context.h"

namespace fragtrace {

class CompileContext {
 public:
  /// `outside` shares its objects with the context that draws.
  explicit CompileContext(OutsideContext outside) : outside_(std::move(outside)) {}

  /// Runs the job in the calling thread, with the context current. Throws as it does, and RenderError.
  void run(const std::function<void()>& job);

 private:
  OutsideContext outside_;
};

}  // namespace fragtrace
