// Builds the levels of the multigrid: copies the open shares to the finest one, and coarsens.
//
// A coarse block covers 2x2 blocks (one row or column less at the end of an odd size). Its unknowns are the
// connected parts of what it covers (Dick, Rogowsky and Westermann 2016); a coarse link is the sum of the
// fine links between two parts, times the ratio of the distances between the centres (a half, but for the
// last column or row and open sides).
#pragma once
#include <array>
#include <vector>

#include "fluid/boundary.h"
#include "fluid/multigrid_level.h"

namespace smokebox::multigrid {

/// Offset into the coarse x of the unknown that the fine unknown at offset `at` belongs to.
int parentOf(const Level& fine, const Level& coarse, int at);

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
    int upper;    // 1: in the upper row of fine blocks
    int root;
  };
  struct Raw {  // a link that touches an extra unknown
    int a, b;   // offsets into x; b may be a ghost
    float weight;
    Towards towards;  // from a to b
    bool ghost;
  };

  void findParts(Level& fine, Level& coarse);
  static unsigned suspects(const Level& fine, const Level& coarse, int C, int J);
  void splitBlock(Level& fine, Level& coarse, int I, int J);
  static void fillRegular(Level& coarse, int C, int J);
  void linkWhole(const Level& fine, Level& coarse, int C, int J);
  void linkGrid(const Level& fine, Level& coarse);
  void linkLists(const Level& fine, Level& coarse);
  void linkLeft(const Level& fine, Level& coarse, int I, int J);
  void linkBelow(const Level& fine, Level& coarse, int I, int J);
  void chooseColours(Level& level);
  void listSpecials(Level& level);
  void classify(Level& level);
  int findRoot(int member);

  std::vector<Member> members_;
  std::vector<int> order_, sizes_, labels_;
  std::array<std::vector<Level::Prolong>, 2> prolong_;  // of the lower and the upper row
  std::vector<Raw> raw_;
  std::vector<float> factorX_;
  std::vector<int> slot_;  // by offset into x; -1 between uses
  std::vector<int> specials_, counts_;
  std::vector<Level::Entry> entries_;
  std::vector<int> used_;
  std::vector<std::uint16_t>
      splitBlocks_;  // by chunk of the coarse level: bits of the blocks with extra unknowns
  std::vector<std::uint8_t> regularChunk_;  // by chunk of the coarse level: covers regular chunks only
  std::vector<std::uint16_t> disturbed_;    // by chunk: cells beside a solid
};

}  // namespace smokebox::multigrid
