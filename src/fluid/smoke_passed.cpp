#include "fluid/smoke_passed.h"

namespace smokebox {
namespace {
constexpr int kWindow = 2;  // cells to either side in which two sides are told apart

float volumeOf(const SmokeCells& cells, const SmokeGeometry& geometry, int c) {
  return (*geometry.volume)(cells.i(c), cells.j(c));
}

float openOf(const SmokeCells& cells, const SmokeGeometry& geometry, int c, int face) {
  return cells.atFace(*geometry.openX, *geometry.openY, c, face);
}

// Cells by their place in the window around one, of which some are never cut and so keep their side.
struct Window {
  static constexpr int kSize = 2 * kWindow + 1;
  std::uint32_t reached = 0, anchors = 0;

  void fill(const SmokeCells& cells, int from, const SmokeGeometry& through, const SmokeGeometry& before,
            const SmokeGeometry& after) {
    struct Place {
      int cell, x, y;
    };
    Place queue[kSize * kSize] = {{from, kWindow, kWindow}};
    int count = 1;
    reached = bit(kWindow, kWindow);
    for (int head = 0; head < count; ++head) {
      const Place p = queue[head];
      if (volumeOf(cells, before, p.cell) == 1 && volumeOf(cells, after, p.cell) == 1)
        anchors |= bit(p.x, p.y);
      for (int face = 0; face < 4; ++face) {
        const int x = p.x + (face == 1) - (face == 0), y = p.y + (face == 3) - (face == 2);
        if (x < 0 || y < 0 || x >= kSize || y >= kSize || (reached & bit(x, y))) continue;
        const int next = cells.neighbour(p.cell, face);
        if (next < 0 || !(openOf(cells, through, p.cell, face) > 0)) continue;
        reached |= bit(x, y);
        queue[count++] = {next, x, y};
      }
    }
  }
  static std::uint32_t bit(int x, int y) { return 1u << (y * kSize + x); }
};
}  // namespace

bool passedByWall(const SmokeCells& cells, int c, const SmokeGeometry& before, const SmokeGeometry& after) {
  bool was = false, is = false, both = false;
  for (int face = 0; face < 4; ++face) {
    const int next = cells.neighbour(c, face);
    if (next < 0) continue;
    const bool wasOpen = openOf(cells, before, c, face) > 0, isOpen = openOf(cells, after, c, face) > 0;
    if (wasOpen && isOpen && volumeOf(cells, before, next) == 1 && volumeOf(cells, after, next) == 1)
      return false;
    was |= wasOpen;
    is |= isOpen;
    both |= wasOpen && isOpen;
  }
  if (!was) return false;
  if (!is) return true;  // shut in: whichever side it is on when it opens again
  Window old, now;
  old.fill(cells, c, before, before, after);
  now.fill(cells, c, after, before, after);
  return old.anchors && now.anchors ? (old.anchors & now.anchors) == 0 : !both;
}

}  // namespace smokebox
