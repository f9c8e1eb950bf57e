#version 330 core
// Distances to a shaft and a triangular head make the shape; a halo keeps it legible on any ground. Where the fluid is
// almost still only a dot is left.
uniform float halfWidth, haloWidth;
uniform vec4 color, haloColor;  // premultiplied, linear light
in vec2 along;
flat in float reach;
out vec4 fragment;

float segment(vec2 p, float from, float to) { return length(vec2(p.x - clamp(p.x, from, to), p.y)); }

// Signed distance to the triangle with its tip at (tip, 0) and its base of half width b at tip - l.
float head(vec2 p, float tip, float l, float b) {
  p = vec2(p.x - tip + l, abs(p.y));  // base on x = 0, tip at (l, 0)
  vec2 side = vec2(l, -b);
  vec2 onSide = p - vec2(0.0, b) - side * clamp(dot(p - vec2(0.0, b), side) / dot(side, side), 0.0, 1.0);
  vec2 onBase = p - vec2(0.0, min(p.y, b));
  float outside = max(dot(p - vec2(0.0, b), normalize(vec2(b, l))), -p.x);
  return sign(outside) * sqrt(min(dot(onSide, onSide), dot(onBase, onBase)));
}

void main() {
  float length_ = min(6.5 * halfWidth, 0.55 * reach);          // of the head
  float breadth = length_ * 0.45;
  float distance;
  if (reach < 2.0 * halfWidth)
    distance = segment(along, 0.0, reach) - 1.3 * halfWidth;
  else
    distance = min(segment(along, 0.0, max(reach - length_, 0.0)) - halfWidth, head(along, reach, length_, breadth));
  vec4 over = color * clamp(0.5 - distance, 0.0, 1.0);
  vec4 under = haloColor * clamp(0.5 + haloWidth - distance, 0.0, 1.0);
  fragment = over + under * (1.0 - over.a);
}
