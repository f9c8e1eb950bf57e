// Cell values as a smooth surface: a uniform cubic B-spline, refined on the CPU by subdivision until a texel
// is no wider than two pixels, then a texture read with one bilinear tap. One tap, because a tap is what a
// CPU rasteriser pays for: the usual four taps a pixel cost three times the whole frame.
//
// Subdivision (Lane and Riesenfeld 1980): each refinement puts points at the old ones, (1 6 1)/8 of the
// neighbours, and half-way between, (1 1)/2, in x and in y. Cells smaller than a pixel are averaged in pairs
// instead. Limits: the surface approximates, it does not pass through the values: a lone peak is lowered by
// 5/9.
#pragma once
#include <vector>

#include "render/picture_frame.h"

namespace smokebox {

/// Samples on a lattice with `channels` interleaved floats each.
struct Lattice {
  int nx = 0, ny = 0, channels = 1;
  Vec2 origin;         // the sample (0, 0), m
  double spacing = 0;  // m
  std::vector<float> values;

  void resize(int newNx, int newNy, int newChannels) {
    nx = newNx, ny = newNy, channels = newChannels;
    values.resize(std::size_t(nx) * ny * channels);
  }
  float* row(int j) { return values.data() + std::size_t(j) * nx * channels; }
  const float* row(int j) const { return values.data() + std::size_t(j) * nx * channels; }
};

/// The cells (or nodes) that a picture needs to show its part of the domain: the visible ones and a margin
/// for the spline. Indices outside of the field are to be read by `wrap`.
struct LatticeWindow {
  int i0 = 0, i1 = 0, j0 = 0, j1 = 0;  // first and past the last
  int nx() const { return i1 - i0; }
  int ny() const { return j1 - j0; }
};
/// `first`: where sample (0, 0) is, m (half a cell for centres, 0 for nodes); nx, ny: how many there are.
LatticeWindow visibleWindow(const PictureFrame& frame, const Grid& grid, Vec2 first, int nx, int ny);

/// An index beyond the end, clamped, or wrapped where the domain is periodic with `period` cells (0:
/// clamped).
inline int wrapIndex(int i, int n, int period) {
  if (period > 0) i = ((i % period) + period) % period;
  return i < 0 ? 0 : i >= n ? n - 1 : i;
}

/// Refines (or thins out) `lattice` in place for a picture of `pixelsPerMetre`; `scratch` keeps its memory.
void smoothFor(Lattice& lattice, double pixelsPerMetre, Lattice& scratch);

}  // namespace smokebox
