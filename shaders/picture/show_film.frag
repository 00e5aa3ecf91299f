// SPDX-License-Identifier: MIT
// Shows the film in the window, without a filter; its first row is at the top.
#include "picture/film_means.glsl"

layout(location = 2) uniform bool background;  // the background is seen: nothing shows through

layout(location = 0) out vec4 shown;

void main() {
  FilmMeans m = filmMeans(ivec2(gl_FragCoord.x, size.y - 1 - int(gl_FragCoord.y)));
  shown = vec4(m.radiance, background ? 1.0 : m.alpha);
}
