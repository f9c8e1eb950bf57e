#include "rigid/spring_bands.h"

#include <algorithm>
#include <map>

#include "rigid/lanes.h"

namespace smokebox {

namespace {
// A band has at least one spring to so many nodes.
constexpr int kSparse = 8;
// Fewer nodes than this are not worth another thread.
constexpr int kPart = 1200;
}  // namespace

void SpringBands::layOut(int nodes, const std::vector<std::array<int, 2>>& ends) {
  nodes_ = roundedToLanes(nodes);
  const int parts = std::max(1, nodes_ / kPart);
  grain_ = roundedToLanes((nodes_ + parts - 1) / parts);
  bands_.clear();
  looseEnds_.clear();
  slotOf_.assign(ends.size(), -1);
  struct Range {
    int first, last, count;
  };
  std::map<int, Range> ranges;
  for (const auto& [a, b] : ends) {
    Range& range = ranges.try_emplace(b - a, Range{a, a, 0}).first->second;
    range.first = std::min(range.first, a), range.last = std::max(range.last, a);
    ++range.count;
  }
  slots_ = 0;
  before_ = kLanes;
  std::map<int, int> bandOf;
  for (const auto& [offset, range] : ranges) {
    if (kSparse * range.count < nodes) continue;
    const int before = roundedToLanes(offset);
    before_ = std::max(before_, before + kLanes);
    bandOf[offset] = static_cast<int>(bands_.size());
    bands_.push_back(
        {offset, range.first / kLanes * kLanes, roundedToLanes(range.last + 1), slots_ + before});
    slots_ += before + nodes_;
  }
  firstLoose_ = slots_;
  std::vector<char> taken(slots_, 0);
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const auto& [a, b] = ends[k];
    const auto band = bandOf.find(b - a);
    if (band != bandOf.end()) {
      const int slot = bands_[band->second].slot + a;
      if (!taken[slot]) {
        taken[slot] = 1;
        slotOf_[k] = slot;
        continue;
      }
    }
    slotOf_[k] = slots_++;
    looseEnds_.push_back(ends[k]);
  }
}

template <class Number>
double SpringBands::multiplyBands(const SpringMatrices& m, const Number* mass, const NodeField<Number>& p,
                                  NodeField<Number>& out, int first, int last) const {
  using Many = typename LanesOf<Number>::Type;
  const Number *px = p.x(), *py = p.y();
  const float *xx = m.xx.data(), *xy = m.xy.data(), *yy = m.yy.data();
  Number *outX = out.x(), *outY = out.y();
  Many sum{};
  for (int k = first; k < last; k += LanesOf<Number>::kCount) {
    const Many x = load(px + k), y = load(py + k);
    Many sumX{}, sumY{}, along, mixed, across;
    if (mass) {
      const Many own = load(mass + k);
      sumX = own * x, sumY = own * y;
    }
    for (const Band& band : bands_) {
      const std::ptrdiff_t offset = band.offset, next = k + offset, before = k - offset;
      std::ptrdiff_t at = band.slot + k;
      loadAs(xx + at, along), loadAs(xy + at, mixed), loadAs(yy + at, across);
      Many dx = x - load(px + next), dy = y - load(py + next);
      sumX += along * dx + mixed * dy;
      sumY += mixed * dx + across * dy;
      at -= offset;
      loadAs(xx + at, along), loadAs(xy + at, mixed), loadAs(yy + at, across);
      dx = x - load(px + before), dy = y - load(py + before);
      sumX += along * dx + mixed * dy;
      sumY += mixed * dx + across * dy;
    }
    store(outX + k, sumX);
    store(outY + k, sumY);
    sum += x * sumX + y * sumY;
  }
  return sumOf(sum);
}

template <class Number>
double SpringBands::multiplyAs(const SpringMatrices& m, const Number* mass, const NodeField<Number>& p,
                               NodeField<Number>& out, ThreadPool& pool) const {
  double total = pool.sum(0, nodes_, grain_,
                          [&](int first, int last) { return multiplyBands(m, mass, p, out, first, last); });
  const Number *px = p.x(), *py = p.y();
  const float *xx = m.xx.data(), *xy = m.xy.data(), *yy = m.yy.data();
  Number *outX = out.x(), *outY = out.y();
  for (std::size_t k = 0; k < looseEnds_.size(); ++k) {
    const auto& [a, b] = looseEnds_[k];
    const std::size_t s = firstLoose_ + k;
    const Number x = px[b] - px[a], y = py[b] - py[a];
    const Number pullX = xx[s] * x + xy[s] * y, pullY = xy[s] * x + yy[s] * y;
    outX[a] -= pullX, outY[a] -= pullY;
    outX[b] += pullX, outY[b] += pullY;
    total += static_cast<double>(pullX * x + pullY * y);
  }
  return total;
}

double SpringBands::multiply(const SpringMatrices& m, const double* mass, const NodeField<double>& p,
                             NodeField<double>& out, ThreadPool& pool) const {
  return multiplyAs(m, mass, p, out, pool);
}

double SpringBands::multiply(const SpringMatrices& m, const float* mass, const NodeField<float>& p,
                             NodeField<float>& out, ThreadPool& pool) const {
  return multiplyAs(m, mass, p, out, pool);
}

std::size_t SpringBands::bytes() const {
  return slotOf_.size() * sizeof(int) + looseEnds_.size() * sizeof(looseEnds_[0]);
}

}  // namespace smokebox
