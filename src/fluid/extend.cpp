#include "fluid/extend.h"

#include <cstring>

namespace smokebox {

namespace {

constexpr int kSideMarginX = 8;  // columns of the margin that are filled
constexpr int kSpanGrain = 256, kGhostGrain = 1024;

/// Tangential velocity of a side at a face that lies between its faces k - 1 and k.
float tangential(const std::vector<float>& values, int k) {
  if (values.empty()) return 0;
  const int last = static_cast<int>(values.size()) - 1;
  return 0.5f * (values[std::clamp(k - 1, 0, last)] + values[std::clamp(k, 0, last)]);
}

/// Values beyond a side. f[0] is the face on the wall (normal component) or the nearest inside (tangential),
/// f[step] the next one inwards; `last`: the farthest that may be mirrored. Writes f[-step] .. f[-count
/// step].
void continueBeyond(WallKind kind, bool normal, float wall, float* f, std::ptrdiff_t step, int count,
                    int last) {
  switch (kind) {
    case WallKind::periodic:
      break;
    case WallKind::open:
      for (int k = 1; k <= count; ++k) f[-k * step] = f[0];
      break;
    case WallKind::slip:
      for (int k = 1; k <= count; ++k)
        f[-k * step] = normal ? 2 * f[0] - f[std::min(k, last) * step] : f[std::min(k - 1, last) * step];
      break;
    case WallKind::noSlip:
    case WallKind::inflow:
      if (normal) {
        for (int k = 1; k <= count; ++k) f[-k * step] = f[std::min(k, last) * step];
      } else {
        // The parabola through (0, wall), (1/2, f0), (3/2, f1), at -1/2 and -3/2.
        const float f0 = f[0], f1 = f[std::min(1, last) * step];
        f[-step] = (8.0f / 3) * wall - 2 * f0 + (1.0f / 3) * f1;
        f[-2 * step] = 8 * wall - 9 * f0 + 2 * f1;
        for (int k = 3; k <= count; ++k) f[-k * step] = f[-2 * step];
      }
      break;
  }
}

void fillMarginsOf(const Boundary& boundary, bool alongX, Field& f) {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  const SideFlow &left = boundary.side(Side::left), &right = boundary.side(Side::right);
  const SideFlow &bottom = boundary.side(Side::bottom), &top = boundary.side(Side::top);
  const int columns = alongX ? nx + 1 : nx, rows = alongX ? ny : ny + 1;
  const std::ptrdiff_t stride = f.stride();
  // A periodic component repeats its first row or column at nx, ny; the rest of the margin follows from
  // there.
  for (int j = 0; j < rows; ++j) {
    float* row = f.row(j);
    if (boundary.periodicX()) {
      for (int k = 1; k <= kSideMarginX; ++k) row[-k] = row[std::max(nx - k, 0)];
      for (int k = 0; k <= kSideMarginX; ++k) row[nx + k] = row[std::min(k, nx - 1)];
      continue;
    }
    const float wallLeft = alongX ? 0 : tangential(left.v, j),
                wallRight = alongX ? 0 : tangential(right.v, j);
    continueBeyond(left.kind, alongX, wallLeft, row, 1, kSideMarginX, columns - 1);
    continueBeyond(right.kind, alongX, wallRight, row + columns - 1, -1, kSideMarginX, columns - 1);
  }
  const int begin = -kSideMarginX, end = nx + kSideMarginX + 1;
  if (boundary.periodicY()) {
    const std::size_t bytes = static_cast<std::size_t>(end - begin) * sizeof(float);
    for (int k = 1; k <= Field::kMarginY; ++k)
      std::memcpy(f.row(-k) + begin, f.row(std::max(ny - k, 0)) + begin, bytes);
    for (int k = 0; k < Field::kMarginY; ++k)
      std::memcpy(f.row(ny + k) + begin, f.row(std::min(k, ny - 1)) + begin, bytes);
    return;
  }
  for (int i = begin; i < end; ++i) {
    const float wallBottom = alongX ? tangential(bottom.u, i) : 0,
                wallTop = alongX ? tangential(top.u, i) : 0;
    continueBeyond(bottom.kind, !alongX, wallBottom, f.row(0) + i, stride, Field::kMarginY, rows - 1);
    // The margin above the last y-face is one row narrower than the one below the first.
    continueBeyond(top.kind, !alongX, wallTop, f.row(rows - 1) + i, -stride,
                   Field::kMarginY - (alongX ? 0 : 1), rows - 1);
  }
}

}  // namespace

void fillMargins(const Boundary& boundary, Field& u, Field& v) {
  fillMarginsOf(boundary, true, u);
  fillMarginsOf(boundary, false, v);
}

VelocityExtension::VelocityExtension(const Boundary& boundary, ThreadPool& pool) : pool_(pool) {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  u_.alongX = true;
  v_.alongX = false;
  for (Component* c : {&u_, &v_}) {
    c->layer = FaceMap(nx, ny);
    c->drag = Field(nx, ny);
  }
  rebuild(boundary);
}

void VelocityExtension::rebuild(const Boundary& boundary) {
  pool_.blocks(0, 2, 1, [&](int begin, int) { rebuild(boundary, begin == 0 ? u_ : v_); });
}

void VelocityExtension::rebuild(const Boundary& boundary, Component& c) {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  const bool wrapX = boundary.periodicX(), wrapY = boundary.periodicY();
  const int columns = c.alongX && !wrapX ? nx + 1 : nx, rows = !c.alongX && !wrapY ? ny + 1 : ny;
  const Field& open = c.alongX ? boundary.openX : boundary.openY;
  const auto& links = c.alongX ? boundary.linksU : boundary.linksV;
  const std::ptrdiff_t stride = open.stride();

  // Where a neighbour lies; false beyond a side that does not wrap.
  auto inside = [&](int& i, int& j) {
    if (wrapX) i = i < 0 ? i + nx : i >= nx ? i - nx : i;
    if (wrapY) j = j < 0 ? j + ny : j >= ny ? j - ny : j;
    return i >= 0 && i < columns && j >= 0 && j < rows;
  };
  // A closed face in the plane of a wall of the domain has the wall's own velocity, exactly.
  auto onWall = [&](int i, int j) {
    return c.alongX ? !wrapX && (i == 0 || i == nx) : !wrapY && (j == 0 || j == ny);
  };

  c.anySolid = false;
  c.spans.clear();
  for (int j = 0; j < rows; ++j) {
    const float* o = open.row(j);
    std::uint8_t* layer = c.layer.row(j);
    for (int i = 0; i < columns; ++i) layer[i] = o[i] > 0 ? 1 : 0;
    for (int i = 0; i < columns;) {
      const void* zero = std::memchr(layer + i, 0, static_cast<std::size_t>(columns - i));
      if (!zero) break;
      const int begin = static_cast<int>(static_cast<const std::uint8_t*>(zero) - layer);
      const void* one = std::memchr(layer + begin, 1, static_cast<std::size_t>(columns - begin));
      i = one ? static_cast<int>(static_cast<const std::uint8_t*>(one) - layer) : columns;
      c.anySolid = c.anySolid || !onWall(begin, j) || !onWall(i - 1, j) || (c.alongX && i - begin > 2);
      c.spans.push_back({j, begin, i});
    }
  }

  for (const CutLink& link : links) {
    int i = link.i + link.di, j = link.j + link.dj;
    if (inside(i, j)) c.drag(i, j) = std::max(c.drag(i, j), link.drag);
  }

  static constexpr int kStep[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
  c.front.clear();
  c.ghosts.clear();
  c.layerEnds.clear();
  for (const Span& span : c.spans) {
    // Only the ends of a span can have an open neighbour along the row.
    auto rowBeside = [&](int step) -> const std::uint8_t* {
      int i = 0, j = span.j + step;
      return inside(i, j) ? c.layer.row(j) : nullptr;
    };
    const std::uint8_t *above = rowBeside(1), *below = rowBeside(-1);
    auto openAt = [&](int i, int j) { return inside(i, j) && c.layer(i, j) == 1; };
    for (int i = span.begin; i < span.end; ++i) {
      const bool beside = (above && above[i] == 1) || (below && below[i] == 1) ||
                          (i == span.begin && openAt(i - 1, span.j)) ||
                          (i == span.end - 1 && openAt(i + 1, span.j));
      if (beside && !onWall(i, span.j)) c.front.push_back({i, span.j});
    }
  }
  for (int depth = 1; depth <= kLayers && !c.front.empty(); ++depth) {
    for (const Vec2i at : c.front) {
      Ghost ghost;
      ghost.target = static_cast<int>(at.j * stride + at.i);
      int walls = 0;
      for (const auto& step : kStep) {
        int a = at.i + step[0], b = at.j + step[1];
        if (!inside(a, b) || c.layer(a, b) == 0 || c.layer(a, b) > depth) continue;
        const bool along = (step[0] != 0) == c.alongX;
        if (depth == 1 && along)
          ++walls;
        else
          ghost.sources[ghost.count++] = static_cast<int>(b * stride + a);
      }
      const float keep = depth == 1 ? 1 - std::clamp(c.drag(at.i, at.j), 0.0f, 1.0f) : 1.0f;
      ghost.weight = ghost.count ? keep / static_cast<float>(ghost.count + walls) : 0.0f;
      ghost.wallShare =
          ghost.count ? 1 - keep * static_cast<float>(ghost.count) / static_cast<float>(ghost.count + walls)
                      : 1.0f;
      c.ghosts.push_back(ghost);
    }
    c.layerEnds.push_back(c.ghosts.size());
    for (const Vec2i at : c.front) c.layer(at.i, at.j) = static_cast<std::uint8_t>(depth + 1);
    c.next.clear();
    for (const Vec2i at : c.front)
      for (const auto& step : kStep) {
        int a = at.i + step[0], b = at.j + step[1];
        if (!inside(a, b) || c.layer(a, b) != 0 || onWall(a, b)) continue;
        c.layer(a, b) = 255;  // taken, so that it is listed once
        c.next.push_back({a, b});
      }
    for (const Vec2i at : c.next) c.layer(at.i, at.j) = 0;
    c.front.swap(c.next);
  }
  for (const CutLink& link : links) {
    int i = link.i + link.di, j = link.j + link.dj;
    if (inside(i, j)) c.drag(i, j) = 0;
  }
}

void VelocityExtension::apply(const Boundary& boundary, Field& u, Field& v) const {
  apply(u_, boundary.wallU, u);
  apply(v_, boundary.wallV, v);
  fillMargins(boundary, u, v);
}

void VelocityExtension::apply(const Component& c, const Field& wall, Field& f) const {
  pool_.blocks(0, static_cast<int>(c.spans.size()), kSpanGrain, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const Span s = c.spans[k];
      std::copy(wall.row(s.j) + s.begin, wall.row(s.j) + s.end, f.row(s.j) + s.begin);
    }
  });
  float* data = f.row(0);
  const float* walls = wall.row(0);
  std::size_t from = 0;
  for (const std::size_t to : c.layerEnds) {
    pool_.blocks(static_cast<int>(from), static_cast<int>(to), kGhostGrain, [&](int begin, int end) {
      for (int k = begin; k < end; ++k) {
        const Ghost& g = c.ghosts[k];
        float sum = 0;
        for (int s = 0; s < g.count; ++s) sum += data[g.sources[s]];
        data[g.target] = g.wallShare * walls[g.target] + g.weight * sum;
      }
    });
    from = to;
  }
}

std::size_t VelocityExtension::bytes() const {
  std::size_t total = 0;
  for (const Component* c : {&u_, &v_})
    total += c->layer.bytes() + c->drag.bytes() + c->spans.capacity() * sizeof(Span) +
             c->ghosts.capacity() * sizeof(Ghost) +
             (c->front.capacity() + c->next.capacity()) * sizeof(Vec2i);
  return total;
}

}  // namespace smokebox
