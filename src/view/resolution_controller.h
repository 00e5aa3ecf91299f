// SPDX-License-Identifier: MIT
// The resolution to draw at: while something moves, one whose frames take no longer than a target, by the
// times measured, but no coarser than a quarter of the width and height; when all is still, finer and finer.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>

namespace fragtrace {

/// The steps that a resolution may be at: the width and height, in pixels of the window, of a drawn pixel.
inline constexpr std::array<double, 5> kResolutionSteps{1.0, 1.5, 2.0, 3.0, 4.0};

/// Its state, changed by the functions below alone. Steps are indices into kResolutionSteps.
struct ResolutionController {
  double targetMs = 1000.0 / 10.0;  ///< time of one frame while moving
  int mostSamples = 1;              ///< most samples in a frame of full resolution
  size_t step = 0;                  ///< step of the next frame
  bool moving = false;
  std::array<double, 8> msPerPixel{};  ///< time per pixel of the latest frames, the newest first; 0: none yet
};

/// The size of a frame at a step: rounded up, at least one pixel.
glm::ivec2 sizeAtStep(glm::ivec2 full, size_t step);

/// Something begins, or continues, to move: the next frame is at the finest step that is expected to hold the
/// target, at the coarsest as long as nothing was measured.
void keepMoving(ResolutionController& controller, glm::ivec2 full);

/// The controller of a device: on a GPU a frame for each refresh of a usual display, with as many samples as
/// it can have; ten frames a second where software draws, since there samples are worth more than frames.
ResolutionController controllerFor(bool software);

/// Returns the number of further samples that a moving frame may have within the target, given the samples
/// that it has (>= 1) and the time that they took.
int samplesThatFit(const ResolutionController& controller, double elapsedMs, int samples);

/// Must be called when something else is drawn, whose pixels take `msPerPixel` (0: not known). Its first
/// frame is at the step that keepMoving() would choose.
void drawSomethingElse(ResolutionController& controller, glm::ivec2 full, double msPerPixel);

/// Nothing moves any more: the next frame is one step finer than the last, or at full resolution if that is
/// expected to take less than a tenth of a second.
void refine(ResolutionController& controller, glm::ivec2 full);

/// Must be called after a frame of `drawn` pixels that took `ms`. While moving, the step becomes coarser
/// after two frames of three beyond the target, or after one of twice its time, and finer after eight that
/// would all have held it with a fifth to spare. Times that are not above zero count nothing.
void frameTaken(ResolutionController& controller, glm::ivec2 full, glm::ivec2 drawn, double ms);

}  // namespace fragtrace
