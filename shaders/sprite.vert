#version 330 core
// A mask of the atlas, laid on whole pixels.
layout(location = 0) in vec4 pixels;  // left, top, width, height
layout(location = 1) in vec2 atlas;   // of its upper left texel
layout(location = 2) in vec4 underColor;
layout(location = 3) in vec4 overColor;
uniform vec2 pictureSize;
out vec2 texel;
flat out vec4 under, over;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  texel = atlas + corner * pixels.zw;
  under = underColor;
  over = overColor;
  gl_Position = vec4(2.0 * (pixels.xy + corner * pixels.zw) / pictureSize - 1.0, 0.0, 1.0);
}
