// Keeps the smoke under its ceiling: what a cell holds above the largest value before the step (by a velocity
// that is not quite free of divergence, or volumes that a moving solid changed) goes to the cells beside it
// that have room for it, in rounds: each offers its excess to its neighbours by the room that they have, and
// gets rid of what these can take. Where none has room, it is passed on to them as it is. What finds no room
// within some rounds stays, and the value stays at the ceiling, as long as it is no more than masses may be
// off by rounding (3e-5 of the ceiling); more is handed out, to be kept aside. All amounts are whole quanta
// and all cells of a round act at once: no order matters, so mirror images stay such.
//
// And keeps it above the floor: where more was taken from a cell than it held (a solid that jumps over many
// cells in a step), the nearest cells that can be reached from it give it back; mirror images draw at once.
#pragma once
#include <cstdint>
#include <vector>

#include "fluid/mirror_search.h"
#include "fluid/smoke_cells.h"
#include "fluid/sweep.h"

namespace smokebox {

class MassSpread {
 public:
  /// Mass that found no room, taken out of a cell.
  struct Overflow {
    int cell;
    double mass;
  };
  /// No value is above `highest` afterwards. `volume`: what the cells carry.
  const std::vector<Overflow>& run(const SmokeCells& cells, const Boundary& boundary, const Field& volume,
                                   float highest, Quantum quantum, Field& mass, Field& value,
                                   Activity& active);
  /// Fills cells with less than nothing up to nothing. Returns whether all could be.
  bool fill(const SmokeCells& cells, const Boundary& boundary, const Field& volume, Quantum quantum,
            Field& mass, Field& value, Activity& active);
  std::size_t bytes() const {
    return (lacking_.capacity() + place_.capacity()) * sizeof(int) + full_.capacity() * sizeof(Full) +
           offers_.capacity() * sizeof(Offer) + search_.bytes() + orbits_.bytes();
  }

 private:
  using Quanta = std::int64_t;
  struct Full {  // a cell that has more than it holds, or is offered something
    int cell;
    Quanta excess = 0, room = 0, offered = 0;  // room: at the start of the round
  };
  struct Offer {
    int from, to;  // places in full_
    Quanta amount;
    bool pass;  // whether there is room or not
  };
  int placeOf(int cell);
  template <class Room>
  bool oneRound(const SmokeCells& cells, const Boundary& boundary, Room&& room);

  std::vector<int> lacking_;
  MirrorSearch search_;
  MirrorOrbits orbits_;
  std::vector<int> place_;  // by cell: its place in full_, -1 between runs
  std::vector<Full> full_;
  std::vector<Offer> offers_;
  std::vector<Overflow> overflow_;
};

}  // namespace smokebox
