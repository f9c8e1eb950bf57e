#include "world/cloth_mesh.h"

#include <algorithm>

namespace smokebox {

namespace {
// A cell counts as turned over below this share of its area,
constexpr double kTurned = 0.05;
// and when it is turned back, its springs get their length back within so many seconds.
constexpr double kRecovery = 0.5;
}  // namespace

ClothMesh::ClothMesh(const ClothSpec& spec, std::shared_ptr<const BodyShape> particle, std::uint64_t ignore,
                     RigidSystem& system)
    : spec_(spec) {
  const int columns = spec.columns(), rows = spec.rows(), count = columns * rows;
  for (int k = 0; k < count; ++k) {
    BodyDef def;
    def.shape = particle;
    def.position = spec.nodeAt(k);
    def.mass = spec.mass / count;
    def.bounce = spec.bounce;
    def.friction = spec.friction;
    def.linearDamping = spec.linearDamping;
    def.gravityScale = spec.gravityScale;
    def.ignore = ignore;
    def.held = std::binary_search(spec.pinned.begin(), spec.pinned.end(), k);
    bodies_.push_back(system.add(def));
  }
  for (std::vector<Link>* links : {&right_, &up_, &farRight_, &farUp_, &rising_, &falling_})
    links->resize(count);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int k = node(i, j);
      const bool right = i + 1 < columns, up = j + 1 < rows;
      if (right) right_[k] = join(k, node(i + 1, j), spec.stiffness, spec.tear, system);
      if (up) up_[k] = join(k, node(i, j + 1), spec.stiffness, spec.tear, system);
      if (right && up) {
        rising_[k] = join(k, node(i + 1, j + 1), spec.shear, spec.tear, system);
        falling_[k] = join(node(i + 1, j), node(i, j + 1), spec.shear, spec.tear, system);
      }
      if (i + 2 < columns) farRight_[k] = join(k, node(i + 2, j), spec.bend, kForever, system);
      if (j + 2 < rows) farUp_[k] = join(k, node(i, j + 2), spec.bend, kForever, system);
    }
  whole_.assign(static_cast<std::size_t>(columns - 1) * (rows - 1), 1);
  lost_.assign(whole_.size(), 0);
  slack_.assign(whole_.size(), 0);
}

ClothMesh::Link ClothMesh::join(int a, int b, double stiffness, double tear, RigidSystem& system) const {
  if (stiffness == 0) return {};
  SpringDef spring;
  spring.from.body = bodies_[a];
  spring.to.body = bodies_[b];
  spring.length = length(spec_.nodeAt(b) - spec_.nodeAt(a));
  spring.stiffness = stiffness;
  spring.damping = spec_.damping * stiffness / spec_.stiffness;
  spring.tear = tear;
  return {system.addSpring(spring), true, spring.length, 0};
}

void ClothMesh::remove(RigidSystem& system) const {
  for (const int body : bodies_)
    if (system.isThere(body)) system.remove(body);
}

bool ClothMesh::isThere(const RigidSystem& system) const {
  return std::any_of(bodies_.begin(), bodies_.end(), [&](int body) { return system.isThere(body); });
}

void ClothMesh::update(RigidSystem& system, double dt) {
  dropTorn(system);
  loosen(system, dt);
}

void ClothMesh::dropTorn(RigidSystem& system) {
  if (system.springsRemoved() == removed_) return;
  removed_ = system.springsRemoved();
  bool torn = false;
  for (std::vector<Link>* links : {&right_, &up_, &farRight_, &farUp_, &rising_, &falling_})
    for (Link& link : *links) {
      if (!link.there || system.springIsThere(link.spring)) continue;
      link.there = false;
      torn = true;
    }
  if (!torn) return;
  const int columns = spec_.columns(), rows = spec_.rows();
  auto drop = [&](Link& link) {
    if (!link.there) return;
    system.removeSpring(link.spring);
    link.there = false;
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int k = node(i, j);
      if (i + 2 < columns && !(right_[k].there && right_[k + 1].there)) drop(farRight_[k]);
      if (j + 2 < rows && !(up_[k].there && up_[k + columns].there)) drop(farUp_[k]);
      if (i + 1 == columns || j + 1 == rows) continue;
      const std::size_t cell = i + static_cast<std::size_t>(j) * (columns - 1);
      lost_[cell] = lostCorner(i, j, system);
      whole_[cell] = !lost_[cell] && cellIsWhole(i, j);
    }
}

