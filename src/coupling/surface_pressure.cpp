#include "coupling/surface_pressure.h"

#include <array>
#include <cmath>

namespace smokebox {
namespace {

constexpr int kReach = 2;  // cells on each side of the one in front of the surface
constexpr int kWidth = 2 * kReach + 1;

/// The cells around a place, wrapped on periodic sides.
class Window {
 public:
  Window(const Boundary& boundary, Vec2 middle)
      : boundary_(boundary),
        grid_(boundary.grid),
        i_(static_cast<int>(std::floor(middle.x / grid_.h))),
        j_(static_cast<int>(std::floor(middle.y / grid_.h))) {}

  struct Cell {
    int i = 0, j = 0;
    bool fluid = false;
    Vec2 centre;  // not wrapped
  };

  Cell cell(int a, int b) const {
    Cell cell{i_ + a - kReach, j_ + b - kReach, false, {}};
    cell.centre = grid_.cellCentre(cell.i, cell.j);
    if (!wrap(boundary_.periodicX(), grid_.nx, cell.i) || !wrap(boundary_.periodicY(), grid_.ny, cell.j))
      return cell;
    cell.fluid = boundary_.openX(cell.i, cell.j) > 0 || boundary_.openX(cell.i + 1, cell.j) > 0 ||
                 boundary_.openY(cell.i, cell.j) > 0 || boundary_.openY(cell.i, cell.j + 1) > 0;
    return cell;
  }

 private:
  static bool wrap(bool periodic, int n, int& k) {
    if (periodic) k = ((k % n) + n) % n;
    return k >= 0 && k < n;
  }
  const Boundary& boundary_;
  Grid grid_;
  int i_, j_;
};

/// Weighted sums for value and slope at the origin of `away`.
class PlaneFit {
 public:
  void add(Vec2 away, double value) {
    const double w = 1 / (0.25 + dot(away, away));
    weight_ += w;
    value_ += w * value;
    first_ = first_ + w * away;
    xx_ += w * away.x * away.x;
    xy_ += w * away.x * away.y;
    yy_ += w * away.y * away.y;
    xv_ += w * away.x * value;
    yv_ += w * away.y * value;
  }
  void solve(double& value, Vec2& slope) const {
    const Vec2 mean = (1 / weight_) * first_;
    const double average = value_ / weight_;
    double a = xx_ - mean.x * first_.x, b = xy_ - mean.x * first_.y, c = yy_ - mean.y * first_.y;
    const Vec2 r{xv_ - mean.x * value_, yv_ - mean.y * value_};
    const double ridge = 1e-10 * weight_;  // cells in one line: no slope across it
    a += ridge;
    c += ridge;
    const double determinant = a * c - b * b;
    slope = {(c * r.x - b * r.y) / determinant, (a * r.y - b * r.x) / determinant};
    value = average - dot(slope, mean);
  }

 private:
  double weight_ = 0, value_ = 0, xx_ = 0, xy_ = 0, yy_ = 0, xv_ = 0, yv_ = 0;
  Vec2 first_;
};

}  // namespace

PressurePlane pressureNear(const Boundary& boundary, const Field& pressure, Vec2 place, Vec2 outwards) {
  const double h = boundary.grid.h;
  const Vec2 front = place + 0.5 * h * outwards;
  const Window window(boundary, front);
  std::array<Window::Cell, kWidth * kWidth> cells;
  int seed = -1;
  double nearest = 1e300;
  for (int k = 0; k < kWidth * kWidth; ++k) {
    Window::Cell& cell = cells[k] = window.cell(k % kWidth, k / kWidth);
    if (!cell.fluid) continue;
    const Vec2 away = cell.centre - front;
    const bool behind = dot(cell.centre - place, outwards) < 0;
    const double distance =
        dot(away, away) + (behind ? 100 * h * h : 0);  // behind the surface: only if there is no other
    if (distance >= nearest || (behind && dot(away, away) > 2 * h * h)) continue;
    nearest = distance;
    seed = k;
  }
  PressurePlane plane;
  plane.place = place;
  if (seed < 0) return plane;

  std::array<bool, kWidth * kWidth> reached{};
  std::array<int, kWidth * kWidth> queue;
  int head = 0, tail = 0;
  auto reach = [&](int a, int b, float open) {
    if (open <= 0 || a < 0 || b < 0 || a >= kWidth || b >= kWidth) return;
    const int k = b * kWidth + a;
    if (reached[k] || !cells[k].fluid || dot(cells[k].centre - place, outwards) < 0) return;
    reached[k] = true;
    queue[tail++] = k;
  };
  reached[seed] = true;
  queue[tail++] = seed;
  const Vec2 base = cells[seed].centre;
  const double baseValue = pressure(cells[seed].i, cells[seed].j);
  PlaneFit fit;
  while (head < tail) {
    const int k = queue[head++], a = k % kWidth, b = k / kWidth;
    const Window::Cell& cell = cells[k];
    fit.add((1 / h) * (cell.centre - base), pressure(cell.i, cell.j) - baseValue);
    reach(a - 1, b, boundary.openX(cell.i, cell.j));
    reach(a + 1, b, boundary.openX(cell.i + 1, cell.j));
    reach(a, b - 1, boundary.openY(cell.i, cell.j));
    reach(a, b + 1, boundary.openY(cell.i, cell.j + 1));
  }
  double value;
  fit.solve(value, plane.slope);
  plane.slope = (1 / h) * plane.slope;
  plane.value = baseValue + value + dot(plane.slope, place - base);
  plane.known = true;
  return plane;
}

}  // namespace smokebox
