// SPDX-License-Identifier: MIT
// Draws the picture's part of the window, or a cell of it: left of the bar one displayed picture, right of it the
// other, whatever their resolutions; or the difference of two traced ones.
#include "srgb.glsl"
#include "picture/enlarge.glsl"

layout(binding = 0) uniform sampler2D leftPicture;
layout(binding = 1) uniform sampler2D rightPicture;
layout(location = 0) uniform vec2 pictureSize;  // pixels
layout(location = 1) uniform float bar;         // pixels from the left
layout(location = 2) uniform vec2 corner;       // bottom left corner of the pictures in the window, pixels
layout(location = 3) uniform vec3 part;         // part of the pictures that is shown: its middle, and its size
layout(location = 4) uniform float difference;  // factor of the difference of radiances; 0: pictures are shown

layout(location = 0) out vec4 shown;

/// A picture that is coarser than the window while something moves is enlarged along its edges.
vec4 shownOf(sampler2D picture, vec2 uv) {
  bool coarse = part.z == 1.0 && textureSize(picture, 0).x < int(pictureSize.x);
  return coarse ? enlarged(picture, uv) : texture(picture, uv);
}

void main() {
  // Pictures have their first row at the top.
  vec2 place = gl_FragCoord.xy - corner;
  place.y = pictureSize.y - place.y;
  vec2 uv = part.xy + (place / pictureSize - 0.5) * part.z;
  if (difference > 0.0) {
    vec3 apart = abs(texture(leftPicture, uv).rgb - texture(rightPicture, uv).rgb);
    shown = vec4(encoded(clamp(apart * difference, 0.0, 1.0)), 1.0);
    return;
  }
  vec4 color = place.x >= bar ? shownOf(rightPicture, uv) : shownOf(leftPicture, uv);
  // Empty places show a checkerboard, as in picture editors.
  ivec2 square = ivec2(place) >> 3;
  float board = ((square.x ^ square.y) & 1) == 0 ? 0.35 : 0.45;
  shown = vec4(mix(vec3(board), color.rgb, color.a), 1.0);
}
