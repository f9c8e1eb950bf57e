#include "base/field.h"

#include <algorithm>
#include <cstdlib>
#include <new>
#include <utility>

namespace smokebox {

void Field::Free::operator()(float* p) const { std::free(p); }

Field::Field(int nx, int ny, float value) : nx_(nx), ny_(ny) {
  stride_ = (static_cast<std::ptrdiff_t>(nx) + 2 * kMarginX + 15) / 16 * 16;
  // A stride of a multiple of 4 KiB would put a column into a handful of cache sets.
  if (stride_ % 1024 == 0) stride_ += 16;
  void* memory = std::aligned_alloc(64, count() * sizeof(float));
  if (!memory) throw std::bad_alloc();
  data_.reset(static_cast<float*>(memory));
  origin_ = data_.get() + kMarginY * stride_ + kMarginX;
  fill(value);
}

Field::Field(const Field& other) { *this = other; }

Field::Field(Field&& other) noexcept { swap(other); }

Field& Field::operator=(const Field& other) {
  if (this == &other) return *this;
  if (other.empty()) {
    Field().swap(*this);
    return *this;
  }
  if (nx_ != other.nx_ || ny_ != other.ny_) Field(other.nx_, other.ny_).swap(*this);
  std::copy_n(other.data_.get(), count(), data_.get());
  return *this;
}

Field& Field::operator=(Field&& other) noexcept {
  swap(other);
  return *this;
}

void Field::fill(float value) { std::fill_n(data_.get(), count(), value); }

void Field::swap(Field& other) noexcept {
  std::swap(nx_, other.nx_);
  std::swap(ny_, other.ny_);
  std::swap(stride_, other.stride_);
  std::swap(data_, other.data_);
  std::swap(origin_, other.origin_);
}

}  // namespace smokebox
