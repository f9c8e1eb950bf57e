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

/// Marks the faces within two of the ends of a link to a surface with little drag.
void markSlip(const std::vector<CutLink>& links, FaceMap& slip) {
  constexpr float kLittle = 0.5f;
  constexpr int kWide = 2;
  slip.fill(0);
  for (const CutLink& link : links) {
    if (link.solid < 0 || link.drag >= kLittle) continue;
    for (int j = link.j - kWide; j <= link.j + kWide; ++j)
      for (int i = link.i - kWide; i <= link.i + kWide; ++i) slip(i, j) = 1;
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
  for (Component* c : {&u_, &v_}) c->layer = c->slip = FaceMap(nx, ny);
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
  markSlip(c.alongX ? boundary.linksU : boundary.linksV, c.slip);
  c.surface.find(boundary, c.alongX, columns, rows, c.front);
  for (const Vec2i at : c.front) c.layer(at.i, at.j) = 2;
  for (const Vec2i at : c.surface.deeper) c.layer(at.i, at.j) = 255;  // not yet
  auto surround = [&] {  // what lies behind the front and behind the faces left over from it
    c.next.assign(c.surface.deeper.begin(), c.surface.deeper.end());
    c.surface.deeper.clear();
    for (const Vec2i at : c.front)
      for (const auto& step : kStep) {
        int a = at.i + step[0], b = at.j + step[1];
        if (!inside(a, b) || c.layer(a, b) != 0 || onWall(a, b)) continue;
        c.layer(a, b) = 255;  // taken, so that it is listed once
        c.next.push_back({a, b});
      }
    std::erase_if(c.next, [&](Vec2i at) { return c.layer(at.i, at.j) != 255; });
    c.front.swap(c.next);
  };
  surround();
  for (int depth = 2; depth <= kLayers && !c.front.empty(); ++depth) {
    for (const Vec2i at : c.front) {
      Ghost ghost;
      ghost.target = static_cast<int>(at.j * stride + at.i);
      for (const auto& step : kStep) {
        int a = at.i + step[0], b = at.j + step[1];
        if (inside(a, b) && c.layer(a, b) != 0 && c.layer(a, b) <= depth) {
          int a2 = a + step[0], b2 = b + step[1];
          ghost.sources[ghost.count] = static_cast<int>(b * stride + a);
          ghost.behind[ghost.count] = ghost.sources[ghost.count];
          if (depth == 2 && !c.slip(at.i, at.j) && inside(a2, b2) && c.layer(a2, b2) != 0 &&
              c.layer(a2, b2) <= c.layer(a, b))
            ghost.behind[ghost.count] = static_cast<int>(b2 * stride + a2);
          ++ghost.count;
          if (step[1] == 0) ++ghost.countX;
        }
      }
      ghost.weight = 1 / static_cast<float>(std::max(ghost.count, 1));
      if (ghost.count > 0) c.ghosts.push_back(ghost);
    }
    c.layerEnds.push_back(c.ghosts.size());
    for (const Vec2i at : c.front) c.layer(at.i, at.j) = static_cast<std::uint8_t>(depth + 1);
    surround();
  }
  for (const Vec2i at : c.front) c.layer(at.i, at.j) = 0;
}

void VelocityExtension::setWalls(const Boundary& boundary, Field& u, Field& v) const {
  setWalls(u_, boundary.wallU, u);
  setWalls(v_, boundary.wallV, v);
}

void VelocityExtension::setWalls(const Component& c, const Field& wall, Field& f) const {
  pool_.blocks(0, static_cast<int>(c.spans.size()), kSpanGrain, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const Span s = c.spans[k];
      std::copy(wall.row(s.j) + s.begin, wall.row(s.j) + s.end, f.row(s.j) + s.begin);
    }
  });
}

void VelocityExtension::apply(const Boundary& boundary, Field& u, Field& v, bool bounded) const {
  apply(u_, boundary.wallU, boundary.linksU, bounded, u);
  apply(v_, boundary.wallV, boundary.linksV, bounded, v);
  fillMargins(boundary, u, v);
}

