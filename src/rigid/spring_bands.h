// The springs of a sheet in memory. Nodes are numbered row by row, so nearly all springs of a cloth join node
// k to node k + d with one of a few d: those of one d are a band, at slots in the order of their first node,
// with holes where there is no spring. A band needs no list of ends, and runs over memory in lanes of four.
// What fits no band (a cloth sewn to another) is a loose spring, with a list of ends.
//
// Sums over nodes run in the same order on any machine, and the two ends of a spring get the same force to
// the last bit.
#pragma once
#include <array>
#include <vector>

#include "base/threads.h"

namespace smokebox {

/// x and y of every node, apart, with zeros before the first node and after the last one.
template <class Number>
class NodeField {
 public:
  void assign(int before, int nodes) {
    before_ = before, size_ = nodes + 2 * before;
    numbers_.assign(2 * static_cast<std::size_t>(size_), 0);
  }
  Number* x() { return numbers_.data() + before_; }
  Number* y() { return x() + size_; }
  const Number* x() const { return numbers_.data() + before_; }
  const Number* y() const { return x() + size_; }

 private:
  std::vector<Number> numbers_;
  int before_ = 0, size_ = 0;
};

/// Of each spring: the symmetric matrix that gives its impulse on the second node from (vb - va), by the unit
/// of mass. How hard a spring is within a sub-step need not be known to more digits: at rest it does nothing.
struct SpringMatrices {
  std::vector<float> xx, xy, yy;
  void assign(int slots) {
    for (std::vector<float>* each : {&xx, &xy, &yy}) each->assign(slots, 0);
  }
};

class SpringBands {
 public:
  struct Band {
    int offset;       // second node less the first
    int first, last;  // nodes that are first ones: from `first` to before `last`, multiples of kLanes
    int slot;         // of the spring at node 0; there is a slot to every node from -offset on
  };

  /// `ends`: nodes of each spring, the first one lower.
  void layOut(int nodes, const std::vector<std::array<int, 2>>& ends);
  int slotOf(int spring) const { return slotOf_[spring]; }
  int slots() const { return slots_; }
  /// Of nodes, rounded up to lanes: fields are zero from the last node on.
  int nodes() const { return nodes_; }
  template <class Number>
  void makeField(NodeField<Number>& field) const {
    field.assign(before_, nodes_);
  }

  const std::vector<Band>& bands() const { return bands_; }
  int firstLoose() const { return firstLoose_; }
  const std::vector<std::array<int, 2>>& looseEnds() const { return looseEnds_; }

  /// How far the second node of a spring in a band may be from its first one, at most.
  int reach() const { return before_; }
  /// Nodes that a thread does at once: the same parts for any number of threads.
  int grain() const { return grain_; }

  /// out = J^T matrices J p, and mass p where there are masses; returns p . out.
  double multiply(const SpringMatrices& m, const double* mass, const NodeField<double>& p,
                  NodeField<double>& out, ThreadPool& pool) const;
  double multiply(const SpringMatrices& m, const float* mass, const NodeField<float>& p,
                  NodeField<float>& out, ThreadPool& pool) const;

  std::size_t bytes() const;

 private:
  template <class Number>
  double multiplyAs(const SpringMatrices& m, const Number* mass, const NodeField<Number>& p,
                    NodeField<Number>& out, ThreadPool& pool) const;
  template <class Number>
  double multiplyBands(const SpringMatrices& m, const Number* mass, const NodeField<Number>& p,
                       NodeField<Number>& out, int first, int last) const;

  std::vector<Band> bands_;
  std::vector<int> slotOf_;
  std::vector<std::array<int, 2>> looseEnds_;
  int nodes_ = 0, before_ = 0, slots_ = 0, firstLoose_ = 0, grain_ = 1;
};

}  // namespace smokebox
