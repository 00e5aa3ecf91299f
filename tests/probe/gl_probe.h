// SPDX-License-Identifier: MIT
// A context a test, on each of the two software backends.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "gl/context.h"

namespace fragtrace {

/// Makes the context that the test's parameter names; a missing one is a failure, never a skip.
class GlProbe : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override { context_ = makeContext(GetParam()); }
  const Context& context() const { return *context_; }

 private:
  std::unique_ptr<Context> context_;
};

inline std::string backendName(const testing::TestParamInfo<Backend>& info) {
  return info.param == Backend::Egl ? "Egl" : "OsMesa";
}

inline auto bothBackends() { return testing::Values(Backend::Egl, Backend::OsMesa); }

}  // namespace fragtrace
