#version 330 core
// The strip of a colour bar: the value runs along `place`.
#include "colormap.glsl"
uniform vec2 valueRange;
in vec2 place;
out vec4 fragment;

void main() { fragment = vec4(mapped(mix(valueRange.x, valueRange.y, place.y)), 1.0); }
