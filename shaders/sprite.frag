#version 330 core
// Two coverages, one over the other: a fill below its outline, a halo below its letters.
uniform sampler2D masks;   // r: coverage of what is under, g: of what is over
in vec2 texel;
flat in vec4 under, over;  // premultiplied, linear light
out vec4 fragment;

void main() {
  vec2 coverage = texelFetch(masks, ivec2(texel), 0).rg;
  vec4 top = over * coverage.g;
  fragment = top + under * coverage.r * (1.0 - top.a);
}
