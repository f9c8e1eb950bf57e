// Colour maps as polynomials in sRGB (image/colormap.h says which), evaluated to linear light.
uniform vec3 positiveArm[7], negativeArm[7];
uniform vec4 scale;  // value of the middle; factor above it; factor below it

vec3 mapped(float value) {
  float offset = value - scale.x;
  float u = min(abs(offset * (offset < 0.0 ? scale.z : scale.y)), 1.0);
  vec3 above = positiveArm[6], below = negativeArm[6];
  for (int k = 5; k >= 0; --k) {
    above = above * u + positiveArm[k];
    below = below * u + negativeArm[k];
  }
  vec3 c = clamp(offset < 0.0 ? below : above, 0.0, 1.0);
  // sRGB to linear light within 0.1%, without a power.
  return c * (c * (c * 0.305306011 + 0.682171111) + 0.012522878);
}
