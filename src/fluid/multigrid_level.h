// One level of the multigrid: a graph of cells whose regular part is a grid.
//
// Every block of the level's grid has one *primary* unknown. Where solids cut a block into several parts, the
// other parts are *extra* unknowns, stored behind the grid in the same arrays. Links between primary unknowns
// of neighbouring blocks are kept in ax (left face) and ay (lower face); links that touch an extra unknown
// are kept in lists. Unknowns that have such a link are *special*: the sweeps over rows skip them (their
// inverse diagonal is 0) and they are done one by one. Parts of one block are never linked, so red-black
// colouring by block holds for the extra unknowns too.
//
// Rows are cut into chunks of 16 cells. Beyond an open side lies a ghost with the value 0; periodic sides
// keep copies.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

#include "base/lanes.h"

namespace smokebox::multigrid {

template <class T>
struct AlignedAllocator {
  using value_type = T;
  AlignedAllocator() = default;
  template <class U>
  explicit AlignedAllocator(const AlignedAllocator<U>&) {}
  T* allocate(std::size_t n) {
    void* memory = std::aligned_alloc(64, (n * sizeof(T) + 63) / 64 * 64);
    if (!memory) throw std::bad_alloc();
    return static_cast<T*>(memory);
  }
  void deallocate(T* p, std::size_t) { std::free(p); }
  bool operator==(const AlignedAllocator&) const { return true; }
};

using Floats = std::vector<float, AlignedAllocator<float>>;

/// What a chunk of kLanes cells needs. Bits.
enum Chunk : std::uint8_t {
  kGeneral = 0,
  kRegular = 1,  // all links of all 16 cells are exactly 1
  kEmpty = 2,    // no cell has a link
  kBand = 4,     // within two cells of a solid: swept more often
  // At an end of a row: all links are exactly 1 but that over the side, where the value is 0.
  kLeftSide = 8,
  kRightSide = 16,
};

/// From which of its four sides a link leaves a block.
enum class Towards : std::uint8_t { left, right, down, up };

/// How the blocks along one direction are joined to those of the next coarser level: two by two, and around
/// the middle of an odd number, one by itself or three, so that an odd number of blocks lies about the same
/// middle again, down to one. What is mirrored about the middle so stays mirrored.
struct Joining {
  static constexpr int kNone = 1 << 30;
  int middle = kNone;  // the coarse block that has one or three
  int from = kNone;    // the fine blocks that the shift is for
  int shift = 0;       // of the blocks beyond: -1 after one, +1 after three

  Joining() = default;
  explicit Joining(int blocks) {
    if (blocks % 2 == 0) return;
    shift = blocks % 4 == 1 ? -1 : 1;
    middle = (blocks - 1) / 4;
    from = 2 * middle + (shift < 0 ? 1 : 2);
  }
  static int joined(int blocks) { return Joining(blocks).coarse(blocks); }

  /// The coarse block that a fine one belongs to.
  int coarse(int i) const { return (i - (i >= from ? shift : 0)) / 2; }
  /// The first fine block of a coarse one, or past the last.
  int begin(int I) const { return 2 * I + (I > middle ? shift : 0); }
};

struct Level {
  // ---- shape
  int nx = 0, ny = 0;
  bool periodicX = false, periodicY = false;
  int chunks = 0;        // in a row
  Joining joinX, joinY;  // to the next coarser level
  // The colours are mirrored about the middle of an even number of columns and about that of an even number
  // of rows (of an odd number they are so by themselves), so that a mirrored problem has the mirrored
  // solution: from this column on, and from this row on; or from beyond the last. Neighbours in the middle,
  // and across the seam of a periodic level, so have one colour: each pair is solved as one.
  int swapsAt = 0, swapsAtRow = 0;
  double unit = 1;                        // edge of a whole block, in cells of the finest grid
  std::ptrdiff_t stride = 0, origin = 0;  // offset of block (i, j): origin + j stride + i
  std::ptrdiff_t extrasBegin = 0;         // offset of the first extra unknown
  int extras = 0;
  std::vector<double> widthX, widthY;        // of each column and row, in cells of the finest grid
  std::vector<double> distanceX, distanceY;  // between the centres beside face 0..n, in the same unit
  // What the links are without solids: on an x-face, high[j] nearX[i]; on a y-face, wide[i] nearY[j]. Padded
  // with 0.
  std::vector<float> wide, high, nearX, nearY;
  std::vector<float> slackX;  // how far an x-face may be off: anything at the sides

