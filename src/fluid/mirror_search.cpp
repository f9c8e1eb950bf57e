#include "fluid/mirror_search.h"

namespace smokebox {

std::size_t MirrorSearch::bytes() const {
  std::size_t sum = seen_.capacity() * sizeof(int) + walks_.capacity() * sizeof(std::uint16_t);
  for (const Walker& w : walkers_) sum += w.queue.capacity() * sizeof(int);
  return sum;
}

void MirrorSearch::start(const SmokeCells& cells, const Images& from, unsigned which, const Field* openX,
                         const Field* openY, int most) {
  if (seen_.size() != cells.count()) {
    seen_.assign(cells.count(), 0);
    walks_.assign(cells.count(), 0);
  }
  cells_ = &cells;
  openX_ = openX;
  openY_ = openY;
  most_ = static_cast<std::size_t>(most);
  going_ = which;
  ++search_;
  for (int g = 0; g < 4; ++g) {
    walkers_[g].queue.clear();
    walkers_[g].head = 0;
    walkers_[g].side = 0;
    if (which >> g & 1) reach(g, from[g], 0);
  }
}

// Whether the image's search had not been there.
bool MirrorSearch::reach(int g, int cell, int face) {
  if (seen_[cell] != search_) {
    seen_[cell] = search_;
    walks_[cell] = 0;
  }
  if (walks_[cell] >> g & 1) return false;
  walks_[cell] =
      static_cast<std::uint16_t>(walks_[cell] | 1u << g | static_cast<unsigned>(face) << (4 + 2 * g));
  walkers_[g].queue.push_back(cell);
  return true;
}

bool MirrorSearch::advance(int g) {
  Walker& w = walkers_[g];
  for (; w.head < w.queue.size(); ++w.head, w.side = 0) {
    if (w.side == 0 && w.queue.size() > most_) return false;
    const int cell = w.queue[w.head], i = cells_->i(cell), j = cells_->j(cell);
    while (w.side < 4) {
      const int face = imageOfFace(w.side++, g);
      if (openX_ && !(SmokeCells::atFace(*openX_, *openY_, i, j, face) > 0)) continue;
      const int next = cells_->neighbour(i, j, face);
      if (next >= 0 && reach(g, next, face)) return true;
    }
  }
  return false;
}

unsigned MirrorSearch::next(Images& found) {
  unsigned which = 0;
  for (int g = 0; g < 4; ++g) {
    if (!(going_ >> g & 1)) continue;
    if (advance(g)) {
      found[g] = walkers_[g].queue.back();
      which |= 1u << g;
    } else {
      stop(g);
    }
  }
  return which;
}

}  // namespace smokebox
