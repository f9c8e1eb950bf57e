#version 330 core
// A piece of a line that may taper and fade, in a rectangle of its own, turned along it. Where it meets its neighbours it
// ends on the bisector, so that nothing is painted twice.
layout(location = 0) in vec4 beforeAndFrom;  // pixels; before = from where the line starts
layout(location = 1) in vec4 toAndAfter;     // after = to where it ends
layout(location = 2) in vec2 halfWidths;     // at its ends, pixels
layout(location = 3) in vec4 fromColor;      // premultiplied, linear light
layout(location = 4) in vec4 toColor;
uniform vec2 pictureSize;
out vec2 along;                              // pixels from its start, along and across
flat out float reach;
flat out vec2 halves;
flat out vec4 cuts;                          // normals of the cuts at its ends, along and across; zero: none
flat out vec4 colorFrom, colorTo;

vec2 cut(vec2 forward, vec2 neighbour) {
  if (dot(neighbour, neighbour) < 1e-12) return vec2(0.0);
  vec2 normal = forward + normalize(neighbour);
  return vec2(dot(normal, forward), dot(normal, vec2(-forward.y, forward.x)));
}

void main() {
  vec2 from = beforeAndFrom.zw, to = toAndAfter.xy;
  vec2 way = to - from;
  reach = length(way);
  vec2 forward = reach > 1e-6 ? way / reach : vec2(1.0, 0.0);
  float margin = max(halfWidths.x, halfWidths.y) + 1.0;
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  along = vec2(mix(-margin, reach + margin, corner.x), mix(-margin, margin, corner.y));
  halves = halfWidths;
  cuts = vec4(cut(forward, from - beforeAndFrom.xy), cut(forward, toAndAfter.zw - to));
  colorFrom = fromColor;
  colorTo = toColor;
  vec2 at = from + forward * along.x + vec2(-forward.y, forward.x) * along.y;
  gl_Position = vec4(2.0 * at / pictureSize - 1.0, 0.0, 1.0);
}
