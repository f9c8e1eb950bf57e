#include "render/strokes.h"

#include <algorithm>

#include "base/errors.h"

namespace smokebox {

void StrokeBatch::addPiece(Vec2 before, Vec2 from, Vec2 to, Vec2 after, const Look& first, const Look& last) {
  const double margin = std::max(first.width, last.width) + 1;
  // Written so that a place that is no number is unseen.
  const bool seen = std::max(from.x, to.x) > -margin && std::min(from.x, to.x) < pictureWidth_ + margin &&
                    std::max(from.y, to.y) > -margin && std::min(from.y, to.y) < pictureHeight_ + margin;
  if (!seen) return;
  records_.insert(records_.end(),
                  {float(before.x), float(before.y), float(from.x), float(from.y), float(to.x), float(to.y),
                   float(after.x), float(after.y), float(0.5 * first.width), float(0.5 * last.width)});
  records_.insert(records_.end(), first.color.begin(), first.color.end());
  records_.insert(records_.end(), last.color.begin(), last.color.end());
}

void StrokeBatch::add(const std::vector<Vec2>& points, const Look& look) {
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    addPiece(points[k > 0 ? k - 1 : 0], points[k], points[k + 1], points[std::min(k + 2, points.size() - 1)],
             look, look);
}

void StrokeBatch::add(const std::vector<Vec2>& points, const std::vector<Look>& looks) {
  checkInvariant(points.size() == looks.size(), "a line has a look for each point");
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    addPiece(points[k > 0 ? k - 1 : 0], points[k], points[k + 1], points[std::min(k + 2, points.size() - 1)],
             looks[k], looks[k + 1]);
}

void StrokeBatch::addLoop(const std::vector<Vec2>& points, const Look& look) {
  const std::size_t n = points.size();
  for (std::size_t k = 0; k < n; ++k)
    addPiece(points[(k + n - 1) % n], points[k], points[(k + 1) % n], points[(k + 2) % n], look, look);
}

void StrokeBatch::flush() {
  if (records_.empty()) return;
  if (!program_) {
    program_.emplace(gl_, "stroke.vert", "stroke.frag");
    instances_.emplace(gl_, std::vector<int>{4, 4, 2, 4, 4});
  }
  program_->use();
  program_->set("pictureSize", float(pictureWidth_), float(pictureHeight_));
  instances_->draw(records_);
  records_.clear();
}

}  // namespace smokebox
