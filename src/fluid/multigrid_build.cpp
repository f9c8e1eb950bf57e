#include "fluid/multigrid_build.h"

#include <algorithm>
#include <cmath>

#include "fluid/multigrid_parents.h"

namespace smokebox::multigrid {

namespace {

Towards opposite(Towards t) { return static_cast<Towards>(static_cast<int>(t) ^ 1); }

void clear(Level& level) {
  std::fill(level.x.begin(), level.x.end(), 0.0f);
  std::fill(level.b.begin(), level.b.end(), 0.0f);
}

}  // namespace

void Builder::finest(const Boundary& boundary, Level& level) {
  clear(level);
  const int nx = level.nx, ny = level.ny;
  for (int j = 0; j <= ny; ++j) {
    float* ay = level.row(level.ay, j);
    std::copy_n(boundary.openY.row(level.periodicY && j == ny ? 0 : j), nx, ay);
    if (j == ny) break;
    float* ax = level.row(level.ax, j);
    std::copy_n(boundary.openX.row(j), nx + 1, ax);
    if (level.periodicX) ax[nx] = ax[0];
  }
  raw_.clear();
  chooseColours(level);
  listSpecials(level);
  classify(level);
}

void Builder::coarsen(Level& fine, Level& coarse) {
  clear(coarse);
  findParts(fine, coarse);
  linkGrid(fine, coarse);
  linkLists(fine, coarse);
  chooseColours(coarse);
  listSpecials(coarse);
  classify(coarse);
}

// In the middle of mirrored colours two columns, or two rows, have one colour; a sweep solves each such pair
// as one.
void Builder::chooseColours(Level& level) {
  const bool mirrorX = level.nx % 2 == 0, mirrorY = level.ny % 2 == 0;
  level.tellsWhole = !level.bandCells.empty() || level.extras > 0;
  level.swapsAt = mirrorX ? level.nx / 2 : level.chunks * kLanes + kLanes;
  level.swapsAtRow = mirrorY ? level.ny / 2 : level.ny + 1;
}

// Sorts the special unknowns by row and colour, and gathers their links; parallel links become one.
void Builder::listSpecials(Level& level) {
  if (slot_.size() < level.x.size()) slot_.resize(level.x.size(), -1);
  specials_.clear();
  const auto mark = [&](int at) {
    if (slot_[at] >= 0) return;
    slot_[at] = 0;
    specials_.push_back(at);
  };
  for (int k = 0; k < level.extras; ++k) mark(static_cast<int>(level.extrasBegin) + k);
  for (const Raw& link : raw_) {
    mark(link.a);
    if (!link.ghost) mark(link.b);
  }
  // In the middle rows and columns, special ones are solved in pairs by themselves: so are then those beside
  // extra unknowns that have no link to them, but whose mirror images may, and those that make a pair with
  // one.
  const auto markMiddle = [&](int i, int j) {
    if (i < 0 || i >= level.nx || j < 0 || j >= level.ny) return;
    if (!level.inMiddleRows(j) && i != level.swapsAt && i != level.swapsAt - 1) return;
    const std::ptrdiff_t at = level.at(i, j);
    const int right = level.swapsAt, upper = level.swapsAtRow;
    if ((i == right && level.ax[at] > 0) || (i == right - 1 && level.ax[at + 1] > 0))
      mark(static_cast<int>(i == right ? at - 1 : at + 1));
    if ((j == upper && level.ay[at] > 0) || (j == upper - 1 && level.ay[at + level.stride] > 0))
      mark(static_cast<int>(j == upper ? at - level.stride : at + level.stride));
    if (level.ax[at] > 0 || level.ax[at + 1] > 0 || level.ay[at] > 0 || level.ay[at + level.stride] > 0)
      mark(static_cast<int>(at));
  };
  for (int cell : level.extraCell) {
    const int i = cell % level.nx, j = cell / level.nx;
    markMiddle(i, j);
    markMiddle(i - 1, j);
    markMiddle(i + 1, j);
    markMiddle(i, j - 1);
    markMiddle(i, j + 1);
  }
  const int count = static_cast<int>(specials_.size());
  level.specialAt.resize(count);
  level.specialCell.resize(count);
  level.specialInverse.assign(count, 0);
  level.specialShare.assign(count, 1);
  level.star.resize(count);
  level.starred.resize(count);
  same_.resize(count);
  level.specialValue.assign(count, 0);
  level.specialBegin.assign(2 * level.ny + 1, 0);
  const auto key = [&](int at) {
    const Cell c = cellOf(level, at);
    return 2 * c.j + level.colourOf(c.i, c.j);
  };
  for (int at : specials_) ++level.specialBegin[key(at) + 1];
  for (int k = 0; k < 2 * level.ny; ++k) level.specialBegin[k + 1] += level.specialBegin[k];
  counts_.assign(level.specialBegin.begin(), level.specialBegin.end());
  for (int at : specials_) {
    const int s = counts_[key(at)]++;
    const Cell c = cellOf(level, at);
    slot_[at] = s;
    level.specialAt[s] = at;
    level.specialCell[s] = c.j * level.nx + c.i;
  }

  // Room for every link, then without the gaps.
  counts_.assign(count + 1, 0);
  for (const Raw& link : raw_) {
    ++counts_[slot_[link.a] + 1];
    if (!link.ghost) ++counts_[slot_[link.b] + 1];
  }
  for (int s = 0; s < count; ++s) counts_[s + 1] += counts_[s];
  entries_.resize(counts_[count]);
  used_.assign(count, 0);
  const auto insert = [&](int s, int to, const Raw& link, Towards towards) {
    Gathered* begin = entries_.data() + counts_[s];
    for (int k = 0; k < used_[s]; ++k)
      if (begin[k].to == to && begin[k].towards == towards) {
        begin[k].weight += link.weight;
        return;
      }
    begin[used_[s]++] = {to, towards, link.weight, link.factor};
  };
  for (const Raw& link : raw_) {
    insert(slot_[link.a], link.b, link, link.towards);
    if (!link.ghost) insert(slot_[link.b], link.a, link, opposite(link.towards));
  }
  level.entryBegin.resize(count + 1);
  level.entries.clear();
  for (int s = 0; s < count; ++s) {
    level.entryBegin[s] = static_cast<int>(level.entries.size());
    for (int k = counts_[s]; k < counts_[s] + used_[s]; ++k) {
      const Gathered& link = entries_[k];
      level.entries.push_back({link.to, static_cast<float>(link.weight) * link.factor, link.towards, true});
    }
    const int at = level.specialAt[s];
    if (at < level.extrasBegin) {
      const auto fromGrid = [&](std::ptrdiff_t to, float weight, Towards towards) {
        if (weight > 0) level.entries.push_back({static_cast<int>(to), weight, towards, false});
      };
      fromGrid(at - 1, level.ax[at], Towards::left);
      fromGrid(at + 1, level.ax[at + 1], Towards::right);
      fromGrid(at - level.stride, level.ay[at], Towards::down);
      fromGrid(at + level.stride, level.ay[at + level.stride], Towards::up);
    }
    // In the order of the grid's: first along x.
    double side[4] = {}, same = 0;
    Same& alike = same_[s];
    alike = {};
    const Cell own = cellOf(level, at);
    const int colour = level.colourOf(own.i, own.j);
    const bool mayBeSame = level.inMiddleRows(own.j) || own.i == level.swapsAt ||
                           own.i == level.swapsAt - 1 || level.periodicX || level.periodicY;
    for (std::size_t e = level.entryBegin[s]; e < level.entries.size(); ++e) {
      const Level::Entry& entry = level.entries[e];
      side[static_cast<int>(entry.towards)] += static_cast<double>(entry.weight);
      if (!mayBeSame) continue;
      const Cell to = cellOf(level, entry.to);
      if (to.i >= 0 && to.i < level.nx && to.j >= 0 && to.j < level.ny &&
          level.colourOf(to.i, to.j) == colour)
        same += static_cast<double>(entry.weight), alike = {alike.count + 1, entry.to, entry.weight};
    }
    const float diagonal = (static_cast<float>(side[0]) + static_cast<float>(side[1])) +
                           (static_cast<float>(side[2]) + static_cast<float>(side[3]));
    level.specialInverse[s] = diagonal > 0 ? 1 / diagonal : 0;
    // Neighbours of one colour, in the middle or across a seam, see each other's old values: a smaller step
    // is safe then (the smoother of the sum of magnitudes, Baker, Falgout, Kolev and Yang 2011).
    if (same > 0) level.specialShare[s] = static_cast<float>(diagonal / (diagonal + same));
    Level::Star& star = level.star[s];
    std::fill_n(star.to, 8, at);
    std::fill_n(star.weight, 8, 0.0f);
    int links[4] = {};
    for (std::size_t e = level.entryBegin[s]; e < level.entries.size(); ++e) {
      const auto towards = static_cast<int>(level.entries[e].towards);
      const int k = 2 * towards + std::min(links[towards]++, 1);
      star.to[k] = level.entries[e].to;
      star.weight[k] = level.entries[e].weight;
    }
    const bool fits = *std::max_element(links, links + 4) <= 2;
    const bool whole =
        fits && std::count(links, links + 4, 1) == 4 && std::count(star.weight, star.weight + 8, 1.0f) == 4;
    level.starred[s] = whole ? Level::kWholeStar : fits ? Level::kStar : Level::kNoStar;
  }
  level.entryBegin[count] = static_cast<int>(level.entries.size());
  pairSpecials(level);

  labels_.resize(level.extras);
  for (int at : specials_) {
    if (at >= level.extrasBegin) labels_[at - level.extrasBegin] = slot_[at];
    slot_[at] = -1;
  }
}

// Of all special unknowns that are linked to one of their own colour.
void Builder::pairSpecials(Level& level) {
  level.specialPairs.clear();
  for (int group = 0; group < 2 * level.ny; ++group) {
    level.specialPairBegin[group] = static_cast<int>(level.specialPairs.size());
    for (int s = level.specialBegin[group]; s < level.specialBegin[group + 1]; ++s) {
      const int t = same_[s].count == 1 ? slot_[same_[s].to] : -1;
      if (t <= s || same_[t].count != 1 || same_[t].to != level.specialAt[s]) continue;
      level.specialShare[s] = level.specialShare[t] = 1;
      level.specialPairs.push_back(
          {s, t, same_[s].weight * level.specialInverse[s], same_[t].weight * level.specialInverse[t]});
    }
  }
  level.specialPairBegin[2 * level.ny] = static_cast<int>(level.specialPairs.size());
}

std::size_t Builder::bytes() const {
  const auto of = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return of(members_) + of(order_) + of(sizes_) + of(labels_) + of(prolong_[0]) + of(prolong_[1]) + of(raw_) +
         of(slot_) + of(specials_) + of(counts_) + of(entries_) + of(used_) + of(splitBlocks_) +
         of(regularChunk_) + of(disturbed_) + of(late_) + of(same_) + of(prolong_[2]);
}

}  // namespace smokebox::multigrid
