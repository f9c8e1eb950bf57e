#version 330 core
// A mask of the atlas, laid on whole pixels; or a disk or a segment, which needs no mask.
layout(location = 0) in vec4 pixels;  // left, top, width, height; centre, radius, stroke; from, to
layout(location = 1) in vec2 atlas;   // of its upper left texel; (-1, 0); (-2, half the width)
layout(location = 2) in vec4 underColor;
layout(location = 3) in vec4 overColor;
uniform vec2 pictureSize;
out vec2 texel;                       // of a disk or a segment: pixels from its middle or its start
flat out vec4 under, over, shape;     // shape: kind, and what the kind needs

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  vec2 at = pixels.xy + corner * pixels.zw;
  texel = atlas + corner * pixels.zw;
  shape = vec4(0.0);
  if (atlas.x == -1.0) {
    texel = (2.0 * corner - 1.0) * (pixels.z + 1.0);
    at = pixels.xy + texel;
    shape = vec4(1.0, pixels.zw, 0.0);
  } else if (atlas.x == -2.0) {
    vec2 way = pixels.zw - pixels.xy;
    float reach = length(way), margin = atlas.y + 3.0;
    vec2 forward = reach > 1e-6 ? way / reach : vec2(1.0, 0.0);
    texel = vec2(mix(-margin, reach + margin, corner.x), mix(-margin, margin, corner.y));
    at = pixels.xy + forward * texel.x + vec2(-forward.y, forward.x) * texel.y;
    shape = vec4(2.0, reach, atlas.y, 0.0);
  }
  under = underColor;
  over = overColor;
  gl_Position = vec4(2.0 * at / pictureSize - 1.0, 0.0, 1.0);
}
