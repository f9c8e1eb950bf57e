// A byte for each face, with the margins of a Field: what the stencils may use of it.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/field.h"

namespace smokebox {

struct Vec2i {
  int i = 0, j = 0;
};

class FaceMap {
 public:
  FaceMap() = default;
  FaceMap(int nx, int ny)
      : stride_((nx + 2 * Field::kMarginX + 63) / 64 * 64),
        data_(static_cast<std::size_t>(stride_) * (ny + 2 * Field::kMarginY), 0) {}

  std::uint8_t* row(int j) { return data_.data() + (j + Field::kMarginY) * stride_ + Field::kMarginX; }
  const std::uint8_t* row(int j) const {
    return data_.data() + (j + Field::kMarginY) * stride_ + Field::kMarginX;
  }
  std::uint8_t& operator()(int i, int j) { return row(j)[i]; }
  std::uint8_t operator()(int i, int j) const { return row(j)[i]; }
  void fill(std::uint8_t value) { std::fill(data_.begin(), data_.end(), value); }
  std::size_t bytes() const { return data_.size(); }

 private:
  std::ptrdiff_t stride_ = 0;
  std::vector<std::uint8_t> data_;
};

}  // namespace smokebox
