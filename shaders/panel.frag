#version 330 core
// The border lies inside the rectangle. A pixel's coverage is taken from the distance of its centre to the edge.
in vec2 fromCentre;
flat in vec2 halfSize, shape;
flat in vec4 fill, border;
out vec4 fragment;

void main() {
  vec2 beyond = abs(fromCentre) - halfSize + shape.x;
  float distance = length(max(beyond, 0.0)) + min(max(beyond.x, beyond.y), 0.0) - shape.x;
  float inside = clamp(0.5 - distance, 0.0, 1.0);
  float interior = clamp(0.5 - distance - shape.y, 0.0, 1.0);
  fragment = mix(border, fill, shape.y > 0.0 ? interior : 1.0) * inside;
}
