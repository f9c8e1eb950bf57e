// Solids that are their own mirror image, on the grid: shares, velocities of walls and cut links are the same
// to the bit on both sides, also where solids overlap, touch, part cells in two, or stand flush.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <tuple>

#include "base/maths.h"
#include "coupling/solids_on_grid.h"

namespace smokebox {
namespace {

/// Half of the solids of a scene; the others are their images. Places count from the axis, which is x = 0 or
/// y = 0 of the mirrored scene, in cells.
struct Member {
  Shape shape;
  double across = 0, along = 0, angle = 0;
  double speedAcross = 0, speedAlong = 0, spin = 0, drag = 0;
  bool onAxis = false;
};

struct Scene {
  int across = 32, along = 32;  // cells
  std::vector<Member> members;
  WallKind sides = WallKind::slip;  // those along the axis
};

/// The same with x and y exchanged, for an axis along x.
Vec2 placed(bool upright, double across, double along) {
  return upright ? Vec2{across, along} : Vec2{along, across};
}

MovingSolid solidOf(const Member& m, int side, bool upright, double middle, double h) {
  MovingSolid solid;
  const double angle = upright ? side * m.angle : kPi / 2 - side * m.angle;
  const Pose pose{placed(upright, middle + h * side * m.across, h * m.along), angle};
  solid.outlines = outlinesOf({m.shape, pose}, 1e-3 * h);
  solid.origin = pose.position;
  solid.velocity = placed(upright, side * m.speedAcross, m.speedAlong);
  solid.spin = (upright ? side : -side) * m.spin;
  solid.drag = m.drag;
  return solid;
}

std::vector<MovingSolid> solidsOf(const Scene& scene, bool upright, double h) {
  std::vector<MovingSolid> solids;
  const double middle = 0.5 * h * scene.across;
  for (const Member& m : scene.members) {
    solids.push_back(solidOf(m, 1, upright, middle, h));
    if (!m.onAxis) solids.push_back(solidOf(m, -1, upright, middle, h));
  }
  return solids;
}

/// Of a link: where, which way, how long, how held, how fast.
using LinkKey = std::tuple<int, int, int, int, float, float, float>;

std::vector<LinkKey> linksOf(const Boundary& b, bool ofU, bool upright, bool mirrored) {
  std::vector<LinkKey> keys;
  for (CutLink link : ofU ? b.linksU : b.linksV) {
    if (mirrored && upright) {
      link.i = (ofU ? b.grid.nx : b.grid.nx - 1) - link.i;
      if (b.periodicX()) link.i %= b.grid.nx;  // the column beyond repeats the first
      link.di = -link.di;
      if (ofU) link.velocity = -link.velocity;
    } else if (mirrored) {
      link.j = (ofU ? b.grid.ny - 1 : b.grid.ny) - link.j;
      if (b.periodicY()) link.j %= b.grid.ny;
      link.dj = -link.dj;
      if (!ofU) link.velocity = -link.velocity;
    }
    keys.emplace_back(link.j, link.i, link.di, link.dj, link.theta, link.drag, link.velocity + 0.0f);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

/// What is not the same in the mirror; empty if all is.
std::string difference(const Boundary& b, bool upright) {
  const int nx = b.grid.nx, ny = b.grid.ny;
  std::string text;
  const auto compare = [&](const char* what, int i, int j, float a, float image) {
    if (a != image && text.size() < 500)
      text += std::string(what) + "(" + std::to_string(i) + ", " + std::to_string(j) +
              "): " + std::to_string(a) + " and " + std::to_string(image) + " differ by " +
              std::to_string(1e9 * (a - image)) + "e-9\n";
  };
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      const int x = upright ? nx - 1 - i : i, y = upright ? j : ny - 1 - j;  // of the image of a cell,
      const int xFace = upright ? nx - i : i, yFace = upright ? j : ny - j;  // of a face
      const float ofU = upright ? -1 : 1, ofV = -ofU;
      if (j < ny) compare("openX", i, j, b.openX(i, j), b.openX(xFace, y));
      if (j < ny) compare("wallU", i, j, b.wallU(i, j), ofU * b.wallU(xFace, y));
      if (i < nx) compare("openY", i, j, b.openY(i, j), b.openY(x, yFace));
      if (i < nx) compare("wallV", i, j, b.wallV(i, j), ofV * b.wallV(x, yFace));
      if (i < nx && j < ny) compare("volume", i, j, b.volume(i, j), b.volume(x, y));
      if (i < nx && j < ny && (b.regions.at(i, j) < 0) != (b.regions.at(x, y) < 0))
        text += "a region is not there\n";
    }
  for (const bool ofU : {true, false}) {
    const std::vector<LinkKey> links = linksOf(b, ofU, upright, false),
                               images = linksOf(b, ofU, upright, true);
    if (links == images) continue;
    text += ofU ? "links of u differ\n" : "links of v differ\n";
    const auto [one, other] = std::mismatch(links.begin(), links.end(), images.begin(), images.end());
    for (const LinkKey& key :
         {one == links.end() ? LinkKey{} : *one, other == images.end() ? LinkKey{} : *other})
      std::apply([&](auto... part) { ((text += std::to_string(part) + " "), ...); }, key), text += "\n";
  }
  return text;
}

std::string difference(const Scene& scene, bool upright) {
  Boundary b;
  b.grid.nx = upright ? scene.across : scene.along;
  b.grid.ny = upright ? scene.along : scene.across;
  b.grid.h = 1.0 / scene.across;
  for (SideFlow& side : b.sides) side.kind = WallKind::noSlip;
  for (const Side side : {upright ? Side::left : Side::bottom, upright ? Side::right : Side::top})
    b.sides[static_cast<int>(side)].kind = scene.sides;
  SolidsOnGrid grid;
  grid.cover(solidsOf(scene, upright, b.grid.h), true, b);
  return difference(b, upright);
}

class Random {
 public:
  explicit Random(unsigned seed) : bits_(seed) {}
  double in(double lo, double hi) { return lo + (hi - lo) * (bits_() * 0x1p-32); }
  int of(int n) { return static_cast<int>(bits_() % static_cast<unsigned>(n)); }

 private:
  std::mt19937 bits_;
};

/// Shapes that are their own images left to right and up to down.
Shape shapeOf(Random& random) {
  switch (random.of(6)) {
    case 0:
      return CircleShape{random.in(0.2, 5)};
    case 1:
      return BoxShape{{random.in(4, 16), 0.2}};  // thinner than a cell
    case 2:
      return EllipseShape{{random.in(1, 6), random.in(0.5, 3)}};
    case 3:
      return CapsuleShape{random.in(1, 9), random.in(0.1, 2)};
    default:
      return BoxShape{{random.in(1, 10), random.in(1, 10)}};
  }
}

struct InCells {
  double h;
  Shape operator()(CircleShape s) const { return CircleShape{h * s.radius}; }
  Shape operator()(BoxShape s) const { return BoxShape{h * s.size}; }
  Shape operator()(EllipseShape s) const { return EllipseShape{h * s.radii}; }
  Shape operator()(CapsuleShape s) const { return CapsuleShape{h * s.length, h * s.radius}; }
  template <class Other>
  Shape operator()(const Other& s) const {
    return s;
  }
};

/// Solids about the axis that overlap one another; numbers are often round ones, as in scenes.
Scene sceneOf(Random& random) {
  Scene scene;
  scene.across = 24 + random.of(17);
  scene.along = 24 + random.of(17);
  const int coarse = random.of(3);
  const auto round = [&](double x) {
    return coarse == 0 ? x : std::nearbyint(x * 2 * coarse) / (2 * coarse);
  };
  for (int k = 0, count = 1 + random.of(3); k < count; ++k) {
    Member m;
    m.shape = std::visit(InCells{1.0 / scene.across}, shapeOf(random));
    m.onAxis = k > 0 && random.of(3) == 0;
    if (!m.onAxis) m.across = round(random.in(0, 6));
    m.along = round(random.in(0.3, 0.7) * scene.along);
    if (!m.onAxis && random.of(2) == 0) m.angle = coarse == 2 ? kPi / 12 * random.of(12) : random.in(0, kPi);
    if (random.of(4) > 0) {
      if (!m.onAxis) m.speedAcross = round(random.in(-3, 3));
      m.speedAlong = round(random.in(-3, 3));
      if (!m.onAxis) m.spin = round(random.in(-9, 9));
    }
    m.drag = 0.5 * random.of(3);
    scene.members.push_back(m);
  }
  if (random.of(4) == 0) {  // across the sides
    scene.sides = WallKind::periodic;
    for (Member& m : scene.members) m.across = 0.5 * scene.across - m.across;
    for (Member& m : scene.members)
      if (m.onAxis) m.across = 0;
  }
  return scene;
}

TEST(SolidsOnGridMirror, WhatOverlapsIsItsOwnImage) {
  // Truth: a mirrored set of solids has mirrored shares, velocities and links; not a bit differs.
  for (unsigned seed = 0; seed < 1500; ++seed) {
    Random random(seed);
    const Scene scene = sceneOf(random);
    for (const bool upright : {true, false}) {
      const std::string off = difference(scene, upright);
      ASSERT_TRUE(off.empty()) << "scene " << seed << (upright ? ", upright\n" : ", aside\n") << off;
    }
  }
}

}  // namespace
}  // namespace smokebox
