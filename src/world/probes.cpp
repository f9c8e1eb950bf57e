#include "world/probes.h"

#include <algorithm>
#include <cmath>

#include "geometry/coverage.h"

namespace smokebox {

namespace {

// Where a point of the start has been carried by what it follows.
Vec2 carriedPoint(Vec2 p, const Carried& by) {
  const Vec2 local = transformed(p - by.start.position, Pose{{}, -by.start.angleRad});
  return transformed(local, by.now);
}

std::optional<Carried> carrierOf(const ProbeSpec& spec, const FindCarried& find) {
  return spec.follow.empty() ? std::nullopt : find(spec.follow);
}

// Bilinear value at (x, y), in cells from the sample (0, 0), over the samples whose weight is not 0: what
// lies inside a solid has no part in it.
template <class Value, class Weight>
double interpolated(double x, double y, int nx, int ny, const Value& value, const Weight& weight) {
  x = std::clamp(x, 0.0, nx - 1.0);
  y = std::clamp(y, 0.0, ny - 1.0);
  const int i = std::min(static_cast<int>(x), nx - 2), j = std::min(static_cast<int>(y), ny - 2);
  const double a = x - i, b = y - j;
  double sum = 0, total = 0;
  for (int dj = 0; dj < 2; ++dj)
    for (int di = 0; di < 2; ++di) {
      const double w = (di ? a : 1 - a) * (dj ? b : 1 - b) * (weight(i + di, j + dj) > 0 ? 1 : 0);
      sum += w * value(i + di, j + dj);
      total += w;
    }
  return total > 0 ? sum / total : 0;
}

}  // namespace

ProbeSet::ProbeSet(const std::vector<ProbeSpec>& specs, double tolerance) {
  for (const ProbeSpec& spec : specs) {
    Probe probe{spec, {}};
    if (spec.region) probe.region = outlinesOf(*spec.region, tolerance);
    probes_.push_back(std::move(probe));
  }
}

Vec2 ProbeSet::pointNow(const Probe& probe, const FindCarried& find) const {
  const auto by = carrierOf(probe.spec, find);
  return by ? carriedPoint(*probe.spec.at, *by) : *probe.spec.at;
}

std::vector<Outline> ProbeSet::regionNow(const Probe& probe, const FindCarried& find) const {
  std::vector<Outline> region = probe.region;
  if (const auto by = carrierOf(probe.spec, find))
    for (Outline& outline : region)
      for (Vec2& point : outline) point = carriedPoint(point, *by);
  return region;
}

void ProbeSet::read(const Boundary& boundary, const Fluid* fluid, const Smoke* smoke, const HeatStage* heat,
                    double pressureScale, const FindCarried& find, std::vector<ProbeFigures>& out) {
  const Grid& grid = boundary.grid;
  const int nx = grid.nx, ny = grid.ny;
  out.clear();
  for (const Probe& probe : probes_) {
    ProbeFigures figures;
    figures.name = probe.spec.name;
    if (!fluid) {
      out.push_back(figures);
      continue;
    }
    auto smokeAt = [&](int i, int j) {
      double sum = 0;
      for (int c = 0; smoke && c < smoke->channels(); ++c) sum += smoke->value(c)(i, j);
      return sum;
    };
    auto warmthAt = [&](int i, int j) { return heat ? heat->at(i, j) : 0; };
    auto warmthOpen = [&](int i, int j) { return heat && heat->isOpen(i, j) ? 1 : 0; };
    if (probe.spec.at) {
      const Vec2 p = pointNow(probe, find);
      const double x = p.x / grid.h, y = p.y / grid.h;
      figures.velocity.x = interpolated(x, y - 0.5, nx + 1, ny, fluid->u(), boundary.openX);
      figures.velocity.y = interpolated(x - 0.5, y, nx, ny + 1, fluid->v(), boundary.openY);
      figures.pressure =
          pressureScale * interpolated(x - 0.5, y - 0.5, nx, ny, fluid->phi(), boundary.volume);
      figures.temperature = interpolated(x - 0.5, y - 0.5, nx, ny, warmthAt, warmthOpen);
      figures.smoke = interpolated(x - 0.5, y - 0.5, nx, ny, smokeAt, boundary.volume);
    } else {
      if (share_.empty()) share_ = Field(nx, ny);
      coverShare(grid, regionNow(probe, find), share_);
      double area = 0, u = 0, v = 0, pressure = 0, mass = 0, warmth = 0;
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
          const double open = boundary.volume(i, j), part = std::min<double>(share_(i, j), open);
          if (part <= 0) continue;
          area += part;
          u += part * 0.5 * (fluid->u()(i, j) + fluid->u()(i + 1, j));
          v += part * 0.5 * (fluid->v()(i, j) + fluid->v()(i, j + 1));
          pressure += part * fluid->phi()(i, j);
          mass += part * smokeAt(i, j);
          warmth += part * warmthAt(i, j);
        }
      if (area > 0) {
        figures.velocity = {u / area, v / area};
        figures.pressure = pressureScale * pressure / area;
        figures.smoke = mass / area;
        figures.temperature = warmth / area;
      }
      figures.mass = mass * grid.h * grid.h;
    }
    out.push_back(figures);
  }
}

void ProbeSet::capture(const FindCarried& find, std::vector<ProbePicture>& out) const {
  out.clear();
  for (const Probe& probe : probes_) {
    ProbePicture picture;
    picture.name = probe.spec.name;
    if (probe.spec.at)
      picture.at = pointNow(probe, find);
    else
      picture.region = regionNow(probe, find);
    out.push_back(std::move(picture));
  }
}

}  // namespace smokebox
