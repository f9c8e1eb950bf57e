#version 330 core
// A spring in a rectangle of its own, turned along it.
layout(location = 0) in vec4 fromAndTo;  // pixels
layout(location = 1) in vec4 coils;      // straight length at each end, period, amplitude; half the width of the wire
layout(location = 2) in vec4 wireColor;  // premultiplied, linear light
uniform vec2 pictureSize;
uniform float margin;                    // what halo and eyes need beyond the wire, pixels
out vec2 along;                          // pixels from its start, along and across
flat out float reach;
flat out vec4 shape, color;

void main() {
  vec2 way = fromAndTo.zw - fromAndTo.xy;
  reach = length(way);
  vec2 forward = reach > 1e-6 ? way / reach : vec2(1.0, 0.0);
  float side = coils.z + coils.w + margin, end = coils.w + margin;
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  along = vec2(mix(-end, reach + end, corner.x), mix(-side, side, corner.y));
  shape = coils;
  color = wireColor;
  vec2 at = fromAndTo.xy + forward * along.x + vec2(-forward.y, forward.x) * along.y;
  gl_Position = vec4(2.0 * at / pictureSize - 1.0, 0.0, 1.0);
}
