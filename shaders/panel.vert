#version 330 core
// A rectangle with rounded corners, drawn with a margin of a pixel for its antialiased edge.
layout(location = 0) in vec4 pixels;       // left, top, right, bottom; fractions of a pixel count
layout(location = 1) in vec4 fillColor;    // premultiplied, linear light
layout(location = 2) in vec4 borderColor;
layout(location = 3) in vec2 radiusAndBorder;
uniform vec2 pictureSize;
out vec2 fromCentre;
flat out vec2 halfSize, shape;
flat out vec4 fill, border;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  vec2 at = mix(pixels.xy - 1.0, pixels.zw + 1.0, corner);
  fromCentre = at - 0.5 * (pixels.xy + pixels.zw);
  halfSize = 0.5 * (pixels.zw - pixels.xy);
  shape = radiusAndBorder;
  fill = fillColor;
  border = borderColor;
  gl_Position = vec4(2.0 * at / pictureSize - 1.0, 0.0, 1.0);
}
