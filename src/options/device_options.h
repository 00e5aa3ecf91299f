// SPDX-License-Identifier: MIT
// The options of `render` that say how, not what, is drawn, and those of them for benchmarks that choose the
// rest themselves.
#pragma once

namespace CLI {
class App;
}

namespace fragtrace {

struct RawRender;

/// Adds to `render` all that says how its pictures are traced.
void addTracingOptions(CLI::App& app, RawRender& raw);

/// Adds --rendering-backend, --buffer-reads, --vector-width, --shader-folder and --quiet.
void addDeviceOptions(CLI::App& app, RawRender& raw);

}  // namespace fragtrace
