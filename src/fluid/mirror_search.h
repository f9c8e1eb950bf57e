// Searches from a cell, nearest cells first, that go from the cell's mirror images at once: a step of each,
// then the next, so that what the searches do to the cells that they find leaves mirror images such.
//
// An image is counted 0 (the cell itself), 1 left to right, 2 up to down, 3 both, about the middle of the
// grid; its search looks at the faces of a cell in the mirrored order. On an axis two images are one cell,
// from which both searches go, each to its own side. Where several are at one cell at once, that is for the
// caller to share out.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "fluid/smoke_cells.h"

namespace smokebox {

using Images = std::array<int, 4>;  // cells

/// A cell and its images.
inline Images imagesOf(const SmokeCells& cells, int cell) {
  const int i = cells.i(cell), j = cells.j(cell), x = cells.nx - 1 - i, y = cells.ny - 1 - j;
  return {cell, cells.cell(x, j), cells.cell(i, y), cells.cell(x, y)};
}

/// The face that an image has where the cell has `face`.
constexpr int imageOfFace(int face, int image) { return face ^ (face < 2 ? image & 1 : image >> 1); }

/// How many of the images `which` (bits) are the same cell as image g.
inline int sharing(const Images& cells, unsigned which, int g) {
  int count = 0;
  for (int k = 0; k < 4; ++k) count += (which >> k & 1) && cells[k] == cells[g];
  return count;
}

class MirrorSearch {
 public:
  /// From the images `which` (bits) of a cell; each ends once it has found about `most`. Through faces that
  /// are open, or through all where `openX` is null.
  void start(const SmokeCells& cells, const Images& from, unsigned which, const Field* openX,
             const Field* openY, int most);
  /// The next cell of each search; the bits of those that found one. 0: all have ended.
  unsigned next(Images& found);
  void stop(int image) { going_ &= ~(1u << image); }

  /// The face through which image g's search left the cell before for this one, which it has found.
  int cameThrough(int image, int cell) const { return walks_[cell] >> (4 + 2 * image) & 3; }
  /// The cell before it.
  int cellBefore(const SmokeCells& cells, int image, int cell) const {
    return cells.neighbour(cell, cameThrough(image, cell) ^ 1);
  }
  /// The cells that image g's search has found, and where it started, in order.
  const std::vector<int>& queue(int image) const { return walkers_[image].queue; }
  std::size_t bytes() const;

 private:
  struct Walker {
    std::vector<int> queue;
    std::size_t head = 0;
    int side = 0;  // how many faces of the cell at the head are done
  };
  bool advance(int image);
  bool reach(int image, int cell, int face);

  const SmokeCells* cells_ = nullptr;
  const Field *openX_ = nullptr, *openY_ = nullptr;
  std::array<Walker, 4> walkers_;
  unsigned going_ = 0;
  std::size_t most_ = 0;
  int search_ = 0;
  std::vector<int> seen_;             // by cell: the last search that was here
  std::vector<std::uint16_t> walks_;  // by cell: bits of its images; two for each: the face it came through
};

/// Takes the cells of a list with their images, each cell once.
class MirrorOrbits {
 public:
  /// body(images, which) for those cells of `list` for which wants(cell) is true when it is their turn;
  /// `which` are the bits of the images for which it is.
  template <class Wants, class Body>
  void each(const SmokeCells& cells, const std::vector<int>& list, Wants&& wants, Body&& body) {
    done_.resize(cells.count(), 0);
    ++pass_;
    for (std::size_t k = 0; k < list.size(); ++k) {
      const int c = list[k];
      if (done_[c] == pass_ || !wants(c)) continue;
      const Images images = imagesOf(cells, c);
      unsigned which = 0;
      for (int g = 0; g < 4; ++g)
        which |= static_cast<unsigned>(done_[images[g]] != pass_ && wants(images[g])) << g;
      for (int g = 0; g < 4; ++g)
        if (which >> g & 1) done_[images[g]] = pass_;
      body(images, which);
    }
  }
  std::size_t bytes() const { return done_.capacity() * sizeof(int); }

 private:
  std::vector<int> done_;
  int pass_ = 0;
};

}  // namespace smokebox
