// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

#include <glm/glm.hpp>

#include "bvh/outlines.h"
#include "image/image.h"
#include "scene/scene.h"
#include "session/setup.h"
#include "shader/render_options.h"

namespace fragtrace {

// The camera and the colours in the header of an .exr, as standard attributes of OpenEXR.

/// Sets worldToCamera and worldToNDC, and screenWindowWidth of a perspective; of cameras that are not
/// rectilinear worldToCamera alone. `size` is that of the whole picture, even if the image is a part of it.
/// Matrices are for row vectors, (x, y, z, 1) M, of metres in world space. A camera's x is right, y up, and z
/// the direction of view. NDC is (0, 0) at the upper left corner of the picture and (1, 1) at the lower
/// right, after division by w.
void setCamera(Image& image, const Camera& camera, glm::ivec2 size);

/// Sets chromaticities: the primaries of Rec. 709 and sRGB, and their white, D65.
void setChromaticities(Image& image);

// Writes a drawn picture: its content and its form.

/// Returns true if the picture's colours are those of a debug view, to be displayed as they are.
bool showsColors(const RenderOptions& options);

/// Makes a picture of the film: linear radiance, or the colours of a debug view. `variance` is as for
/// imageOf().
Image shownPicture(const RenderOptions& options, const FilmPixels& pixels, const Layers& layers,
                   std::span<const double> variance = {});

/// The edges of the boxes of the level asked for, if any, seen by a camera whose picture has that size.
std::vector<PictureLine> treeLines(const RenderOptions& options, const LoadedScene& loaded,
                                   const Camera& camera, glm::ivec2 size);

/// The picture as a display shows it, with lines over it, for the options' output.
Image displayedPicture(const RenderOptions& options, const Image& linear, std::span<const PictureLine> lines);

/// Must be called before the first sample: throws RenderError if a picture of that size could not be written.
void checkPictureWritable(const RenderOptions& options, glm::ivec2 size);

/// Rescues a finished picture whose output cannot be written for that reason: writes its colours alone to
/// NAME.pfm next to it, or to a name that does not exist yet. Returns the message: the reason, where the
/// picture is and what it lacks. Nothing replaces a .pfm or standard output.
std::string rescuePicture(const RenderOptions& options, const Image& linear, const std::string& reason);

/// Says how many values of the output 16-bit floats could not hold, if any.
void sayClamped(const RenderOptions& options, size_t values);

/// Writes a linear picture to the options' output: as it is, or as a display shows it, with lines over it.
/// Throws RenderError.
void writePicture(const RenderOptions& options, const Image& linear, std::span<const PictureLine> lines);

// Says why a picture shows nothing, or is as good as black.

/// A drawn picture, linear, with what was drawn.
struct DrawnView {
  const RenderOptions& options;
  const LoadedScene& loaded;  ///< its geometry may be gone
  const Image& picture;
  const Statistics& stats;
};

/// The reason why the view shows nothing of the scene, or why 99 % of its pixels are black, and the option
/// that changes it; empty: it is neither. The reason is looked for in the file, which is loaded once more.
std::string whyNothingIsSeen(const DrawnView& view);

}  // namespace fragtrace
