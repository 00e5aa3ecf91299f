// SPDX-License-Identifier: MIT
// The commands: one row each.
#pragma once

#include <array>

#include "options/command.h"

namespace fragtrace {

RunCommand addRender(CLI::App& app);
RunCommand addView(CLI::App& app);
RunCommand addInfo(CLI::App& app);
RunCommand addDiff(CLI::App& app);
RunCommand addMerge(CLI::App& app);
RunCommand addDenoise(CLI::App& app);
RunCommand addBench(CLI::App& app);

/// In the order of --help.
inline constexpr std::array kCommandRows{
    CommandRow{"render", "render a scene to a file", addRender},
    CommandRow{"view", "show a scene in a window", addView},
    CommandRow{"info", "say what is in a scene", addInfo},
    CommandRow{"diff", "compare a picture with a reference", addDiff},
    CommandRow{"merge", "join .exr parts of one render (--sample-offset)", addMerge},
    CommandRow{"denoise", "filter the noise out of a picture", addDenoise},
    CommandRow{"bench", "measure speed and error", addBench},
};

}  // namespace fragtrace