bool ClothMesh::lostCorner(int i, int j, const RigidSystem& system) const {
  const int k = node(i, j), above = node(i, j + 1);
  return !(system.isThere(bodies_[k]) && system.isThere(bodies_[k + 1]) && system.isThere(bodies_[above]) &&
           system.isThere(bodies_[above + 1]));
}

bool ClothMesh::cellIsWhole(int i, int j) const {
  const int k = node(i, j), columns = spec_.columns();
  if (spec_.shear > 0 && !(rising_[k].there && falling_[k].there)) return false;
  return (right_[k].there || right_[k + columns].there) && (up_[k].there || up_[k + 1].there);
}

float ClothMesh::slackAt(int i, int j) const {
  const int cellsX = spec_.cells[0], cellsY = spec_.cells[1];
  return i < 0 || j < 0 || i >= cellsX || j >= cellsY ? 0 : slack_[i + static_cast<std::size_t>(j) * cellsX];
}

void ClothMesh::loosen(RigidSystem& system, double dt) {
  const int columns = spec_.columns(), rows = spec_.rows();
  const double flat = (spec_.size.x / spec_.cells[0]) * (spec_.size.y / spec_.cells[1]);
  const bool before = slackened_;
  slackened_ = false;
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns; ++i) {
      const int k = node(i, j);
      const std::size_t cell = i + static_cast<std::size_t>(j) * (columns - 1);
      float& slack = slack_[cell];
      if (lost_[cell]) {
        slack = 0;
        continue;
      }
      auto at = [&](int corner) { return system.positionBeside(bodies_[corner], bodies_[k]); };
      const double area = 0.5 * cross(at(k + columns + 1) - at(k), at(k + columns) - at(k + 1));
      slack = area < kTurned * flat ? 1 : std::max(0.0f, slack - static_cast<float>(dt / kRecovery));
      slackened_ |= slack > 0;
    }
  if (!before && !slackened_) return;
  auto set = [&](Link& link, float slack) {
    if (!link.there || link.slack == slack) return;
    link.slack = slack;
    system.setSpringSlack(link.spring, slack * link.length);
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int k = node(i, j);
      const float own = slackAt(i, j), right = std::max(own, slackAt(i, j - 1)),
                  up = std::max(own, slackAt(i - 1, j));
      set(right_[k], right);
      set(up_[k], up);
      set(rising_[k], own);
      set(falling_[k], own);
      set(farRight_[k], std::max({right, slackAt(i + 1, j), slackAt(i + 1, j - 1)}));
      set(farUp_[k], std::max({up, slackAt(i, j + 1), slackAt(i - 1, j + 1)}));
    }
}

void ClothMesh::capture(const RigidSystem& system, int index, ClothPicture& picture) const {
  picture.name = spec_.name;
  picture.index = index;
  picture.columns = spec_.columns();
  picture.rows = spec_.rows();
  picture.radius = spec_.radius;
  picture.color = spec_.color;
  picture.whole = whole_;
  picture.positions.resize(bodies_.size());
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    picture.positions[k] = system.positionBeside(bodies_[k], bodies_[bodies_.size() / 2]);
  picture.threads.clear();
  const int columns = picture.columns, rows = picture.rows;
  const auto whole = [&](int i, int j) {
    return i >= 0 && j >= 0 && i + 1 < columns && j + 1 < rows &&
           whole_[i + static_cast<std::size_t>(j) * (columns - 1)];
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int k = node(i, j);
      if (right_[k].there && !whole(i, j) && !whole(i, j - 1)) picture.threads.push_back({k, k + 1});
      if (up_[k].there && !whole(i, j) && !whole(i - 1, j)) picture.threads.push_back({k, k + columns});
    }
}

}  // namespace smokebox
