#version 330 core
// Two coverages, one over the other: a fill below its outline, a halo below its letters.
uniform sampler2D masks;          // r: coverage of what is under, g: of what is over
in vec2 texel;
flat in vec4 under, over, shape;  // colours are premultiplied, linear light
out vec4 fragment;

// The outline lies inside of a disk; together they cover what the disk covers.
vec2 disk(float radius, float stroke) {
  float depth = radius - length(texel);
  float fill = clamp(depth + 0.5, 0.0, 1.0) * min(1.0, 2.0 * radius);
  float line = stroke > 0.0 ? fill * clamp(stroke - depth + 0.5, 0.0, 1.0) : 0.0;
  return vec2(line < 1.0 ? (fill - line) / (1.0 - line) : 0.0, line);
}

vec2 segment(float reach, float halfWidth) {
  float depth = halfWidth - length(vec2(texel.x - clamp(texel.x, 0.0, reach), texel.y));
  return clamp(vec2(depth + 1.7, depth + 0.5), 0.0, 1.0);
}

void main() {
  vec2 coverage;
  if (shape.x == 0.0)
    coverage = texelFetch(masks, ivec2(texel), 0).rg;
  else if (shape.x == 1.0)
    coverage = disk(shape.y, shape.z);
  else
    coverage = segment(shape.y, shape.z);
  vec4 top = over * coverage.g;
  fragment = top + under * coverage.r * (1.0 - top.a);
}
