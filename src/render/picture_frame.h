// How the world lies in the picture: the camera, and the sizes that follow the picture's height.
//
// Pixels count from the picture's upper left corner, x right, y down, as OpenGL draws here (row 0 of the
// target is the top row), so that nothing is ever flipped; the world's y goes up.
#pragma once
#include "geometry/vec2.h"
#include "world/snapshot.h"

namespace smokebox {

struct PictureFrame {
  int width = 0, height = 0;   // of the picture, pixels
  double scale = 1;            // pixels per metre
  Vec2 centre;                 // the world's point in the middle of the picture, m
  double left = 0, right = 0;  // of the domain, pixels
  double top = 0, bottom = 0;
  double unit = 1;  // 1 at a height of 720 (unless too narrow): line widths and fonts are in these
  bool darkGround = true;

  Vec2 toPixels(Vec2 world) const {
    return {width / 2.0 + (world.x - centre.x) * scale, height / 2.0 - (world.y - centre.y) * scale};
  }
  Vec2 toWorld(Vec2 pixel) const {
    return {centre.x + (pixel.x - width / 2.0) / scale, centre.y - (pixel.y - height / 2.0) / scale};
  }
  /// A line's width in pixels, never thinner than one.
  double line(double units) const { return units * unit > 1 ? units * unit : 1; }
};

/// The whole domain fits, or what view.camera says. A camera that follows a solid which is not shown stands
/// still.
PictureFrame frameOf(const Snapshot& snapshot, int width, int height);

}  // namespace smokebox
