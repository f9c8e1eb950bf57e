// Bodies that start where they cannot be: outside of the domain, in each other, in a solid or a wall; and
// groups to `ignore` that have one member only.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "geometry/merge.h"
#include "scene/places.h"
#include "scene/sections.h"

namespace smokebox {
namespace {

constexpr double kSlack = 5e-3;  // of the smaller one's size: what touches does not overlap
constexpr int kMostWarnings = 8;
constexpr double kSmallest = 1e-7, kLargest = 1e3;  // of the domain's longer side
constexpr double kFarAway = 10;                     // of that too: of a joint's place outside of it
constexpr const char* kSideNames[] = {"left", "right", "bottom", "top"};
constexpr double kLightest = 1e-12, kHeaviest = 1e12;  // kg

/// A body, a particle or a solid at the start.
struct Thing {
  int body = -1, solid = -1;
  Vec2 low, high;
  std::vector<Outline> outlines;

  double size() const { return std::min(high.x - low.x, high.y - low.y); }
};

Thing thingOf(const std::vector<Outline>& local, const Pose& pose) {
  Thing thing;
  thing.low = {INFINITY, INFINITY};
  thing.high = {-INFINITY, -INFINITY};
  for (const Outline& outline : local) {
    thing.outlines.push_back(transformed(outline, pose));
    for (const Vec2 p : thing.outlines.back()) {
      thing.low = {std::min(thing.low.x, p.x), std::min(thing.low.y, p.y)};
      thing.high = {std::max(thing.high.x, p.x), std::max(thing.high.y, p.y)};
    }
  }
  return thing;
}

bool boxesMeet(const Thing& a, const Thing& b, double slack) {
  return a.low.x + slack < b.high.x && b.low.x + slack < a.high.x && a.low.y + slack < b.high.y &&
         b.low.y + slack < a.high.y;
}

bool segmentsCross(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const double c1 = cross(b - a, c - a), d1 = cross(b - a, d - a), a2 = cross(d - c, a - c),
               b2 = cross(d - c, b - c);
  return (c1 > 0) != (d1 > 0) && (a2 > 0) != (b2 > 0);
}

bool outlinesCross(const Outline& a, const Thing& other) {
  for (std::size_t k = 0; k < a.size(); ++k) {
    const Vec2 p = a[k], q = a[k + 1 < a.size() ? k + 1 : 0];
    if (std::max(p.x, q.x) < other.low.x || std::min(p.x, q.x) > other.high.x ||
        std::max(p.y, q.y) < other.low.y || std::min(p.y, q.y) > other.high.y)
      continue;
    for (const Outline& b : other.outlines)
      for (std::size_t m = 0; m < b.size(); ++m)
        if (segmentsCross(p, q, b[m], b[m + 1 < b.size() ? m + 1 : 0])) return true;
  }
  return false;
}

/// Do they overlap, deeper than by a touch?
bool overlap(const Thing& a, const Thing& b) {
  const double slack = kSlack * std::min(a.size(), b.size());
  if (!boxesMeet(a, b, slack)) return false;
  Thing smaller = a;
  for (std::size_t k = 0; k < a.outlines.size(); ++k) growOutline(a.outlines[k], -slack, smaller.outlines[k]);
  for (const Outline& outline : smaller.outlines)
    if (outlinesCross(outline, b)) return true;
  return contains(b.outlines, smaller.outlines[0][0]) || contains(smaller.outlines, b.outlines[0][0]);
}

bool passThroughEachOther(const BodySpec& a, const BodySpec& b) {
  return std::any_of(a.ignore.begin(), a.ignore.end(), [&](const std::string& group) {
    return std::find(b.ignore.begin(), b.ignore.end(), group) != b.ignore.end();
  });
}

bool isJoined(const SceneSpec& spec, const Thing& a, const Thing& b) {
  auto is = [](const HoldSpec& end, const Thing& thing) {
    return thing.body >= 0 ? end.of == HoldSpec::Of::body && end.index == thing.body
                           : end.of == HoldSpec::Of::solid && end.index == thing.solid;
  };
  return std::any_of(spec.joints.begin(), spec.joints.end(), [&](const JointSpec& joint) {
    return joint.kind != JointSpec::Kind::rope &&
           ((is(joint.a, a) && is(joint.b, b)) || (is(joint.a, b) && is(joint.b, a)));
  });
}

struct Checks {
  MapReader& scene;
  const SceneSpec& spec;
  std::vector<Thing> things;

  const YamlMark& markOf(const BodySpec& body) {
    const char* list = body.later ? "events" : body.particle ? "particles" : "bodies";
    return scene.find(list)->items[body.item]->mark;
  }
  std::string nameOf(const Thing& thing) const {
    return "`" + (thing.body >= 0 ? spec.bodies[thing.body].name : spec.solids[thing.solid].name) + "`";
  }

