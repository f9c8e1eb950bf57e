#version 330 core
// A scalar field, its samples already in the colours of its map.
uniform sampler2D lattice;  // linear light
uniform float opacity;
in vec2 place;
out vec4 fragment;

void main() { fragment = opacity * vec4(texture(lattice, place).rgb, 1.0); }
