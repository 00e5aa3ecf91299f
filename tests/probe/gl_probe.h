// SPDX-License-Identifier: MIT
// A context a test, on each of the two software backends.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "gl/context.h"
#include "osmesa.h"

namespace fragtrace {

/// Makes the context that the test's parameter names. It fails without one, but is skipped where OSMesa is
/// not installed.
class GlProbe : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    if (GetParam() == Backend::OsMesa && !hasOsMesa()) GTEST_SKIP() << "libOSMesa is not installed";
    DeviceOptions device;
    device.backend = GetParam();
    context_ = makeContext(device);
  }
  const Context& context() const { return *context_; }

 private:
  std::unique_ptr<Context> context_;
};

inline std::string backendName(const testing::TestParamInfo<Backend>& info) {
  return info.param == Backend::Egl ? "Egl" : "OsMesa";
}

inline auto bothBackends() { return testing::Values(Backend::Egl, Backend::OsMesa); }

}  // namespace fragtrace
