// cloth
#include <algorithm>
#include <cctype>
#include <cmath>

#include "scene/names.h"
#include "scene/sections.h"

namespace smokebox {
namespace {

constexpr long kMostCells = 1000;

/// One of the words for a side, or the column and row of a particle.
void readPinnedPart(Reader& reader, const YamlNode& node, const std::string& name, const ClothSpec& cloth,
                    std::vector<int>& pinned) {
  const int columns = cloth.columns(), right = cloth.cells[0], top = cloth.cells[1];
  auto add = [&](int i, int j) { pinned.push_back(i + j * columns); };
  if (node.kind == YamlNode::Kind::list) {
    if (!reader.isList(node, name, 2)) return;
    const auto i = reader.whole(*node.items[0], inside(name, "0"), 0, right);
    const auto j = reader.whole(*node.items[1], inside(name, "1"), 0, top);
    if (i && j) add(static_cast<int>(*i), static_cast<int>(*j));
    return;
  }
  const auto word = reader.text(node, name);
  if (!word) return;
  if (*word == "top" || *word == "bottom") {
    for (int i = 0; i <= right; ++i) add(i, *word == "top" ? top : 0);
  } else if (*word == "left" || *word == "right") {
    for (int j = 0; j <= top; ++j) add(*word == "left" ? 0 : right, j);
  } else if (*word == "corners" || *word == "top-corners") {
    for (const int i : {0, right}) {
      if (*word == "corners") add(i, 0);
      add(i, top);
    }
  } else if (*word != "none") {
    reader.error(node.mark, "`" + name + "` must be a side or a particle, got `" + *word + "`",
                 "top, bottom, left, right, corners, top-corners, none, or [column, row]");
  }
}

void readPinned(Reader& reader, const YamlNode& node, const std::string& name, ClothSpec& cloth) {
  // [0, 14] is a particle, and so is each item of [[0, 14], [24, 14]]; items may be words.
  const bool single = node.kind != YamlNode::Kind::list ||
                      (!node.items.empty() && node.items[0]->kind == YamlNode::Kind::scalar &&
                       std::isdigit(static_cast<unsigned char>((node.items[0]->text + "x")[0])));
  if (single) {
    readPinnedPart(reader, node, name, cloth, cloth.pinned);
  } else {
    for (std::size_t k = 0; k < node.items.size(); ++k)
      readPinnedPart(reader, *node.items[k], inside(name, std::to_string(k)), cloth, cloth.pinned);
  }
  std::sort(cloth.pinned.begin(), cloth.pinned.end());
  cloth.pinned.erase(std::unique(cloth.pinned.begin(), cloth.pinned.end()), cloth.pinned.end());
}

void readCloth(Reader& reader, const YamlNode& node, const std::string& name, SceneSpec& spec) {
  MapReader map(reader, node, name);
  const std::size_t faults = reader.errors();
  ClothSpec cloth;
  if (map.text("name", cloth.name)) {
    checkNewName(reader, *map.find("name"), spec, cloth.name);
  } else {
    std::size_t number = spec.cloths.size();
    do cloth.name = "cloth " + std::to_string(++number);
    while (spec.names.find(cloth.name));
  }
  cloth.size = {1, 1};
  if (map.required("corner", "its lower left, [x, y]")) map.vector("corner", cloth.corner);
  if (map.required("size", "width and height, metres")) map.vector("size", cloth.size, kPositive);
  if (const YamlNode* cells = map.required("cells", "along x and y: [24, 14]");
      cells && reader.isList(*cells, inside(name, "cells"), 2))
    for (int k = 0; k < 2; ++k)
      if (const auto count =
              reader.whole(*cells->items[k], inside(name, "cells." + std::to_string(k)), 1, kMostCells))
        cloth.cells[k] = static_cast<int>(*count);
  map.number("mass", cloth.mass, kPositive);
  map.number("stiffness", cloth.stiffness, kPositive);
  cloth.shear = cloth.stiffness / 2;
  cloth.bend = cloth.stiffness / 20;
  map.number("shear", cloth.shear, kNotNegative);
  map.number("bend", cloth.bend, kNotNegative);
  const Vec2 cell{cloth.size.x / cloth.cells[0], cloth.size.y / cloth.cells[1]};
  // A fourteenth of what would stop two neighbours from swinging at all.
  const double particle = cloth.mass / (cloth.columns() * cloth.rows());
  cloth.damping = 0.1 * std::sqrt(cloth.stiffness * particle);
  cloth.radius = std::min(cell.x, cell.y) / 2;
  map.number("damping", cloth.damping, kNotNegative);
  map.number("radius", cloth.radius, kPositive);
  map.number("bounce", cloth.bounce, kShare);
  map.number("friction", cloth.friction, kNotNegative);
  map.number("linear_damping", cloth.linearDamping, kNotNegative);
  map.number("gravity_scale", cloth.gravityScale);
  map.number("tear", cloth.tear, kPositive);
  map.color("color", cloth.color);
  readGroups(map, cloth.ignore);
  if (const YamlNode* pinned = map.find("pinned")) readPinned(reader, *pinned, inside(name, "pinned"), cloth);
  map.finish();
  const std::string called = cloth.name;
  addNamed(spec, std::move(cloth));
  if (reader.errors() > faults) spec.names.markWrong(called);
}

}  // namespace

void readCloths(MapReader& scene, SceneSpec& spec) {
  const YamlNode* node = scene.find("cloth");
  if (!node || !scene.reader().isList(*node, "cloth")) return;
  for (std::size_t k = 0; k < node->items.size(); ++k)
    readCloth(scene.reader(), *node->items[k], "cloth." + std::to_string(k), spec);
}

}  // namespace smokebox
