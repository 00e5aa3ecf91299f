// SPDX-License-Identifier: MIT
// Every setting that is timed shows the right picture, or the benchmark fails.
#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "bench/command/timed_setting.h"
#include "render/film/film_pixels.h"

namespace fragtrace {

/// The right picture, with which those of the settings are compared.
struct ReferencePicture {
  std::filesystem::path path;
  FilmPixels film;
  bool noiseFree = false;
};

/// Throws InputError.
ReferencePicture readReference(const std::filesystem::path& path);
/// Throws InputError when the setting draws another size.
void checkSize(const ReferencePicture& reference, const TimedSetting& setting);

/// Fills in the verdict of each setting on the picture of its last round. Without a reference it is compared
/// with the picture that the first setting which is to show the same makes by the other traversal of the
/// tree: pixel by pixel where the samples are the same, else by its noise. With one by its noise; all
/// must show that.
void checkSettings(const Context& context, std::span<TimedSetting> settings,
                   const std::optional<ReferencePicture>& reference, bool quiet);

/// Throws RenderError, which names them, where pictures are wrong.
void throwIfWrong(std::span<const FrameSetting> settings);

}  // namespace fragtrace
