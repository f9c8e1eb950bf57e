#version 330 core
// A scalar field in colours.
#include "colormap.glsl"
uniform sampler2D lattice;  // the value in r
uniform float opacity;
in vec2 place;
out vec4 fragment;

void main() { fragment = opacity * vec4(mapped(texture(lattice, place).r), 1.0); }