  void place() {
    std::map<const Shape*, std::vector<Outline>> local;  // copies share theirs
    auto outlines = [&](const Shape& shape) -> const std::vector<Outline>& {
      std::vector<Outline>& made = local[&shape];
      if (made.empty()) {
        const std::vector<Outline> rough = outlinesOf({shape, {}}, 1e9);
        const Thing box = thingOf(rough, {});
        made = outlinesOf({shape, {}}, 0.2 * kSlack * box.size());
      }
      return made;
    };
    things.reserve(spec.bodies.size() + spec.solids.size());
    for (std::size_t k = 0; k < spec.bodies.size(); ++k) {
      things.push_back(thingOf(outlines(*spec.bodies[k].shape), spec.bodies[k].pose));
      things.back().body = static_cast<int>(k);
    }
    for (std::size_t k = 0; k < spec.solids.size(); ++k) {
      const SolidSpec& solid = spec.solids[k];
      things.push_back(thingOf(outlines(solid.shape.shape), solid.motion.poseAt(0, solid.shape.pose)));
      things.back().solid = static_cast<int>(k);
    }
  }

  /// Sizes and masses with which nothing can be reckoned.
  void checkSizes() {
    const double domain = std::max(spec.domain.grid.width(), spec.domain.grid.height());
    for (const Thing& thing : things) {
      if (thing.body < 0) continue;
      const BodySpec& body = spec.bodies[thing.body];
      if (!isFirst(thing)) continue;
      const double across = std::max(thing.high.x - thing.low.x, thing.high.y - thing.low.y);
      char size[40];
      std::snprintf(size, sizeof size, "%.3g m", across);
      if (!(across >= kSmallest * domain) || !(across <= kLargest * domain)) {
        scene.reader().error(markOf(body), nameOf(thing) + " is too " +
                                               (across > domain ? "large" : "small") +
                                               " for this domain: " + size + " across");
        continue;
      }
      const double mass = body.mass.value_or(body.density * across * across);
      if (!(mass >= kLightest) || !(mass <= kHeaviest))
        scene.reader().error(markOf(body), nameOf(thing) + " has a mass beyond reckoning",
                             "from 1e-12 to 1e12 kg");
    }
  }

  /// The first of the copies of a `repeat`, which are much alike.
  bool isFirst(const Thing& thing) const {
    return thing.body == 0 || spec.bodies[thing.body - 1].family != spec.bodies[thing.body].family;
  }

  /// The first wall that this box reaches into by more than `slack`; -1: none.
  int wallBehind(Vec2 low, Vec2 high, double slack) const {
    const Grid& grid = spec.domain.grid;
    const double beyond[4] = {-low.x, high.x - grid.width(), -low.y, high.y - grid.height()};
    for (int side = 0; side < 4; ++side) {
      const WallKind kind = spec.domain.walls[side].kind;
      if (kind != WallKind::open && kind != WallKind::periodic && beyond[side] > slack) return side;
    }
    return -1;
  }

  void checkInside() {
    const double width = spec.domain.grid.width(), height = spec.domain.grid.height();
    int in = 0;
    std::map<std::string, std::pair<int, int>> outside;  // of each family: its first, and how many
    for (const Thing& thing : things) {
      if (thing.body < 0) continue;
      const BodySpec& body = spec.bodies[thing.body];
      if (thing.high.x <= 0 || thing.high.y <= 0 || thing.low.x >= width || thing.low.y >= height) {
        ++outside.try_emplace(body.family, thing.body, 0).first->second.second;
        continue;
      }
      const int side = wallBehind(thing.low, thing.high, kSlack * thing.size());
      if (side >= 0 && ++in <= kMostWarnings)
        scene.reader().warning(markOf(body), nameOf(thing) + " starts in the " + kSideNames[side] + " wall",
                               "it will be pushed out gently");
    }
    for (const auto& [family, first] : outside) {
      const BodySpec& body = spec.bodies[first.first];
      const std::string others =
          first.second > 1 ? " and " + std::to_string(first.second - 1) + " more of its copies start"
                           : " starts";
      scene.reader().error(markOf(body), "`" + body.name + "`" + others + " outside of the domain",
                           body.particle ? "" : "`position` is where the shape's own (0, 0) is");
    }
  }

