#version 330 core
// Coverage from the distance to the piece; what is thinner than a pixel fades instead.
in vec2 along;
flat in float reach;
flat in vec2 halves;
flat in vec4 cuts;
flat in vec4 colorFrom, colorTo;
out vec4 fragment;

void main() {
  if (dot(along, cuts.xy) < 0.0 || dot(along - vec2(reach, 0.0), cuts.zw) > 0.0) discard;
  float x = clamp(along.x, 0.0, reach);
  float share = reach > 0.0 ? x / reach : 0.0;
  float halfWidth = mix(halves.x, halves.y, share);
  float distance = length(vec2(along.x - x, along.y));
  float coverage = clamp(max(halfWidth, 0.5) - distance + 0.5, 0.0, 1.0) * min(1.0, 2.0 * halfWidth);
  fragment = mix(colorFrom, colorTo, share) * coverage;
}
