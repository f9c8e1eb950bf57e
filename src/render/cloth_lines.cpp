#include "render/cloth_lines.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace smokebox {

namespace {
/// The cells of a cloth by column and row; outside of it there is none.
class Cells {
 public:
  explicit Cells(const ClothPicture& cloth)
      : cloth_(cloth), across(std::max(cloth.columns - 1, 0)), up(std::max(cloth.rows - 1, 0)) {}
  bool whole(int i, int j) const {
    return i >= 0 && j >= 0 && i < across && j < up && cloth_.whole[static_cast<std::size_t>(j) * across + i];
  }
  int node(int i, int j) const { return j * cloth_.columns + i; }
  Vec2 at(int i, int j) const { return cloth_.positions[node(i, j)]; }

 private:
  const ClothPicture& cloth_;

 public:
  const int across, up;
};
}  // namespace

std::vector<std::vector<int>> hemOf(const ClothPicture& cloth) {
  const Cells cells(cloth);
  // Where the rim goes on from a node: to at most two others, where two cells touch at a corner only.
  std::vector<std::array<int, 2>> next(cloth.positions.size(), {-1, -1});
  const auto edge = [&](int from, int to) { next[from][next[from][0] < 0 ? 0 : 1] = to; };
  for (int j = 0; j < cells.up; ++j)
    for (int i = 0; i < cells.across; ++i) {
      if (!cells.whole(i, j)) continue;
      if (!cells.whole(i, j - 1)) edge(cells.node(i, j), cells.node(i + 1, j));
      if (!cells.whole(i + 1, j)) edge(cells.node(i + 1, j), cells.node(i + 1, j + 1));
      if (!cells.whole(i, j + 1)) edge(cells.node(i + 1, j + 1), cells.node(i, j + 1));
      if (!cells.whole(i - 1, j)) edge(cells.node(i, j + 1), cells.node(i, j));
    }
  // As many edges come to a node as go from it, so each walk ends where it began.
  std::vector<std::vector<int>> loops;
  const auto take = [&](int from) {
    const int slot = next[from][1] >= 0 ? 1 : 0, to = next[from][slot];
    next[from][slot] = -1;
    return to;
  };
  for (int start = 0; start < static_cast<int>(next.size()); ++start)
    while (next[start][0] >= 0) {
      std::vector<int>& loop = loops.emplace_back();
      for (int node = start; node >= 0 && (loop.empty() || node != start); node = take(node))
        loop.push_back(node);
    }
  return loops;
}

std::vector<std::vector<int>> weaveOf(const ClothPicture& cloth, int every) {
  const Cells cells(cloth);
  std::vector<std::vector<int>> lines;
  std::vector<int> line;
  const auto step = [&](bool there, int from, int to) {
    if (there) {
      if (line.empty()) line.push_back(from);
      line.push_back(to);
    } else if (!line.empty()) {
      lines.push_back(std::move(line));
      line.clear();
    }
  };
  for (int j = every; j < cells.up; j += every) {
    for (int i = 0; i < cells.across; ++i)
      step(cells.whole(i, j - 1) && cells.whole(i, j), cells.node(i, j), cells.node(i + 1, j));
    step(false, 0, 0);
  }
  for (int i = every; i < cells.across; i += every) {
    for (int j = 0; j < cells.up; ++j)
      step(cells.whole(i - 1, j) && cells.whole(i, j), cells.node(i, j), cells.node(i, j + 1));
    step(false, 0, 0);
  }
  return lines;
}

std::vector<float> shadingOf(const ClothPicture& cloth) {
  const Cells cells(cloth);
  struct Cell {
    int i, j;
    Vec2 weft, warp;
    double area;
  };
  std::vector<Cell> all;
  std::vector<double> areas;
  for (int j = 0; j < cells.up; ++j)
    for (int i = 0; i < cells.across; ++i) {
      if (!cells.whole(i, j)) continue;
      const Vec2 a = cells.at(i, j), b = cells.at(i + 1, j), c = cells.at(i + 1, j + 1),
                 d = cells.at(i, j + 1);
      const Vec2 weft = 0.5 * (b - a + c - d), warp = 0.5 * (d - a + c - b);
      all.push_back({i, j, weft, warp, cross(weft, warp)});
      areas.push_back(std::abs(all.back().area));
    }
  std::vector<float> shade(cloth.positions.size(), 0.0f), weights(cloth.positions.size(), 0.0f);
  if (all.empty()) return shade;
  // Half of the cells are smaller than what counts as not stretched.
  const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  const double usual = *middle;
  constexpr double kStretch = 0.45, kShear = 0.55, kTurn = 0.35, kBack = 0.55;
  for (const Cell& cell : all) {
    const double width = length(cell.weft), height = length(cell.warp);
    if (!(width > 0) || !(height > 0) || !(usual > 0)) continue;
    double light = kStretch * std::clamp(std::abs(cell.area) / usual - 1, -1.0, 1.0);
    light += kShear * dot(cell.weft, cell.warp) / (width * height);
    light += kTurn * (cell.weft.y / width + cell.warp.x / height) * 0.5;
    if (cell.area < 0) light -= kBack;
    for (const int node : {cells.node(cell.i, cell.j), cells.node(cell.i + 1, cell.j),
                           cells.node(cell.i, cell.j + 1), cells.node(cell.i + 1, cell.j + 1)}) {
      shade[node] += static_cast<float>(std::clamp(light, -1.0, 1.0));
      weights[node] += 1;
    }
  }
  for (std::size_t k = 0; k < shade.size(); ++k)
    if (weights[k] > 0) shade[k] /= weights[k];
  return shade;
}

std::vector<int> looseNodes(const ClothPicture& cloth) {
  const Cells cells(cloth);
  std::vector<int> loose;
  for (int j = 0; j < cloth.rows; ++j)
    for (int i = 0; i < cloth.columns; ++i)
      if (!cells.whole(i - 1, j - 1) && !cells.whole(i, j - 1) && !cells.whole(i - 1, j) &&
          !cells.whole(i, j))
        loose.push_back(cells.node(i, j));
  return loose;
}

}  // namespace smokebox
