#include "render/batches.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace smokebox {

namespace {
constexpr int kAtlasRows = 4096;

float toLinear(float c) { return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f); }
}  // namespace

LinearColor linear(const Color& color, double alpha) {
  const float a = static_cast<float>(alpha);
  return {toLinear(color.r) * a, toLinear(color.g) * a, toLinear(color.b) * a, a};
}

double luminance(const Color& color) {
  return 0.2126 * toLinear(color.r) + 0.7152 * toLinear(color.g) + 0.0722 * toLinear(color.b);
}

Color mixed(const Color& a, const Color& b, double share) {
  const float s = static_cast<float>(share);
  return {a.r + s * (b.r - a.r), a.g + s * (b.g - a.g), a.b + s * (b.b - a.b)};
}

SpriteBatch::SpriteBatch(const Gl& gl, int pictureWidth, int pictureHeight)
    : gl_(gl),
      pictureWidth_(pictureWidth),
      pictureHeight_(pictureHeight),
      program_(gl, "sprite.vert", "sprite.frag"),
      atlas_(gl, GL_RG8, GL_RG, GL_UNSIGNED_BYTE, GL_NEAREST),
      instances_(gl, {4, 2, 4, 4}),
      atlasWidth_(std::max(pictureWidth, 512)) {}

void SpriteBatch::add(const Mask& mask, const LinearColor& under, const LinearColor& over) {
  if (mask.empty()) return;
  // A mask is never wider than the picture, so it fits into a shelf; a tall one goes in by parts.
  for (int fromRow = 0; fromRow < mask.height; fromRow += kAtlasRows) {
    const int rows = std::min(kAtlasRows, mask.height - fromRow);
    if (shelfX_ + mask.width > atlasWidth_) {
      shelfY_ += shelfHeight_;
      shelfX_ = shelfHeight_ = 0;
    }
    if (shelfY_ + rows > kAtlasRows) flush();
    copyIn(mask, fromRow, rows);
    records_.insert(records_.end(), {float(mask.x), float(mask.y + fromRow), float(mask.width), float(rows),
                                     float(shelfX_), float(shelfY_)});
    records_.insert(records_.end(), under.begin(), under.end());
    records_.insert(records_.end(), over.begin(), over.end());
    shelfX_ += mask.width;
    shelfHeight_ = std::max(shelfHeight_, rows);
  }
}

bool SpriteBatch::unseen(Vec2 low, Vec2 high, double margin) const {
  // Written so that a place that is no number is unseen.
  return !(high.x > -margin && high.y > -margin && low.x < pictureWidth_ + margin &&
           low.y < pictureHeight_ + margin);
}

void SpriteBatch::addDisk(Vec2 centre, double radius, const LinearColor& fill, double stroke,
                          const LinearColor& outline) {
  if (unseen(centre, centre, radius + 1)) return;
  records_.insert(records_.end(), {float(centre.x), float(centre.y), float(radius), float(stroke), -1, 0});
  records_.insert(records_.end(), fill.begin(), fill.end());
  records_.insert(records_.end(), outline.begin(), outline.end());
}

void SpriteBatch::addSegment(Vec2 from, Vec2 to, double width, const LinearColor& color,
                             const LinearColor& halo) {
  if (unseen({std::min(from.x, to.x), std::min(from.y, to.y)},
             {std::max(from.x, to.x), std::max(from.y, to.y)}, width + 3))
    return;
  records_.insert(records_.end(),
                  {float(from.x), float(from.y), float(to.x), float(to.y), -2, float(0.5 * width)});
  records_.insert(records_.end(), halo.begin(), halo.end());
  records_.insert(records_.end(), color.begin(), color.end());
}

void SpriteBatch::copyIn(const Mask& mask, int fromRow, int rows) {
  const std::size_t needed = std::size_t(2) * atlasWidth_ * (shelfY_ + std::max(shelfHeight_, rows));
  if (texels_.size() < needed) texels_.resize(needed);
  for (int row = 0; row < rows; ++row)
    std::memcpy(texels_.data() + 2 * (std::size_t(shelfY_ + row) * atlasWidth_ + shelfX_),
                mask.coverage.data() + 2 * std::size_t(fromRow + row) * mask.width,
                std::size_t(2) * mask.width);
}

void SpriteBatch::flush() {
  if (!records_.empty()) {
    atlas_.bind(0);
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    const int rows = shelfY_ + shelfHeight_;
    if (rows > 0) atlas_.upload(atlasWidth_, rows, texels_.data());
    program_.use();
    program_.set("masks", 0);
    program_.set("pictureSize", float(pictureWidth_), float(pictureHeight_));
    instances_.draw(records_);
  }
  records_.clear();
  shelfX_ = shelfY_ = shelfHeight_ = 0;
}

PanelBatch::PanelBatch(const Gl& gl, int pictureWidth, int pictureHeight)
    : pictureWidth_(pictureWidth),
      pictureHeight_(pictureHeight),
      program_(gl, "panel.vert", "panel.frag"),
      instances_(gl, {4, 4, 4, 2}) {}

void PanelBatch::add(double left, double top, double right, double bottom, const LinearColor& fill,
                     const LinearColor& border, double radius, double borderWidth) {
  records_.insert(records_.end(), {float(left), float(top), float(right), float(bottom)});
  records_.insert(records_.end(), fill.begin(), fill.end());
  records_.insert(records_.end(), border.begin(), border.end());
  records_.insert(records_.end(), {float(radius), float(borderWidth)});
}

void PanelBatch::flush() {
  if (records_.empty()) return;
  program_.use();
  program_.set("pictureSize", float(pictureWidth_), float(pictureHeight_));
  instances_.draw(records_);
  records_.clear();
}

}  // namespace smokebox
