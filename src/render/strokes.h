// Lines through many points that may taper and fade, many of them in one draw call. Neighbouring pieces meet
// on their bisector, so that a translucent line is nowhere painted twice; ends are round.
#pragma once
#include <optional>
#include <vector>

#include "geometry/vec2.h"
#include "render/batches.h"
#include "render/gl_objects.h"

namespace smokebox {

class StrokeBatch {
 public:
  /// Its shaders are built when the first line is drawn.
  StrokeBatch(const Gl& gl, int pictureWidth, int pictureHeight)
      : gl_(gl), pictureWidth_(pictureWidth), pictureHeight_(pictureHeight) {}

  /// How a line looks at one of its points.
  struct Look {
    double width = 1;
    LinearColor color{};
  };

  /// Through `points` (pixels), with one look for all of it. Two equal points in a row are taken for one.
  void add(const std::vector<Vec2>& points, const Look& look);
  /// With a look for each point.
  void add(const std::vector<Vec2>& points, const std::vector<Look>& looks);
  /// Closed: the last point is joined to the first.
  void addLoop(const std::vector<Vec2>& points, const Look& look);
  void flush();

 private:
  void addPiece(Vec2 before, Vec2 from, Vec2 to, Vec2 after, const Look& first, const Look& last);

  const Gl& gl_;
  int pictureWidth_, pictureHeight_;
  std::optional<GlProgram> program_;
  std::optional<GlInstances> instances_;
  std::vector<float> records_;
};

}  // namespace smokebox
