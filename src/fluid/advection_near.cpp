#include "fluid/advection_near.h"

#include <cmath>
#include <cstring>

#include "base/lanes.h"

namespace smokebox {

namespace {

// What a stencil may do with the value on a face.
constexpr std::uint8_t kUnusable = 0;  // deep inside a solid or far beyond a wall
constexpr std::uint8_t kExtended = 1;  // extended from the fluid: the outer points of third order
constexpr std::uint8_t kKnown = 2;     // cut by a surface or next behind it, or in the plane of a wall
constexpr std::uint8_t kRegular = 3;   // fully open, or the image of such a face by symmetry or period

// Small cut cells are given at least this share of a cell's area, so that they do not limit the time step.
constexpr float kSmallestVolume = 0.5f;

constexpr int kReach = 4;      // of the high-order stencil along the direction of a flux
constexpr int kMapMargin = 8;  // columns of the margin that are filled

void continueUse(WallKind kind, bool normal, std::uint8_t* f, std::ptrdiff_t step, int count, int last) {
  for (int k = 1; k <= count; ++k) {
    const int image = std::min(normal ? k : k - 1, last);
    if (kind == WallKind::slip)
      f[-k * step] = f[image * step];
    else if (kind == WallKind::open)
      f[-k * step] = kExtended;
    else
      f[-k * step] = k <= 2 ? kExtended : kUnusable;
  }
}

}  // namespace

/// U (value at the flux point - q) without a branch. p: the lower face of the flux point; own: which of p[0],
/// p[step] is the face that has the value q.
inline float NearFaces::carried(int order, const float* p, std::ptrdiff_t step, int own, float U) {
  const float *e = kEven[order], *o = kOdd[order];
  const float a = p[0], b = p[step], m1 = p[-step], p1 = p[2 * step], m2 = p[-2 * step], p2 = p[3 * step];
  const float even = (e[0] * (a + b) + e[1] * (m1 + p1)) + e[2] * (m2 + p2);
  const float odd = (o[0] * (b - a) + o[1] * (p1 - m1)) + o[2] * (p2 - m2);
  return U * (even - p[own * step]) - std::fabs(U) * odd;
}

NearFaces::NearFaces(const Boundary& boundary) {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  u_.use = FaceMap(nx, ny);
  v_.use = FaceMap(nx, ny);
  u_.rowBegin.assign(ny + 2, 0);
  v_.rowBegin.assign(ny + 2, 0);
  u_.groupBegin = v_.groupBegin = u_.rowBegin;
  // Padded, so that it can be looked through eight at a time.
  u_.irregular.assign(nx + 1 + 8, 0);
  v_.irregular.assign(nx + 1 + 8, 0);
}

void NearFaces::rebuild(const Boundary& boundary, const VelocityExtension& extension, ThreadPool& pool) {
  pool.blocks(0, 2, 1, [&](int begin, int) {
    findUse(boundary, extension, begin == 0, begin == 0 ? u_.use : v_.use);
  });
  pool.blocks(0, 2, 1, [&](int begin, int) { findFaces(boundary, extension, begin == 0); });
}

void NearFaces::findUse(const Boundary& boundary, const VelocityExtension& extension, bool alongX,
                        FaceMap& use) const {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  const bool wrapX = boundary.periodicX(), wrapY = boundary.periodicY();
  const int columns = alongX ? nx + 1 : nx, rows = alongX ? ny : ny + 1;
  const Field& open = alongX ? boundary.openX : boundary.openY;
  const FaceMap& layer = alongX ? extension.layerU() : extension.layerV();
  auto planeUse = [](WallKind kind) { return kind == WallKind::slip ? kRegular : kKnown; };

  for (int j = 0; j < rows; ++j) {
    std::uint8_t* row = use.row(j);
    const float* o = open.row(j);
    const std::uint8_t* depth = layer.row(j);
    for (int i = 0; i < columns; ++i) {
      const int regular = o[i] >= 1 ? kRegular : 0, known = (o[i] > 0 && o[i] < 1) ? kKnown : 0;
      const int extended = depth[i] == 2 ? kKnown : depth[i] == 3 ? kExtended : 0;
      row[i] = static_cast<std::uint8_t>(regular | known | extended);
    }
    if (alongX && !wrapX) {
      if (!(o[0] > 0)) row[0] = planeUse(boundary.side(Side::left).kind);
      if (!(o[nx] > 0)) row[nx] = planeUse(boundary.side(Side::right).kind);
    }
    if (!alongX && !wrapY && (j == 0 || j == ny)) {
      const std::uint8_t plane = planeUse(boundary.side(j == 0 ? Side::bottom : Side::top).kind);
      for (int i = 0; i < columns; ++i)
        if (!(o[i] > 0)) row[i] = plane;
    }
    if (wrapX) {
      for (int k = 1; k <= kMapMargin; ++k) row[-k] = row[std::max(nx - k, 0)];
      for (int k = 0; k <= kMapMargin; ++k) row[nx + k] = row[std::min(k, nx - 1)];
    } else {
      continueUse(boundary.side(Side::left).kind, alongX, row, 1, kMapMargin, columns - 1);
      continueUse(boundary.side(Side::right).kind, alongX, row + columns - 1, -1, kMapMargin, columns - 1);
    }
  }
  const int begin = -kMapMargin, end = nx + kMapMargin + 1;
  if (wrapY) {
    for (int k = 1; k <= Field::kMarginY; ++k)
      std::memcpy(use.row(-k) + begin, use.row(std::max(ny - k, 0)) + begin, end - begin);
    for (int k = 0; k < Field::kMarginY; ++k)
      std::memcpy(use.row(ny + k) + begin, use.row(std::min(k, ny - 1)) + begin, end - begin);
    return;
  }
  const std::ptrdiff_t stride = use.row(1) - use.row(0);
  for (int i = begin; i < end; ++i) {
    continueUse(boundary.side(Side::bottom).kind, !alongX, use.row(0) + i, stride, Field::kMarginY, rows - 1);
    continueUse(boundary.side(Side::top).kind, !alongX, use.row(rows - 1) + i, -stride,
                Field::kMarginY - (alongX ? 0 : 1), rows - 1);
  }
}

void NearFaces::findFaces(const Boundary& boundary, const VelocityExtension& extension, bool alongX) {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  const bool wrapX = boundary.periodicX(), wrapY = boundary.periodicY();
  Component& c = alongX ? u_ : v_;
  const FaceMap& other = alongX ? v_.use : u_.use;
  const Field& open = alongX ? boundary.openX : boundary.openY;
  const FaceMap& slip = alongX ? extension.slipU() : extension.slipV();
  const int columns = alongX && !wrapX ? nx + 1 : nx, rows = !alongX && !wrapY ? ny + 1 : ny;
  auto wet = [&](Side s) {  // a closed wall whose tangential velocity the flow feels
    const WallKind kind = boundary.side(s).kind;
    return kind == WallKind::noSlip || kind == WallKind::inflow;
  };

  c.faces.clear();
  c.groups.clear();
  for (int j = 0; j <= ny + 1; ++j) {
    c.rowBegin[j] = static_cast<int>(c.faces.size());
    c.groupBegin[j] = static_cast<int>(c.groups.size());
    if (j >= rows) continue;
    std::uint8_t* irregular = c.irregular.data();
    std::memset(irregular, 0, static_cast<std::size_t>(columns));
    auto mark = [&](const std::uint8_t* use) {
      for (int i = 0; i < columns; ++i) irregular[i] |= static_cast<std::uint8_t>(use[i] ^ kRegular);
    };
    for (int k = -kReach; k <= kReach; ++k) {
      mark(c.use.row(j) + k);
      if (j + k < ny + Field::kMarginY) mark(c.use.row(j + k));
    }
    for (int b = 0; b < 4; ++b)
      for (int a = 0; a < 4; ++a) mark(alongX ? other.row(j - 1 + b) + a - 2 : other.row(j - 2 + b) + a - 1);

    const float* o = open.row(j);
    for (int i = 0; i < columns; ++i) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, irregular + i, sizeof eight);
      if (eight == 0) {
        i += 7;
        continue;
      }
      if (!irregular[i] || !(o[i] > 0)) continue;
      Face face;
      face.i = i;
      // The faces whose flow enters the four transport velocities.
      std::uint8_t around = std::min({c.use(i, j), alongX ? c.use(i - 1, j) : c.use(i, j - 1),
                                      alongX ? c.use(i + 1, j) : c.use(i, j + 1)});
      for (int b = 0; b < 2; ++b)
        for (int a = 0; a < 2; ++a)
          around = std::min(around, alongX ? other(i - 1 + a, j + b) : other(i + a, j - 1 + b));
      face.cut = around != kRegular && slip(i, j);
      if (face.cut) {
        auto share = [&](int a, int b) {
          if (wrapX) a = a < 0 ? a + nx : a >= nx ? a - nx : a;
          if (wrapY) b = b < 0 ? b + ny : b >= ny ? b - ny : b;
          return a < 0 || a >= nx || b < 0 || b >= ny ? 1.0f : boundary.volume(a, b);
        };
        const float volume = 0.5f * (share(i, j) + (alongX ? share(i - 1, j) : share(i, j - 1)));
        face.perVolume = 1 / std::clamp(volume, kSmallestVolume, 1.0f);
      }
      if (o[i] < 0.5f && slip(i, j)) {
        face.order = {first, first, first, first};
      } else {
        auto between = [&](int a, int b, int di, int dj, bool atSide, Side side) {
          if (atSide && boundary.open(side)) return (di != 0) == alongX ? ambient : none;
          return orderBetween(c.use, a, b, di, dj, atSide && wet(side));
        };
        face.order = {
            between(i - 1, j, 1, 0, i == 0, Side::left), between(i, j, 1, 0, i == columns - 1, Side::right),
            between(i, j - 1, 0, 1, j == 0, Side::bottom), between(i, j, 0, 1, j == rows - 1, Side::top)};
      }
      face.atSide = *std::max_element(face.order.begin(), face.order.end()) > fifth;
      // What is behind the first face of a row or column is not beside it in memory.
      const bool inside = alongX ? i > 0 && i < nx : j > 0 && j < ny;
      if (face.cut || face.atSide || !inside)
        c.faces.push_back(face);
      else
        addToGroup(c, j, face);
    }
  }
}

