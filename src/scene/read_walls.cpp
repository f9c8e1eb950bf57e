// walls, and whether what flows in can get out
#include <cmath>

#include "scene/nearest.h"
#include "scene/sections.h"

namespace smokebox {
namespace {

constexpr std::array<const char*, 4> kSides{"left", "right", "bottom", "top"};
const std::vector<std::string> kWallKinds{"slip", "no-slip", "open", "inflow", "periodic"};

std::optional<WallKind> kindOf(const std::string& word) {
  constexpr WallKind kKinds[] = {WallKind::slip, WallKind::noSlip, WallKind::open, WallKind::inflow,
                                 WallKind::periodic};
  for (std::size_t k = 0; k < kWallKinds.size(); ++k)
    if (kWallKinds[k] == word) return kKinds[k];
  return {};
}

void readWall(Reader& reader, const YamlNode& node, const std::string& name, bool vertical, WallSpec& wall) {
  if (node.kind == YamlNode::Kind::scalar) {
    const auto kind = kindOf(node.text);
    if (!kind) {
      reader.error(node.mark, "unknown wall `" + node.text + "` in `" + name + "`",
                   suggestion(node.text, kWallKinds));
    } else if (*kind == WallKind::inflow) {
      reader.error(node.mark, "an inflow needs a velocity", "such as {inflow: [1, 0]}");
    } else {
      wall.kind = *kind;
    }
    return;
  }
  if (node.kind != YamlNode::Kind::map) {
    reader.error(node.mark, "`" + name + "` must be the kind of a wall, got " + node.description(),
                 "slip, no-slip, open, periodic, {inflow: [x, y]} or {no-slip: [x, y]}");
    return;
  }
  if (node.entries.size() != 1) {
    reader.error(node.mark, "`" + name + "` must name one kind of wall");
    return;
  }
  MapReader map(reader, node, name);
  if (const YamlNode* inflow = map.find("inflow")) {
    if (auto velocity = reader.expressions(*inflow, inside(name, "inflow"), "xyt")) {
      wall.kind = WallKind::inflow;
      wall.velocity = std::move(*velocity);
    }
  } else if (const YamlNode* moving = map.find("no-slip")) {
    if (const auto velocity = reader.vector(*moving, inside(name, "no-slip"))) {
      if ((vertical ? velocity->x : velocity->y) != 0)
        reader.error(moving->mark, "`" + name + "`: a wall can only slide along itself",
                     vertical ? "[0, speed]" : "[speed, 0]");
      wall.kind = WallKind::noSlip;
      wall.velocity = {Expression(velocity->x), Expression(velocity->y)};
    }
  }
  map.finish();
}

/// What flows in through a side at a time, m^2/s; where it is not finite, the place is given back too.
struct Inward {
  double net = 0, total = 0;
  std::optional<Vec2> fault;
};

Inward inwardFlow(const DomainSpec& domain, int side, double t, int points) {
  const bool vertical = side < 2;
  const double width = domain.grid.width(), height = domain.grid.height(), span = vertical ? height : width;
  const double sign = side % 2 == 0 ? 1 : -1;
  const WallSpec& wall = domain.walls[side];
  Inward flow;
  for (int k = 0; k < points; ++k) {
    const double along = (k + 0.5) * span / points;
    const Vec2 at = vertical ? Vec2{side == 1 ? width : 0, along} : Vec2{along, side == 3 ? height : 0};
    const Vec2 half = (0.5 * span / points) * (vertical ? Vec2{0, 1} : Vec2{1, 0});
    const Vec2 velocity{wall.mean(0, at, half, t), wall.mean(1, at, half, t)};
    if (!std::isfinite(velocity.x) || !std::isfinite(velocity.y)) {
      flow.fault = at;
      return flow;
    }
    const double through = sign * (vertical ? velocity.x : velocity.y) * span / points;
    flow.net += through;
    flow.total += std::fabs(through);
  }
  return flow;
}

}  // namespace

void readWalls(MapReader& scene, SceneSpec& spec) {
  const YamlNode* node = scene.find("walls");
  if (!node) return;
  MapReader map(scene.reader(), *node, "walls");
  for (int side = 0; side < 4; ++side)
    if (const YamlNode* wall = map.find(kSides[side]))
      readWall(scene.reader(), *wall, inside("walls", kSides[side]), side < 2, spec.domain.walls[side]);
  map.finish();
  for (int side = 0; side < 4; ++side) {
    const int opposite = side ^ 1;
    if (spec.domain.walls[side].kind == WallKind::periodic &&
        spec.domain.walls[opposite].kind != WallKind::periodic)
      scene.reader().error(
          map.keyMark(kSides[side]),
          "`walls." + std::string(kSides[side]) + "` is periodic, and then its opposite must be too",
          "walls." + std::string(kSides[opposite]) + ": periodic");
  }
}

void checkInflow(MapReader& scene, const SceneSpec& spec) {
  const YamlNode* node = scene.find("walls");
  if (!node || node->kind != YamlNode::Kind::map) return;
  MapReader map(scene.reader(), *node, "walls");
  bool anyOpen = false, onTime = false;
  std::vector<int> inflows;
  for (int side = 0; side < 4; ++side) {
    const WallSpec& wall = spec.domain.walls[side];
    anyOpen |= wall.kind == WallKind::open;
    if (wall.kind != WallKind::inflow) continue;
    inflows.push_back(side);
    onTime |= wall.velocity[0].dependsOnTime() || wall.velocity[1].dependsOnTime();
  }
  if (inflows.empty()) return;
  // With a way out only the values themselves are looked at, and a few of them tell.
  const int times = onTime ? 8 : 1;
  for (int k = 0; k < times; ++k) {
    const double t = k * spec.time.duration / 7.37;  // no whole fraction, so that a period is not missed
    double net = 0, total = 0;
    for (int side : inflows) {
      const bool vertical = side < 2;
      const int cells = vertical ? spec.domain.grid.ny : spec.domain.grid.nx;
      const Inward flow = inwardFlow(spec.domain, side, t, anyOpen ? std::min(cells, 17) : cells);
      if (flow.fault) {
        scene.reader().error(map.keyMark(kSides[side]),
                             "the inflow of `walls." + std::string(kSides[side]) +
                                 "` is not a finite number at x = " + std::to_string(flow.fault->x) +
                                 ", y = " + std::to_string(flow.fault->y) + ", t = " + std::to_string(t));
        return;
      }
      net += flow.net;
      total += flow.total;
    }
    // What rounding and Gauss' rule leave over is spread evenly, as where a piston moves.
    constexpr double kBalanced = 1e-5;
    if (!anyOpen && std::fabs(net) > kBalanced * total) {
      scene.reader().error(map.keyMark(kSides[inflows.front()]),
                           "an inflow without a way out: " + std::to_string(std::fabs(net)) + " m^2/s flow " +
                               (net > 0 ? "in" : "out") + " at t = " + std::to_string(t) + " s",
                           "make a wall `open`, or let as much out by an inflow that points outwards");
      return;
    }
  }
}

}  // namespace smokebox
