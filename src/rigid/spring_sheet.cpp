#include "rigid/spring_sheet.h"

#include <algorithm>
#include <cmath>

#include "rigid/lanes.h"

namespace smokebox {

namespace {

bool alike(const SpringDef& p, const SpringDef& q) {
  return p.length == q.length && p.stiffness == q.stiffness && p.damping == q.damping && p.slack == q.slack;
}

}  // namespace

bool SpringSheet::takes(const Spring& spring, const Bodies& bodies) {
  auto atCentre = [&](const Anchor& end) {
    return end.body >= 0 && (end.at == Vec2{} || bodies.def[end.body].inertia == 0);
  };
  return atCentre(spring.def.from) && atCentre(spring.def.to);
}

void SpringSheet::layOut(const std::vector<int>& springs, const std::vector<Spring>& all,
                         const std::vector<SpringSheet>& before) {
  body_.clear();
  for (const int k : springs)
    for (const int body : {all[k].def.from.body, all[k].def.to.body}) body_.push_back(body);
  std::sort(body_.begin(), body_.end());
  body_.erase(std::unique(body_.begin(), body_.end()), body_.end());
  auto node = [&](int body) {
    return static_cast<int>(std::lower_bound(body_.begin(), body_.end(), body) - body_.begin());
  };
  links_.clear();
  std::vector<std::array<int, 2>> ends;
  double lengths = 0;
  for (const int k : springs) {
    const SpringDef& def = all[k].def;
    const int from = node(def.from.body), to = node(def.to.body);
    links_.push_back({k, std::min(from, to), std::max(from, to), 0, def});
    lengths += def.length;
  }
  std::sort(links_.begin(), links_.end(), [](const Link& p, const Link& q) { return p.spring < q.spring; });
  for (const Link& link : links_) ends.push_back({link.a, link.b});
  size_ = springs.empty() ? 0 : lengths / static_cast<double>(springs.size());
  bands_.layOut(static_cast<int>(body_.size()), ends);
  for (std::size_t k = 0; k < links_.size(); ++k) links_[k].slot = bands_.slotOf(static_cast<int>(k));
  laws_.assign(bands_.slots());
  matrices_.assign(bands_.slots());
  h_ = 0;

  mass_.assign(bands_.nodes(), 0), inverse_.assign(bands_.nodes(), 0);
  share_.assign(bands_.nodes(), 0), inverseShare_.assign(bands_.nodes(), 0);
  for (NodeField<double>* each :
       {&place_, &moved_, &impulse_, &biases_, &velocity_, &rest_, &made_, &product_, &left_})
    bands_.makeField(*each);
  for (NodeField<float>* each : {&missing_, &direction_, &step_, &change_}) bands_.makeField(*each);
  settled_ = false;
  fresh_.assign(body_.size(), 1);
  for (const SpringSheet& sheet : before)
    for (std::size_t k = 0; k < sheet.body_.size(); ++k) {
      const int here = node(sheet.body_[k]);
      if (here == static_cast<int>(body_.size()) || body_[here] != sheet.body_[k]) continue;
      place_.x()[here] = sheet.place_.x()[k], place_.y()[here] = sheet.place_.y()[k];
      impulse_.x()[here] = sheet.impulse_.x()[k], impulse_.y()[here] = sheet.impulse_.y()[k];
      fresh_[here] = 0;
    }
}

void SpringSheet::mark(std::vector<int>& sheetOf, int number) const {
  for (const Link& link : links_) sheetOf[link.spring] = number;
}

void SpringSheet::beginStep(const std::vector<Spring>& springs, const Bodies& bodies, double h,
                            bool changed) {
  bool all = h != h_;
  total_ = 0;
  free_ = true;
  int moving = 0;
  for (std::size_t k = 0; k < body_.size(); ++k) {
    const double inverse = bodies.inverse[body_[k]].mass;
    all = all || inverse != inverse_[k];
    inverse_[k] = inverse;
    mass_[k] = inverse > 0 ? 1 / inverse : 0;
    total_ += mass_[k];
    moving += inverse > 0;
  }
  free_ = moving == static_cast<int>(body_.size());
  h_ = h;
  if (!all && !changed) return;
  unit_ = moving > 0 ? total_ / moving : 1;
  for (std::size_t k = 0; k < body_.size(); ++k) {
    share_[k] = static_cast<float>(mass_[k] / unit_);
    inverseShare_[k] = static_cast<float>(inverse_[k] * unit_);
  }
  for (Link& link : links_) {
    const SpringDef& def = springs[link.spring].def;
    if (!all && alike(link.def, def)) continue;
    link.def = def;
    laws_.set(link.slot, def, inverse_[link.a] + inverse_[link.b], h);
  }
}

void SpringSheet::warmStart(Bodies& bodies, double h, double hBefore) {
  hBefore_ = hBefore;
  settled_ = false;
  double *x = place_.x(), *y = place_.y(), *movedX = moved_.x(), *movedY = moved_.y();
  const double *impulseX = impulse_.x(), *impulseY = impulse_.y();
  for (std::size_t k = 0; k < body_.size(); ++k) {
    const Vec2 now = bodies.positionNow(body_[k]);
    Motion& v = bodies.velocity[body_[k]];
    movedX[k] = fresh_[k] ? hBefore * v.x : now.x - x[k];
    movedY[k] = fresh_[k] ? hBefore * v.y : now.y - y[k];
    x[k] = now.x, y[k] = now.y;
    fresh_[k] = 0;
    v.x += inverse_[k] * impulseX[k];
    v.y += inverse_[k] * impulseY[k];
  }
  h_ = h;
  findRows();
}

void SpringSheet::findRows() {
  bands_.makeField(biases_);
  for (int from = 0; from < bands_.nodes(); from += SpringStretch::kMost) {
    const int to = from + SpringStretch::kMost;
    for (const SpringBands::Band& band : bands_.bands()) {
      const int begin = std::max(from, band.first), end = std::min(to, band.last);
      if (begin < end) findRowsOfBand(band, begin, end - begin);
    }
  }
  if (!bands_.looseEnds().empty()) findLooseRows();
}

void SpringSheet::findRowsOfBand(const SpringBands::Band& band, int begin, int count) {
  SpringStretch& at = stretch_;
  const int next = begin + band.offset;
  const double *x = place_.x(), *y = place_.y(), *movedX = moved_.x(), *movedY = moved_.y();
  double *biasX = biases_.x(), *biasY = biases_.y();
#pragma omp simd
  for (int k = 0; k < count; ++k) {
    at.x[k] = x[next + k] - x[begin + k];
    at.y[k] = y[next + k] - y[begin + k];
    at.movedX[k] = movedX[next + k] - movedX[begin + k];
    at.movedY[k] = movedY[next + k] - movedY[begin + k];
  }
  at.findRows(laws_, band.slot + begin, count, h_, hBefore_, unit_, matrices_);
#pragma omp simd
  for (int k = 0; k < count; ++k) biasX[begin + k] -= at.biasX[k], biasY[begin + k] -= at.biasY[k];
#pragma omp simd
  for (int k = 0; k < count; ++k) biasX[next + k] += at.biasX[k], biasY[next + k] += at.biasY[k];
}

void SpringSheet::findLooseRows() {
  SpringStretch& at = stretch_;
  const double *x = place_.x(), *y = place_.y(), *movedX = moved_.x(), *movedY = moved_.y();
  double *biasX = biases_.x(), *biasY = biases_.y();
  const int loose = static_cast<int>(bands_.looseEnds().size());
  for (int begin = 0; begin < loose; begin += SpringStretch::kMost) {
    const int count = std::min(SpringStretch::kMost, loose - begin);
    const std::array<int, 2>* ends = &bands_.looseEnds()[begin];
    for (int k = 0; k < count; ++k) {
      const auto& [a, b] = ends[k];
      at.x[k] = x[b] - x[a], at.y[k] = y[b] - y[a];
      at.movedX[k] = movedX[b] - movedX[a], at.movedY[k] = movedY[b] - movedY[a];
    }
    at.findRows(laws_, bands_.firstLoose() + begin, count, h_, hBefore_, unit_, matrices_);
    for (int k = 0; k < count; ++k) {
      const auto& [a, b] = ends[k];
      biasX[a] -= at.biasX[k], biasY[a] -= at.biasY[k];
      biasX[b] += at.biasX[k], biasY[b] += at.biasY[k];
    }
  }
}

void SpringSheet::endStep(const Bodies& bodies) {
  for (std::size_t k = 0; k < body_.size(); ++k) {
    const Motion& v = bodies.velocity[body_[k]];
    left_.x()[k] = v.x, left_.y()[k] = v.y;
  }
  settled_ = false;
}

/// What the impulse of the last sub-step was.
double SpringSheet::tension(int spring) const {
  const auto found = std::lower_bound(links_.begin(), links_.end(), spring,
                                      [](const Link& link, int number) { return link.spring < number; });
  const int a = found->a, b = found->b;
  SpringStretch at;
  at.x[0] = place_.x()[b] - place_.x()[a], at.y[0] = place_.y()[b] - place_.y()[a];
  at.movedX[0] = moved_.x()[b] - moved_.x()[a], at.movedY[0] = moved_.y()[b] - moved_.y()[a];
  SpringMatrices m;
  m.assign(1);
  SpringLaws own;
  own.assign(1);
  own.set(0, found->def, inverse_[a] + inverse_[b], h_);
  at.findRows(own, 0, 1, h_, hBefore_, 1, m);
  const double x = left_.x()[b] - left_.x()[a], y = left_.y()[b] - left_.y()[a];
  const double forceX = at.biasX[0] + m.xx[0] * x + m.xy[0] * y,
               forceY = at.biasY[0] + m.xy[0] * x + m.yy[0] * y;
  return (forceX * at.x[0] + forceY * at.y[0]) / h_;
}

std::size_t SpringSheet::bytes() const {
  return links_.size() * sizeof(Link) + bands_.bytes() + bands_.slots() * 9 * sizeof(double) +
         body_.size() * (sizeof(int) + 22 * sizeof(double));
}

}  // namespace smokebox
