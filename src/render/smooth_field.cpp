#include "render/smooth_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace smokebox {

namespace {
constexpr int kMargin = 3;  // samples beyond what is seen: the spline's reach, and what refining takes off
constexpr double kTexelPixels = 2.0;    // refine until a texel is no wider
constexpr double kTooFinePixels = 0.6;  // cells smaller than this are averaged

/// Subdivides the rows of `in` along x into out, (2 nx - 3) samples each.
void refineRow(const float* in, int nx, int channels, float* out) {
  for (int i = 0; i + 1 < nx; ++i) {
    const float* a = in + i * channels;
    float* mid = out + std::size_t(2) * i * channels;
    for (int c = 0; c < channels; ++c) mid[c] = 0.5f * (a[c] + a[c + channels]);
    if (i + 2 == nx) break;
    for (int c = 0; c < channels; ++c)
      mid[channels + c] = 0.125f * (a[c] + a[c + 2 * channels]) + 0.75f * a[c + channels];
  }
}

/// A single channel at constant stride, which the compiler turns into vectors.
void refineRow1(const float* __restrict in, int nx, float* __restrict out) {
  for (int i = 0; i + 2 < nx; ++i) {
    out[2 * i] = 0.5f * (in[i] + in[i + 1]);
    out[2 * i + 1] = 0.125f * (in[i] + in[i + 2]) + 0.75f * in[i + 1];
  }
  out[2 * (nx - 2)] = 0.5f * (in[nx - 2] + in[nx - 1]);
}

void refineRow4(const float* __restrict in, int nx, float* __restrict out) {
  for (int i = 0; i + 2 < nx; ++i)
    for (int c = 0; c < 4; ++c) {
      out[8 * i + c] = 0.5f * (in[4 * i + c] + in[4 * i + 4 + c]);
      out[8 * i + 4 + c] = 0.125f * (in[4 * i + c] + in[4 * i + 8 + c]) + 0.75f * in[4 * i + 4 + c];
    }
  for (int c = 0; c < 4; ++c) out[8 * (nx - 2) + c] = 0.5f * (in[4 * (nx - 2) + c] + in[4 * (nx - 1) + c]);
}

/// Subdivides once: n samples become 2 n - 3, the first half a spacing further in.
void refine(const Lattice& in, Lattice& out) {
  out.resize(2 * in.nx - 3, 2 * in.ny - 3, in.channels);
  out.spacing = in.spacing / 2;
  out.origin = {in.origin.x + in.spacing / 2, in.origin.y + in.spacing / 2};
  const std::size_t n = std::size_t(in.nx) * in.channels;
  std::vector<float> mixed(n);
  auto alongX = [&](const float* row, float* to) {
    if (in.channels == 1)
      refineRow1(row, in.nx, to);
    else if (in.channels == 4)
      refineRow4(row, in.nx, to);
    else
      refineRow(row, in.nx, in.channels, to);
  };
  for (int j = 0; j + 1 < in.ny; ++j) {
    const float* a = in.row(j);
    const float* b = in.row(j + 1);
    for (std::size_t k = 0; k < n; ++k) mixed[k] = 0.5f * (a[k] + b[k]);
    alongX(mixed.data(), out.row(2 * j));
    if (j + 2 == in.ny) break;
    const float* c = in.row(j + 2);
    for (std::size_t k = 0; k < n; ++k) mixed[k] = 0.125f * (a[k] + c[k]) + 0.75f * b[k];
    alongX(mixed.data(), out.row(2 * j + 1));
  }
}

/// Averages blocks of two by two samples; an odd last row or column stands for itself.
void halve(const Lattice& in, Lattice& out) {
  out.resize((in.nx + 1) / 2, (in.ny + 1) / 2, in.channels);
  out.spacing = in.spacing * 2;
  out.origin = {in.origin.x + in.spacing / 2, in.origin.y + in.spacing / 2};
  for (int j = 0; j < out.ny; ++j) {
    const float* a = in.row(2 * j);
    const float* b = in.row(std::min(2 * j + 1, in.ny - 1));
    for (int i = 0; i < out.nx; ++i) {
      const std::size_t left = std::size_t(2) * i * in.channels;
      const std::size_t right = std::size_t(std::min(2 * i + 1, in.nx - 1)) * in.channels;
      for (int c = 0; c < in.channels; ++c)
        out.row(j)[i * in.channels + c] = 0.25f * (a[left + c] + a[right + c] + b[left + c] + b[right + c]);
    }
  }
}
}  // namespace

LatticeWindow visibleWindow(const PictureFrame& frame, const Grid& grid, Vec2 first, int nx, int ny) {
  const Vec2 low = frame.toWorld({0, double(frame.height)});
  const Vec2 high = frame.toWorld({double(frame.width), 0});
  auto range = [&](double from, double to, double offset, int n, int& i0, int& i1) {
    const double a = std::clamp((from - offset) / grid.h, -1.0, double(n));
    const double b = std::clamp((to - offset) / grid.h, -1.0, double(n));
    i0 = static_cast<int>(std::floor(a)) - kMargin + 1;
    i1 = static_cast<int>(std::ceil(b)) + kMargin;
    i0 = std::min(i0, n - kMargin);
    i1 = std::max(i1, i0 + 2 * kMargin + 1);
  };
  LatticeWindow window;
  range(low.x, high.x, first.x, nx, window.i0, window.i1);
  range(low.y, high.y, first.y, ny, window.j0, window.j1);
  return window;
}

void smoothFor(Lattice& lattice, double pixelsPerMetre, Lattice& scratch) {
  while (lattice.spacing * pixelsPerMetre < kTooFinePixels && std::max(lattice.nx, lattice.ny) > 2) {
    halve(lattice, scratch);
    std::swap(lattice, scratch);
  }
  while (lattice.spacing * pixelsPerMetre > kTexelPixels) {
    refine(lattice, scratch);
    std::swap(lattice, scratch);
  }
}

}  // namespace smokebox
