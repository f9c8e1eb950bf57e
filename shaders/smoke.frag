#version 330 core
// Smoke of any number of colours (linear light). Pigments mix by their share of the density, and what is behind shines
// through by the law of Beer and Lambert: share = exp(-thickness * density).
uniform sampler2D lattice;   // ONE_COLOR: density in r. Else: sum of color * density in rgb, sum of density in a
uniform vec4 color;          // ONE_COLOR: the colour
uniform float thickness;     // of the smoke, per unit of its value, times log2(e)
uniform float opacity;
in vec2 place;
out vec4 fragment;

void main() {
  vec4 smoke = texture(lattice, place);
#ifdef ONE_COLOR
  float alpha = 1.0 - exp2(-thickness * max(smoke.r, 0.0));
  vec3 mixed = color.rgb;
#else
  float alpha = 1.0 - exp2(-thickness * max(smoke.a, 0.0));
  vec3 mixed = clamp(smoke.rgb / max(smoke.a, 1e-9), 0.0, 1.0);
#endif
  alpha *= opacity;
  fragment = alpha * vec4(mixed, 1.0);
}
