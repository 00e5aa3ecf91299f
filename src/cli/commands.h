// SPDX-License-Identifier: MIT
// The commands: one row each.
#pragma once

#include <array>
#include <span>

#include "cli/command_line.h"

namespace fragtrace {

struct RawRender;

RunCommand addRender(CLI::App& app);
RunCommand addView(CLI::App& app);
RunCommand addInfo(CLI::App& app);
RunCommand addSheet(CLI::App& app);
RunCommand addDiff(CLI::App& app);
RunCommand addMerge(CLI::App& app);
RunCommand addDenoise(CLI::App& app);
/// For --help alone: the program has become another one before it asks for this command's options.
RunCommand addBench(CLI::App& app);

/// The command's sentence in --help.
inline constexpr const char* kBenchSentence = "measure speed and error";

/// The commands, in the order of --help.
inline constexpr std::array kCommandRows{
    CommandRow{"render", "render a scene to a file", addRender},
    CommandRow{"view", "show a scene in a window", addView},
    CommandRow{"info", "print what a scene contains", addInfo},
    CommandRow{"sheet", "draw all models of a folder in one picture", addSheet},
    CommandRow{"diff", "compare a picture with a reference", addDiff},
    CommandRow{"merge", "merge parts of one render", addMerge},
    CommandRow{"denoise", "remove noise from a picture file", addDenoise},
    CommandRow{"bench", kBenchSentence, addBench},
};

/// Adds what a command needs that can filter a file: the filter itself is another option's.
void addFileFilterOptions(CLI::App& app, RawRender& raw);

/// Replaces this process by that program if the command is `bench`, with the words that follow; else returns.
/// The program's name comes first.
/// Throws RenderError if the program is missing.
void becomeBenchProgram(std::span<const char* const> asked);

}  // namespace fragtrace
