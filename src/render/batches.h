// Many small quads in one draw call: sprites (masks with two colours, gathered in one atlas texture; disks
// and segments, which need no mask) and panels (rectangles with rounded corners). Colours are premultiplied
// and in linear light.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "base/color.h"
#include "render/gl_objects.h"
#include "render/mask.h"

namespace smokebox {

using LinearColor = std::array<float, 4>;

/// From sRGB, premultiplied with `alpha`.
LinearColor linear(const Color& color, double alpha = 1);
/// Of two sRGB colours, mixed as they are encoded: share 0 is a, 1 is b.
/// Relative luminance, Rec. 709, of a colour as it is encoded: 0 to 1.
double luminance(const Color& color);
Color mixed(const Color& a, const Color& b, double share);

class SpriteBatch {
 public:
  SpriteBatch(const Gl& gl, int pictureWidth, int pictureHeight);
  /// Drawn by flush(), later ones over earlier ones; flushes by itself when the atlas is full.
  void add(const Mask& mask, const LinearColor& under, const LinearColor& over);
  /// Its outline, `stroke` pixels wide, lies inside of the radius; without a stroke it is all of one colour.
  void addDisk(Vec2 centre, double radius, const LinearColor& fill, double stroke = 0,
               const LinearColor& outline = {});
  /// With round ends, and a thin halo of another colour.
  void addSegment(Vec2 from, Vec2 to, double width, const LinearColor& color, const LinearColor& halo = {});
  void flush();

 private:
  bool unseen(Vec2 low, Vec2 high, double margin) const;
  void copyIn(const Mask& mask, int fromRow, int rows);

  const Gl& gl_;
  int pictureWidth_, pictureHeight_;
  GlProgram program_;
  GlTexture atlas_;  // of masks; empty until there is one
  GlInstances instances_;
  std::vector<float> records_;
  std::vector<std::uint8_t> texels_;  // of the atlas, two bytes each
  int atlasWidth_, shelfX_ = 0, shelfY_ = 0, shelfHeight_ = 0;
};

class PanelBatch {
 public:
  PanelBatch(const Gl& gl, int pictureWidth, int pictureHeight);
  void add(double left, double top, double right, double bottom, const LinearColor& fill,
           const LinearColor& border = {}, double radius = 0, double borderWidth = 0);
  void flush();

 private:
  int pictureWidth_, pictureHeight_;
  GlProgram program_;
  GlInstances instances_;
  std::vector<float> records_;
};

}  // namespace smokebox
