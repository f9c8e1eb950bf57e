// Builds the levels of the multigrid: copies the open shares to the finest one, and coarsens.
//
// A coarse block covers 2x2 blocks (around the middle of an odd size one row or column, or three: see
// Joining). Its unknowns are the connected parts of what it covers (Dick, Rogowsky and Westermann 2016); a
// coarse link is the sum of the fine links between two parts, times the ratio of the distances between the
// centres (a half, but for the middle of an odd size and open sides).
//
// Mirror images must come out equal to the bit, though one may keep an unknown or a link in the grid that the
// other has in a list (two halves of a block on the axis): links are added up in float64, where the sums are
// as good as exact, and only then scaled and rounded.
#pragma once
#include <array>
#include <vector>

#include "fluid/boundary.h"
#include "fluid/multigrid_level.h"

namespace smokebox::multigrid {

class Builder {
 public:
  /// Links of the finest level. `level` has its shape already.
  void finest(const Boundary& boundary, Level& level);

  /// The unknowns and links of `coarse` from those of `fine`. Both have their shapes already.
  void coarsen(Level& fine, Level& coarse);

  std::size_t bytes() const;

 private:
  struct Member {
    int unknown;  // index into part
    int at;       // offset into x of the fine level
    int child;    // as Level::child
    int row;      // of the fine blocks
    int root;
  };
  struct Raw {  // a link that touches an extra unknown
    int a, b;   // offsets into x; b may be a ghost
    double weight;
    float factor;     // of the weight, once all that run beside each other are added up
    Towards towards;  // from a to b
    bool ghost;
  };
  struct Gathered {  // all of them between two unknowns
    int to;
    Towards towards;
    double weight;
    float factor;
  };
  struct Same {  // links of a special unknown to others of its colour, and the last of them
    int count = 0, to = 0;
    float weight = 0;
  };
  struct Late {  // a link between primary unknowns that the finer level has in its lists
    bool x;
    int I, J;  // the coarse face
    double weight;
  };

  void findParts(Level& fine, Level& coarse);
  static unsigned suspects(const Level& fine, const Level& coarse, int C, int J);
  void splitBlock(Level& fine, Level& coarse, int I, int J);
  void linkWhole(const Level& fine, Level& coarse, int C, int J);
  void linkGrid(const Level& fine, Level& coarse);
  void linkLists(const Level& fine, Level& coarse);
  void linkLeft(const Level& fine, Level& coarse, int I, int J);
  void linkBelow(const Level& fine, Level& coarse, int I, int J);
  template <class Raws>
  static double sumLeft(const Level& fine, const Level& coarse, int I, int J, Raws&& raws);
  template <class Raws>
  static double sumBelow(const Level& fine, const Level& coarse, int I, int J, Raws&& raws);
  void linkLate(const Level& fine, Level& coarse);
  void chooseColours(Level& level);
  void listSpecials(Level& level);
  void pairSpecials(Level& level);
  void classify(Level& level);
  std::uint16_t bandCellsOf(const Level& level, int c) const;
  int findRoot(int member);

  std::vector<Member> members_;
  std::vector<int> order_, sizes_, labels_;
  std::array<std::vector<Level::Prolong>, 3> prolong_;  // by row of the fine blocks
  std::vector<Raw> raw_;
  std::vector<Late> late_;
  std::vector<Same> same_;
  std::vector<float> factorX_;
  std::vector<int> slot_;  // by offset into x; -1 between uses
  std::vector<int> specials_, counts_;
  std::vector<Gathered> entries_;
  std::vector<int> used_;
  std::vector<std::uint16_t>
      splitBlocks_;  // by chunk of the coarse level: bits of the blocks with extra unknowns
  std::vector<std::uint8_t> regularChunk_;  // by chunk of the coarse level: covers regular chunks only
  std::vector<std::uint8_t> halves_;        // by coarse column of chunks: all factors are a half
  std::vector<std::uint16_t> disturbed_;    // by chunk: cells beside a solid
  std::vector<std::uint16_t> near_;         // of one row: what is disturbed there, above or below
};

}  // namespace smokebox::multigrid