void VelocityExtension::apply(const Component& c, const Field& wall, const std::vector<CutLink>& links,
                              bool bounded, Field& f) const {
  setWalls(c, wall, f);
  float* data = f.row(0);
  const auto& recipes = c.surface.closed;
  pool_.blocks(0, static_cast<int>(recipes.size()), kGhostGrain, [&](int begin, int end) {
    for (int k = begin; k < end; ++k)
      data[recipes[k].target] =
          bounded ? recipes[k].boundedValue(data, links) : recipes[k].value(data, links);
  });
  std::size_t from = 0;
  for (const std::size_t to : c.layerEnds) {
    pool_.blocks(static_cast<int>(from), static_cast<int>(to), kGhostGrain, [&](int begin, int end) {
      for (int k = begin; k < end; ++k) {
        const Ghost& g = c.ghosts[k];
        float sum[2] = {};
        for (int s = 0; s < g.count; ++s)
          sum[s >= g.countX] += bounded ? data[g.sources[s]] : 2 * data[g.sources[s]] - data[g.behind[s]];
        data[g.target] = g.weight * (sum[0] + sum[1]);
      }
    });
    from = to;
  }
}

void VelocityExtension::hideCovered(const Boundary& boundary, Field& u, Field& v, Hidden* hidden) const {
  auto hide = [&](const Component& c, const std::vector<CutLink>& links, Field& f, std::vector<float>* kept) {
    float* data = f.row(0);
    const auto& recipes = c.surface.covered;
    if (kept) kept->resize(recipes.size());
    pool_.blocks(0, static_cast<int>(recipes.size()), kGhostGrain, [&](int begin, int end) {
      for (int k = begin; k < end; ++k) {
        float& value = data[recipes[k].target];
        const float shown = recipes[k].value(data, links);
        if (kept) (*kept)[k] = value - shown;
        value = shown;
      }
    });
  };
  hide(u_, boundary.linksU, u, hidden ? &hidden->u : nullptr);
  hide(v_, boundary.linksV, v, hidden ? &hidden->v : nullptr);
}

void VelocityExtension::reveal(const Hidden& hidden, Field& u, Field& v) const {
  auto show = [](const Component& c, const std::vector<float>& kept, Field& f) {
    float* data = f.row(0);
    for (std::size_t k = 0; k < kept.size(); ++k) data[c.surface.covered[k].target] += kept[k];
  };
  show(u_, hidden.u, u);
  show(v_, hidden.v, v);
}

void VelocityExtension::holdCovered(const Boundary& boundary, Field& u, Field& v, double coefficient) const {
  auto hold = [&](const Component& c, const std::vector<CutLink>& links, Field& f) {
    float* data = f.row(0);
    const auto& held = c.surface.held;
    for (std::size_t k = 0; k < held.size();) {
      // All that pull at one face do so at once: mirror images may have them in another order.
      const int target = held[k].target;
      float pulls = 0, goals = 0;
      for (; k < held.size() && held[k].target == target; ++k) {
        const CoveredFace& face = held[k];
        const float wall = links[face.link].velocity, goal = wall + face.share * (data[face.source] - wall);
        const float pull = static_cast<float>(coefficient) * face.stiffness;
        pulls += pull;
        goals += pull * goal;
      }
      data[target] = (data[target] + goals) / (1 + pulls);
    }
  };
  hold(u_, boundary.linksU, u);
  hold(v_, boundary.linksV, v);
}

std::size_t VelocityExtension::bytes() const {
  std::size_t total = 0;
  for (const Component* c : {&u_, &v_})
    total += c->layer.bytes() + c->slip.bytes() + c->surface.bytes() + c->spans.capacity() * sizeof(Span) +
             c->ghosts.capacity() * sizeof(Ghost) +
             (c->front.capacity() + c->next.capacity()) * sizeof(Vec2i);
  return total;
}

}  // namespace smokebox
