#version 330 core
// A part of the domain as a rectangle: of the picture in pixels, and of the lattice's texture.
layout(location = 0) in vec4 pixels;   // left, top, right, bottom
layout(location = 1) in vec4 texture0; // the texture's coordinates there
uniform vec2 pictureSize;
out vec2 place;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  place = mix(texture0.xy, texture0.zw, corner);
  gl_Position = vec4(2.0 * mix(pixels.xy, pixels.zw, corner) / pictureSize - 1.0, 0.0, 1.0);
}
