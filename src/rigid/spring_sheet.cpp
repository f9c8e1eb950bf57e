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
       {&place_, &moved_, &impulse_, &pulls_, &velocity_, &rest_, &made_, &product_, &left_})
    bands_.makeField(*each);
  for (NodeField<float>* each : {&missing_, &direction_, &step_, &change_}) bands_.makeField(*each);
  beyond_.resize((bands_.nodes() + bands_.grain() - 1) / bands_.grain());
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
  double *x = place_.x(), *y = place_.y(), *movedX = moved_.x(), *movedY = moved_.y();
  double *velocityX = velocity_.x(), *velocityY = velocity_.y();
  const double *impulseX = impulse_.x(), *impulseY = impulse_.y();
  pool_->blocks(0, static_cast<int>(body_.size()), bands_.grain(), [&](int first, int last) {
    for (int k = first; k < last; ++k) {
      const Vec2 now = bodies.unwrappedNow(body_[k]);
      Motion& v = bodies.velocity[body_[k]];
      movedX[k] = fresh_[k] ? hBefore * v.x : now.x - x[k];
      movedY[k] = fresh_[k] ? hBefore * v.y : now.y - y[k];
      x[k] = now.x, y[k] = now.y;
      fresh_[k] = 0;
      v.x += inverse_[k] * impulseX[k];
      v.y += inverse_[k] * impulseY[k];
      velocityX[k] = v.x, velocityY[k] = v.y;
    }
  });
  h_ = h;
  settled_ = false;
  findRows();
}

SpringRows SpringSheet::startRows() const {
  SpringRows rows;
  rows.h = h_, rows.hBefore = hBefore_, rows.mass = unit_;
  return rows;
}

void SpringSheet::findRows() {
  bands_.makeField(pulls_);
  const int grain = bands_.grain(), nodes = bands_.nodes();
  pool_->blocks(0, nodes, grain, [&](int first, int last) { findRowsOf(first, last); });
  for (int part = 0; (part + 1) * grain < nodes; ++part) {
    const int from = (part + 1) * grain, count = std::min(bands_.reach(), nodes - from);
    const double *moreX = beyond_[part].x(), *moreY = beyond_[part].y();
    double *x = pulls_.x() + from, *y = pulls_.y() + from;
#pragma omp simd
    for (int k = 0; k < count; ++k) x[k] += moreX[k], y[k] += moreY[k];
  }
  if (!bands_.looseEnds().empty()) findLooseRows();
}

/// Of the springs whose first node is from `first` to before `last`.
void SpringSheet::findRowsOf(int first, int last) {
  SpringRows rows = startRows();
  NodeField<double>& beyond = beyond_[first / bands_.grain()];
  beyond.assign(0, bands_.reach());
  const auto add = [&](double* x, double* y, int from, int to) {
#pragma omp simd
    for (int k = from; k < to; ++k)
      x[k] += static_cast<double>(rows.pullX[k]), y[k] += static_cast<double>(rows.pullY[k]);
  };
  for (int from = first; from < last; from += SpringRows::kMost)
    for (const SpringBands::Band& band : bands_.bands()) {
      const int begin = std::max(from, band.first),
                end = std::min({from + SpringRows::kMost, band.last, last});
      if (begin >= end) continue;
      const int count = end - begin, next = begin + band.offset;
      auto ends = [&](const NodeField<double>& field) {
        return SpringEnds{field.x() + begin, field.y() + begin, field.x() + next, field.y() + next};
      };
      rows.place = ends(place_), rows.moved = ends(moved_), rows.velocity = ends(velocity_);
      rows.find(laws_, band.slot + begin, count, matrices_);
      double *x = pulls_.x() + begin, *y = pulls_.y() + begin;
#pragma omp simd
      for (int k = 0; k < count; ++k)
        x[k] -= static_cast<double>(rows.pullX[k]), y[k] -= static_cast<double>(rows.pullY[k]);
      const int within = std::clamp(last - next, 0, count);
      add(pulls_.x() + next, pulls_.y() + next, 0, within);
      add(beyond.x() + (next - last), beyond.y() + (next - last), within, count);
    }
}

void SpringSheet::findLooseRows() {
  SpringRows rows = startRows();
  struct Gathered {
    double ax[SpringRows::kMost], ay[SpringRows::kMost], bx[SpringRows::kMost], by[SpringRows::kMost];
    SpringEnds from(const NodeField<double>& field, const std::array<int, 2>* ends, int count) {
      for (int k = 0; k < count; ++k) {
        const auto& [a, b] = ends[k];
        ax[k] = field.x()[a], ay[k] = field.y()[a], bx[k] = field.x()[b], by[k] = field.y()[b];
      }
      return {ax, ay, bx, by};
    }
  } place, moved, velocity;
  const int loose = static_cast<int>(bands_.looseEnds().size());
  double *x = pulls_.x(), *y = pulls_.y();
  for (int begin = 0; begin < loose; begin += SpringRows::kMost) {
    const int count = std::min(SpringRows::kMost, loose - begin);
    const std::array<int, 2>* ends = &bands_.looseEnds()[begin];
    rows.place = place.from(place_, ends, count), rows.moved = moved.from(moved_, ends, count);
    rows.velocity = velocity.from(velocity_, ends, count);
    rows.find(laws_, bands_.firstLoose() + begin, count, matrices_);
    for (int k = 0; k < count; ++k) {
      const auto& [a, b] = ends[k];
      const auto pullX = static_cast<double>(rows.pullX[k]), pullY = static_cast<double>(rows.pullY[k]);
      x[a] -= pullX, y[a] -= pullY;
      x[b] += pullX, y[b] += pullY;
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
  SpringLaws law;
  law.assign(1);
  law.set(0, found->def, inverse_[a] + inverse_[b], h_);
  SpringMatrices matrix;
  matrix.assign(1);
  SpringRows row;
  auto ends = [&](const NodeField<double>& field) {
    return SpringEnds{field.x() + a, field.y() + a, field.x() + b, field.y() + b};
  };
  row.place = ends(place_), row.moved = ends(moved_), row.velocity = ends(left_);
  row.h = h_, row.hBefore = hBefore_, row.mass = 1;
  row.find(law, 0, 1, matrix);
  return static_cast<double>(row.pullX[0] * row.x[0] + row.pullY[0] * row.y[0]) / h_;
}

std::size_t SpringSheet::bytes() const {
  return links_.size() * sizeof(Link) + bands_.bytes() + bands_.slots() * 9 * sizeof(double) +
         body_.size() * (sizeof(int) + 22 * sizeof(double));
}

}  // namespace smokebox
