#include "render/picture_frame.h"

#include <algorithm>

#include "render/batches.h"

namespace smokebox {

namespace {
constexpr double kDarkGround = 0.18;  // luminance below it
}  // namespace

PictureFrame frameOf(const Snapshot& snapshot, int width, int height) {
  const Grid& grid = snapshot.grid;
  const CameraSpec& camera = snapshot.view.camera;
  PictureFrame frame;
  frame.width = width;
  frame.height = height;
  frame.scale =
      camera.height ? height / *camera.height : std::min(width / grid.width(), height / grid.height());
  const Vec2 middle{grid.width() / 2, grid.height() / 2};
  frame.centre = camera.center.value_or(middle);
  if (!camera.follow.empty()) {
    const auto followed = std::find_if(snapshot.solids.begin(), snapshot.solids.end(),
                                       [&](const SolidPicture& s) { return s.name == camera.follow; });
    if (followed != snapshot.solids.end())
      frame.centre = followed->pose.position + camera.center.value_or(Vec2{});
    else if (snapshot.followed)
      frame.centre = *snapshot.followed + camera.center.value_or(Vec2{});
  }
  const Vec2 upperLeft = frame.toPixels({0, grid.height()});
  const Vec2 lowerRight = frame.toPixels({grid.width(), 0});
  frame.left = upperLeft.x;
  frame.top = upperLeft.y;
  frame.right = lowerRight.x;
  frame.bottom = lowerRight.y;
  // A tall picture has no room for the letters that its height would allow.
  frame.unit = std::min(height / 720.0, width / 880.0);
  frame.darkGround = luminance(snapshot.view.background) < kDarkGround;
  return frame;
}

}  // namespace smokebox
