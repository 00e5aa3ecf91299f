// SPDX-License-Identifier: MIT
// The window: left of the bar one displayed picture, right of it the other, whatever their resolutions.
layout(binding = 0) uniform sampler2D leftPicture;
layout(binding = 1) uniform sampler2D rightPicture;
layout(location = 0) uniform vec2 windowSize;  // pixels
layout(location = 1) uniform float bar;        // pixels from the left

layout(location = 0) out vec4 shown;

void main() {
  // Pictures have their first row at the top.
  vec2 place = vec2(gl_FragCoord.x, windowSize.y - gl_FragCoord.y);
  vec2 uv = place / windowSize;
  vec4 color = place.x >= bar ? texture(rightPicture, uv) : texture(leftPicture, uv);
  // Where nothing is, a checkerboard, as picture editors show it.
  ivec2 square = ivec2(place) >> 3;
  float board = ((square.x ^ square.y) & 1) == 0 ? 0.35 : 0.45;
  shown = vec4(mix(vec3(board), color.rgb, color.a), 1.0);
}
