// SPDX-License-Identifier: MIT
// The options of `render` that say how, not what, is drawn: for benchmarks that choose the rest themselves.
#pragma once

namespace CLI {
class App;
}

namespace fragtrace {

struct RawRender;

/// Adds --rendering-backend, --buffer-reads, --shader-folder and --quiet.
void addDeviceOptions(CLI::App& app, RawRender& raw);

}  // namespace fragtrace
