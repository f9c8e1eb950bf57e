#version 330 core
// One cell of a sheet, shaded smoothly between its corners. Cells that share corners leave no gap.
layout(location = 0) in vec4 lowerCorners;    // left, right; pixels
layout(location = 1) in vec4 upperCorners;
layout(location = 2) in vec4 lowerLeftColor;  // premultiplied, linear light
layout(location = 3) in vec4 lowerRightColor;
layout(location = 4) in vec4 upperLeftColor;
layout(location = 5) in vec4 upperRightColor;
uniform vec2 pictureSize;
out vec4 color;

void main() {
  bool lower = gl_VertexID < 2, left = (gl_VertexID & 1) == 0;
  vec4 side = lower ? lowerCorners : upperCorners;
  vec2 at = left ? side.xy : side.zw;
  color = lower ? (left ? lowerLeftColor : lowerRightColor) : (left ? upperLeftColor : upperRightColor);
  gl_Position = vec4(2.0 * at / pictureSize - 1.0, 0.0, 1.0);
}