  // ---- unknowns and links
  Floats x, b;        // value and right-hand side: grid, then extra unknowns
  Floats ax, ay, id;  // links and inverse diagonal (0: no unknown there, or a special one): grid
  std::vector<std::uint8_t> chunk;  // ny x chunks
  // Chunks side by side, of one kind, with the colours in the same lanes of each.
  struct Run {
    int begin, end;     // cells, multiples of 16
    std::uint8_t kind;  // kGeneral, kRegular, or the side beside it
  };
  std::vector<int> runBegin, bandBegin;  // ny + 1
  std::vector<Run> runs;                 // without the empty ones
  std::vector<Run> bandRuns;             // those of the band, all as general ones
  // Of rows: bits. Nothing but regular chunks between two sides, no special unknown (and neither in the
  // middle rows nor in those of a seam); no band in it, nor in the other one of the two that go together;
  // empty chunks.
  static constexpr std::uint8_t kPlain = 1, kNoBand = 2, kGaps = 4;
  std::vector<std::uint8_t> rowKind;
  struct SideCell {  // at the end of a row: the link over the side, and the inverse diagonal
    float link = 0, inverse = 0;
  };
  // [2 j] at the left side, [2 j + 1] at the right one: beside each other, where the columns of ax and id
  // would be fetched from afar.
  std::vector<SideCell> sideCells;
  // Chunks are no mirror images of each other unless they are all full: else the cells of the band in each, a
  // bit for each cell, so that those are. ny x chunks, or empty: all cells of its chunks.
  std::vector<std::uint16_t> bandCells;
  // Cells whose links are all 1 are done as in regular chunks wherever they are: their mirror images may be
  // in such a chunk, or special ones.
  bool tellsWhole = false;

  std::vector<int>
      extraBase;  // per block (offset without margins): first extra unknown in it, -1 if it is whole
  std::vector<int> extraCell;  // per extra unknown: its block, j nx + i

  // ---- special unknowns, by row, then colour
  std::vector<int> specialBegin;  // 2 ny + 1: [2 j + colour]
  std::vector<int> specialAt;     // offset into x
  std::vector<int> specialCell;   // j nx + i
  std::vector<float> specialInverse, specialValue;
  std::vector<float>
      specialShare;  // of a change that is made: less than 1 if one of the same colour is linked
  struct Star {  // its links, if there are no more than two to each side: to itself and 0 where there is none
    int to[8];
    float weight[8];
  };
  std::vector<Star> star;
  static constexpr std::uint8_t kNoStar = 0, kStar = 1, kWholeStar = 2;  // all four links are exactly 1
  std::vector<std::uint8_t> starred;
  std::vector<int> entryBegin;  // per special unknown, + 1
  struct Entry {
    int to;  // offset into x
    float weight;
    Towards towards;
    bool listed;  // false: also kept in ax or ay
  };
  std::vector<Entry> entries;

  // Two of one colour, in the middle, that are linked to each other and to no other one of that colour:
  // solved as one.
  struct SpecialPair {
    int a, b;  // special unknowns
    float overA, overB;
  };
  std::vector<SpecialPair> specialPairs;
  std::vector<int> specialPairBegin;  // 2 ny + 1: by the row and colour of the first of each

