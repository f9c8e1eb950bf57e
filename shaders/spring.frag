#version 330 core
// Distance to a zigzag between two straight ends. The zigzag is its own mirror image at each of its corners, so a pixel is
// folded onto one stroke of it, which is the nearest.
uniform vec4 haloColor;  // premultiplied, linear light
uniform float haloWidth, eyes;  // eyes: radius of the dots at the ends, of wires with coils
in vec2 along;
flat in float reach;
flat in vec4 shape, color;
out vec4 fragment;

float segment(vec2 p, vec2 a, vec2 b) {
  vec2 way = b - a;
  return length(p - a - way * clamp(dot(p - a, way) / max(dot(way, way), 1e-9), 0.0, 1.0));
}

void main() {
  float straight = shape.x, period = shape.y, amplitude = shape.z, halfWidth = shape.w;
  float distance;
  if (period <= 0.0) {
    distance = length(vec2(along.x - clamp(along.x, 0.0, reach), along.y));
  } else {
    distance = min(segment(along, vec2(0.0), vec2(straight, 0.0)),
                   segment(along, vec2(reach - straight, 0.0), vec2(reach, 0.0)));
    if (along.x > straight && along.x < reach - straight) {
      float half_ = 0.5 * period;
      float fromPeak = half_ - abs(mod(along.x - straight - 0.25 * period, period) - half_);
      distance = min(distance, segment(vec2(fromPeak, along.y), vec2(0.0, amplitude), vec2(half_, -amplitude)));
    }
    float eye = min(length(along), length(along - vec2(reach, 0.0))) - eyes + halfWidth;
    distance = min(distance, eye);
  }
  vec4 over = color * clamp(max(halfWidth, 0.5) - distance + 0.5, 0.0, 1.0) * min(1.0, 2.0 * halfWidth);
  vec4 under = haloColor * color.a * clamp(halfWidth + haloWidth - distance + 0.5, 0.0, 1.0);
  fragment = over + under * (1.0 - over.a);
}