void NearFaces::addToGroup(Component& c, int j, const Face& face) {
  if (c.groupBegin[j] == static_cast<int>(c.groups.size()) || face.i >= c.groups.back().i + kLanes)
    c.groups.push_back({face.i, 0, {}, {}});
  Group& group = c.groups.back();
  const auto bit = static_cast<std::uint16_t>(1u << (face.i - group.i));
  group.faces |= bit;
  for (int k = 0; k < 4; ++k) {
    if (face.order[k] == third) group.third[k] |= bit;
    if (face.order[k] == fifth) group.fifth[k] |= bit;
  }
}

NearFaces::Order NearFaces::orderBetween(const FaceMap& use, int i, int j, int di, int dj,
                                         bool atWall) const {
  auto at = [&](int k) { return use(i + k * di, j + k * dj); };
  if (atWall) return inward;
  if (std::min(at(0), at(1)) < kKnown || std::min(at(-1), at(2)) < kExtended) return first;
  const bool regular = std::min({at(-2), at(-1), at(0), at(1), at(2), at(3)}) == kRegular;
  return regular ? fifth : third;
}

void NearFaces::advanceRows(const Boundary& boundary, const AdvectionStage& s, int begin, int end) const {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  const std::ptrdiff_t stride = s.u->stride();

  auto carriedAtSide = [](Order order, const float* p, std::ptrdiff_t step, int own, float U) {
    if (order <= fifth) return carried(order, p, step, own, U);
    const bool comesIn = own == 1 ? U > 0 : U < 0;
    if (order == none || !comesIn) return 0.0f;
    return order == ambient ? U * (-0.5f * p[own * step]) : carried(third, p, step, own, U);
  };
  auto advanced = [&](float base, float rate, float gradient, const float* acceleration) {
    const float impulse = (acceleration ? s.accelerationScale * *acceleration : 0.0f) - s.phiScale * gradient;
    return base + (impulse - s.rateScale * rate);
  };

  // The whole flux through a face, that of the fluid and that of what closes it: its divergence is 0 in cut
  // cells too.
  auto fluxU = [&](int i, int j, bool inside) {
    const float q = (*s.u)(i, j);
    if (!inside && s.periodicX) i = i < 0 ? i + nx : i >= nx ? i - nx : i;
    if (!inside && s.periodicY) j = j < 0 ? j + ny : j >= ny ? j - ny : j;
    if (!inside && (i < 0 || i > nx || j < 0 || j >= ny)) return q;
    const float open = boundary.openX(i, j);
    return open * q + (1 - open) * boundary.wallU(i, j);
  };
  auto fluxV = [&](int i, int j, bool inside) {
    const float q = (*s.v)(i, j);
    if (!inside && s.periodicX) i = i < 0 ? i + nx : i >= nx ? i - nx : i;
    if (!inside && s.periodicY) j = j < 0 ? j + ny : j >= ny ? j - ny : j;
    if (!inside && (i < 0 || i >= nx || j < 0 || j > ny)) return q;
    const float open = boundary.openY(i, j);
    return open * q + (1 - open) * boundary.wallV(i, j);
  };
  struct Flow {  // through the four flux points
    float left, right, below, above;
  };
  auto rateOf = [&](const Face& f, const float* q, Flow t) {
    auto sum = [&](auto&& term) {
      const float x = term(f.order[1], q, 1, 0, t.right) - term(f.order[0], q - 1, 1, 1, t.left);
      const float y =
          term(f.order[3], q, stride, 0, t.above) - term(f.order[2], q - stride, stride, 1, t.below);
      return x + y;
    };
    return f.atSide ? sum(carriedAtSide) : sum(carried);
  };

  advanceGroups(s, begin, std::min(end, ny));
  for (int j = begin; j < std::min(end, ny); ++j)
    for (int k = u_.rowBegin[j]; k < u_.rowBegin[j + 1]; ++k) {
      const Face& f = u_.faces[k];
      const int i = f.i;
      const float *q = s.u->row(j) + i, *v = s.v->row(j) + i;
      Flow t{0.5f * (q[-1] + q[0]), 0.5f * (q[0] + q[1]), 0.5f * (v[-1] + v[0]),
             0.5f * (v[stride - 1] + v[stride])};
      if (f.cut) {
        const bool inside = i > 0 && i < nx - 1 && j > 0 && j < ny - 1;
        const float own = fluxU(i, j, inside), half = 0.5f * f.perVolume;
        t = {half * (fluxU(i - 1, j, inside) + own), half * (own + fluxU(i + 1, j, inside)),
             half * (fluxV(i - 1, j, inside) + fluxV(i, j, inside)),
             half * (fluxV(i - 1, j + 1, inside) + fluxV(i, j + 1, inside))};
      }
      const float* phi = s.phi->row(j);
      const float ahead = i < nx ? phi[i] : 0.0f;
      const float behind = i > 0 ? phi[i - 1] : s.periodicX ? phi[nx - 1] : 0.0f;
      (*s.outU)(i, j) = advanced((*s.baseU)(i, j), rateOf(f, q, t), ahead - behind,
                                 s.accelerationU ? s.accelerationU->row(j) + i : nullptr);
    }
  for (int j = begin; j < end; ++j)
    for (int k = v_.rowBegin[j]; k < v_.rowBegin[j + 1]; ++k) {
      const Face& f = v_.faces[k];
      const int i = f.i;
      const float *q = s.v->row(j) + i, *u = s.u->row(j) + i;
      Flow t{0.5f * (u[-stride] + u[0]), 0.5f * (u[1 - stride] + u[1]), 0.5f * (q[-stride] + q[0]),
             0.5f * (q[0] + q[stride])};
      if (f.cut) {
        const bool inside = i > 0 && i < nx - 1 && j > 0 && j < ny - 1;
        const float own = fluxV(i, j, inside), half = 0.5f * f.perVolume;
        t = {half * (fluxU(i, j - 1, inside) + fluxU(i, j, inside)),
             half * (fluxU(i + 1, j - 1, inside) + fluxU(i + 1, j, inside)),
             half * (fluxV(i, j - 1, inside) + own), half * (own + fluxV(i, j + 1, inside))};
      }
      const float ahead = j < ny ? (*s.phi)(i, j) : 0.0f;
      const float behind = j > 0 ? (*s.phi)(i, j - 1) : s.periodicY ? (*s.phi)(i, ny - 1) : 0.0f;
      (*s.outV)(i, j) = advanced((*s.baseV)(i, j), rateOf(f, q, t), ahead - behind,
                                 s.accelerationV ? s.accelerationV->row(j) + i : nullptr);
    }
}

std::size_t NearFaces::bytes() const {
  std::size_t total = u_.irregular.capacity() + v_.irregular.capacity();
  for (const Component* c : {&u_, &v_})
    total += c->faces.capacity() * sizeof(Face) + c->groups.capacity() * sizeof(Group) +
             (c->rowBegin.capacity() + c->groupBegin.capacity()) * sizeof(int) + c->use.bytes();
  return total;
}

}  // namespace smokebox
