#version 330 core
// An arrow in a rectangle of its own, turned along it.
layout(location = 0) in vec4 tailAndVector;  // pixels
uniform vec2 pictureSize;
uniform float halfWidth;                     // of the shaft, pixels
out vec2 along;                              // pixels from the tail, along and across
flat out float reach;

void main() {
  vec2 vector = tailAndVector.zw;
  reach = length(vector);
  vec2 forward = reach > 1e-6 ? vector / reach : vec2(1.0, 0.0);
  float margin = 6.0 * halfWidth + 2.0;
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  along = vec2(mix(-margin, reach + margin, corner.x), mix(-margin, margin, corner.y));
  vec2 at = tailAndVector.xy + forward * along.x + vec2(-forward.y, forward.x) * along.y;
  gl_Position = vec4(2.0 * at / pictureSize - 1.0, 0.0, 1.0);
}