  // ---- to the next coarser level
  std::vector<std::uint16_t>
      part;  // per block and extra unknown: which part of its coarse block; valid in split ones
  std::vector<int> prolongBegin;  // ny + 1: unknowns of a row that do not belong to the primary part
  struct Prolong {
    int at, parent;  // offsets into x of this level and of the coarser one
    float value;     // scratch
  };
  std::vector<Prolong> prolong;
  std::vector<int> splitBegin;  // coarse rows + 1: coarse unknowns whose children are listed
  struct Split {
    int at;  // offset into the coarse level's b
    int childBegin, childEnd;
  };
  std::vector<Split> split;
  std::vector<int> child;  // 4 i + row within the block of a primary unknown, ~k of the extra unknown k

  // Two cells of a row, of one colour and linked, are solved as one: the link over each one's diagonal, and
  // what follows from them.
  struct Pair {
    float overA = 0, overB = 0;
    float scale = 0;  // 1 / (1 - overA overB); 0: not linked, or not swept over rows; -1: half way
  };
  std::vector<Pair> middlePairs, seamPairs;  // by row

  std::vector<float> middle;  // scratch: what two rows of one colour held before a sweep

  // ---- residual: whole rows; as many as a coarse row has are enough where the sweeps are fused
  Floats residual;
  std::vector<float> residualExtra;
  std::ptrdiff_t residualStride = 0;
  int residualRows = 0;

  std::ptrdiff_t at(int i, int j) const { return origin + j * stride + i; }
  float* row(Floats& f, int j) const { return f.data() + at(0, j); }
  const float* row(const Floats& f, int j) const { return f.data() + at(0, j); }
  float* residualRow(int j) { return residual.data() + kLanes + (j % residualRows) * residualStride; }
  const std::uint8_t* chunkRow(int j) const { return chunk.data() + static_cast<std::size_t>(j) * chunks; }
  std::uint8_t* chunkRow(int j) { return chunk.data() + static_cast<std::size_t>(j) * chunks; }

  /// Larger than a cache: rows are asked for ahead.
  bool large() const { return static_cast<long>(nx) * ny > (1 << 18); }

  /// Sets the copies beyond the left and right side: the neighbour across a periodic side, else 0.
  void wrapRow(float* values) const {
    values[-1] = periodicX ? values[nx - 1] : 0.0f;
    values[nx] = periodicX ? values[0] : 0.0f;
  }
  /// The rows beyond bottom and top, if those are periodic.
  void wrapRows(Floats& f) const;

  int colourOf(int i, int j) const { return (i + colourOfRow(j) + (i >= swapsAt ? 1 : 0)) & 1; }
  /// Of the first cell in it.
  int colourOfRow(int j) const { return (j + (j >= swapsAtRow ? 1 : 0)) & 1; }
  /// The two rows in the middle of mirrored colours: cells above each other have one colour there.
  bool inMiddleRows(int j) const { return j == swapsAtRow || j == swapsAtRow - 1; }
  bool hasMiddleRows() const { return swapsAtRow < ny; }
  /// The first and the last row, or column, of a periodic level: neighbours of one colour.
  bool hasSeamRows() const { return periodicY && ny > 2; }
  bool inSeamRows(int j) const { return hasSeamRows() && (j == 0 || j == ny - 1); }
  bool hasSeamColumns() const { return periodicX && nx > 2; }
  /// Is the cell swept with the band along solids?
  bool inBand(int i, int j) const {
    if (!bandCells.empty())
      return (bandCells[static_cast<std::size_t>(j) * chunks + i / kLanes] >> (i % kLanes)) & 1;
    return chunkRow(j)[i / kLanes] & kBand;
  }

  /// Sizes everything that depends on the grid alone. `wholeResidual`: keep all its rows.
  void shape(int nx, int ny, bool periodicX, bool periodicY, bool wholeResidual);
  std::size_t bytes() const;
};

}  // namespace smokebox::multigrid
