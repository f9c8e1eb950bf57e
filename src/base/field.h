// A two-dimensional float array over the cells, faces or nodes of a grid, with a margin all around.
//
// All fields of one grid have the same shape, whatever they sample, so that one offset serves them all:
//   cell (i, j)    covers [i h, (i+1) h] x [j h, (j+1) h]; its centre carries pressure and smoke
//   x-face (i, j)  the left face of cell (i, j), i = 0..nx: carries u
//   y-face (i, j)  the lower face of cell (i, j), j = 0..ny: carries v
//   node (i, j)    the lower left corner of cell (i, j)
// Row j starts on a 64-byte boundary at i = 0. Valid: i in [-kMarginX, nx + kMarginX), j in [-kMarginY, ny +
// kMarginY).
#pragma once
#include <cstddef>
#include <memory>

namespace smokebox {

class Field {
 public:
  static constexpr int kMarginX = 16;  // one cache line: rows stay aligned, stencils and vectors may overrun
  static constexpr int kMarginY = 5;   // the widest stencil reaches four rows from the face beyond the rim

  Field() = default;
  /// nx x ny cells, everything (margin too) set to `value`.
  Field(int nx, int ny, float value = 0);
  Field(const Field& other);
  Field(Field&& other) noexcept;
  Field& operator=(const Field& other);
  Field& operator=(Field&& other) noexcept;
  ~Field() = default;

  int nx() const { return nx_; }
  int ny() const { return ny_; }
  /// Distance from (i, j) to (i, j + 1) in floats; a multiple of 16.
  std::ptrdiff_t stride() const { return stride_; }
  bool empty() const { return nx_ == 0; }
  std::size_t bytes() const { return count() * sizeof(float); }

  float* row(int j) { return origin_ + j * stride_; }
  const float* row(int j) const { return origin_ + j * stride_; }
  float& operator()(int i, int j) { return origin_[j * stride_ + i]; }
  float operator()(int i, int j) const { return origin_[j * stride_ + i]; }

  void fill(float value);
  void swap(Field& other) noexcept;

 private:
  struct Free {
    void operator()(float* p) const;
  };
  std::size_t count() const { return static_cast<std::size_t>(stride_) * (ny_ + 2 * kMarginY); }

  int nx_ = 0, ny_ = 0;
  std::ptrdiff_t stride_ = 0;
  std::unique_ptr<float[], Free> data_;
  float* origin_ = nullptr;  // cell (0, 0)
};

}  // namespace smokebox
