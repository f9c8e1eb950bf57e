#include "coupling/mixed_groups.h"

#include <algorithm>
#include <cmath>

namespace smokebox {

int MixedGroups::binOf(double x, int bins) const {
  return static_cast<int>(std::clamp(std::floor(x * perMetre_), 0.0, bins - 1.0));
}

void MixedGroups::fillBins(const Grid& grid, const std::vector<double>& boxes) {
  columns_ = grid.nx / kWide + 1;
  rows_ = grid.ny / kWide + 1;
  perMetre_ = 1 / (kWide * grid.h);
  const auto each = [&](auto&& body) {
    for (int k = 0; k < static_cast<int>(group_.size()); ++k) {
      if (!has(k)) continue;
      const double *box = &boxes[4 * k], reach = kReach * grid.h;
      const int left = binOf(box[0] - reach, columns_), right = binOf(box[2] + reach, columns_);
      for (int j = binOf(box[1] - reach, rows_), top = binOf(box[3] + reach, rows_); j <= top; ++j)
        for (int i = left; i <= right; ++i) body(k, j * columns_ + i);
    }
  };
  start_.assign(columns_ * rows_ + 1, 0);
  each([this](int, int bin) { ++start_[bin + 1]; });
  for (int bin = 0; bin < columns_ * rows_; ++bin) start_[bin + 1] += start_[bin];
  listed_.resize(start_.back());
  each([this](int solid, int bin) { listed_[start_[bin]++] = solid; });
  std::copy_backward(start_.begin(), start_.end() - 1, start_.end());
  start_[0] = 0;
}

}  // namespace smokebox
