// SPDX-License-Identifier: MIT
// Every setting that is timed shows the right picture, or the benchmark fails.
#pragma once

#include <span>

#include "cli/timed_setting.h"

namespace fragtrace {

/// Fills in the verdict of each setting on the picture of its last round. Without a reference it is compared
/// with the picture that the first setting which is to show the same makes by the other traversal of the
/// tree: pixel by pixel where the samples are the same, else by its noise. With one (a file) by its noise;
/// all must show that. Throws InputError when the file is of another size.
void checkSettings(const Context& context, std::span<TimedSetting> settings,
                   const std::filesystem::path& reference, bool quiet);

/// Both are to converge to one picture.
bool showSame(const RenderOptions& a, const RenderOptions& b);
/// And their samples are the same.
bool drawSameSamples(const RenderOptions& a, const RenderOptions& b);

/// The failure that wrong pictures are: "a.gltf, bvh: ...". Empty: none.
std::string wrongPictures(std::span<const FrameSetting> settings);

}  // namespace fragtrace