  /// A sweep along x.
  void checkOverlaps() {
    std::vector<int> order;
    for (int k = 0; k < static_cast<int>(things.size()); ++k)
      if (things[k].body < 0 || !spec.bodies[things[k].body].later) order.push_back(k);
    std::sort(order.begin(), order.end(), [&](int a, int b) {
      return things[a].low.x != things[b].low.x ? things[a].low.x < things[b].low.x : a < b;
    });
    std::vector<int> active;
    std::vector<std::pair<int, int>> pairs;
    for (const int k : order) {
      const Thing& thing = things[k];
      std::erase_if(active, [&](int other) { return things[other].high.x <= thing.low.x; });
      for (const int other : active) {
        const Thing& with = things[other];
        if (with.high.y <= thing.low.y || with.low.y >= thing.high.y) continue;
        if (thing.body < 0 && with.body < 0) continue;
        if (thing.body >= 0 && with.body >= 0 &&
            passThroughEachOther(spec.bodies[thing.body], spec.bodies[with.body]))
          continue;
        if (isJoined(spec, thing, with) || !overlap(thing, with)) continue;
        pairs.emplace_back(std::max(k, other), std::min(k, other));
      }
      active.push_back(k);
    }
    std::sort(pairs.begin(), pairs.end());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const Thing &a = things[pairs[k].second], &b = things[pairs[k].first];
      if (k + 1 == kMostWarnings && pairs.size() > kMostWarnings) {
        scene.reader().warning(markOf(spec.bodies[a.body]), "and " + std::to_string(pairs.size() - k) +
                                                                " more pairs start inside of each other");
        break;
      }
      const Thing& told = b.body >= 0 ? b : a;  // solids come last
      scene.reader().warning(markOf(spec.bodies[told.body]),
                             nameOf(a) + " and " + nameOf(b) + " start inside of each other",
                             b.body >= 0 ? "they will part gently; `ignore: [a]` for both lets them pass"
                                         : "they will part gently");
    }
  }

  void checkGroups() {
    constexpr std::size_t kMostGroups = 64;  // a bit each; and one for each cloth
    std::map<std::string, int> members;
    const YamlMark* tooMany = nullptr;
    auto count = [&](const std::vector<std::string>& groups, const YamlMark& mark) {
      for (const std::string& group : groups) ++members[group];
      if (!tooMany && members.size() + spec.cloths.size() > kMostGroups) tooMany = &mark;
    };
    for (const BodySpec& body : spec.bodies) count(body.ignore, markOf(body));
    for (std::size_t k = 0; k < spec.cloths.size(); ++k)
      count(spec.cloths[k].ignore, scene.find("cloth")->items[k]->mark);
    if (tooMany)
      return scene.reader().error(*tooMany, "more than 64 groups in `ignore`, with one for each cloth (" +
                                                std::to_string(members.size()) + " and " +
                                                std::to_string(spec.cloths.size()) + ")");
    auto warn = [&](const std::vector<std::string>& groups, const std::string& name, const YamlMark& mark) {
      for (const std::string& group : groups)
        if (members[group] == 1)
          scene.reader().warning(mark, "`" + name + "` is the only one in the group `" + group + "`",
                                 "bodies that share a group pass through each other");
    };
    for (const BodySpec& body : spec.bodies) warn(body.ignore, body.name, markOf(body));
    for (std::size_t k = 0; k < spec.cloths.size(); ++k)
      warn(spec.cloths[k].ignore, spec.cloths[k].name, scene.find("cloth")->items[k]->mark);
  }

  void checkCloths() {
    const double width = spec.domain.grid.width(), height = spec.domain.grid.height();
    for (std::size_t k = 0; k < spec.cloths.size(); ++k) {
      const ClothSpec& cloth = spec.cloths[k];
      const Vec2 high = cloth.corner + cloth.size;
      const YamlMark& mark = scene.find("cloth")->items[k]->mark;
      if (high.x <= 0 || high.y <= 0 || cloth.corner.x >= width || cloth.corner.y >= height) {
        scene.reader().error(mark, "`" + cloth.name + "` starts outside of the domain");
        continue;
      }
      const double slack = kSlack * std::min(cloth.size.x, cloth.size.y);
      const int side = wallBehind(cloth.corner, high, slack);
      if (side >= 0)
        scene.reader().warning(mark, "`" + cloth.name + "` starts in the " + kSideNames[side] + " wall",
                               "it will be pushed out gently, as far as it is not pinned");
    }
  }

  /// A place that no body can be near of is most likely a slip.
  void checkJoints() {
    const double width = spec.domain.grid.width(), height = spec.domain.grid.height();
    const double far = kFarAway * std::max(width, height);
    const auto isFar = [&](const std::optional<Vec2>& place) {
      return place &&
             (place->x < -far || place->y < -far || place->x > width + far || place->y > height + far);
    };
    for (std::size_t k = 0; k < spec.joints.size(); ++k) {
      const JointSpec& joint = spec.joints[k];
      const YamlNode& node = *scene.find("joints")->items[k];
      for (const auto& [key, place] : {std::pair{"at", &joint.at}, {"from", &joint.from}, {"to", &joint.to}})
        if (isFar(*place))
          scene.reader().warning(
              node.entry(key)->value->mark,
              "`joints." + std::to_string(k) + "." + key + "` is far outside of the domain",
              "places of joints are in the world's metres, at the start");
    }
  }
};

}  // namespace

void checkBodies(MapReader& scene, const SceneSpec& spec) {
  if (spec.bodies.empty() && spec.cloths.empty()) return;
  Checks checks{scene, spec, {}};
  checks.place();
  checks.checkSizes();
  checks.checkInside();
  checks.checkOverlaps();
  checks.checkGroups();
  checks.checkCloths();
  checks.checkJoints();
}

}  // namespace smokebox
