#include "rigid/block_sweeps.h"

#include <algorithm>

namespace smokebox {

using motion_lanes::gather;
using motion_lanes::kNumbers;
using motion_lanes::scatterAdd;

namespace {
// A block that parted faster than it needs by so many times what the last sweep changed is left out.
constexpr int kSpare = 4;
// Blocks of a colour do not meet: so many are read, solved and written together, and the processor works on
// several at a time.
constexpr int kSome = 4;
// A thread takes so many blocks at a time, where there are this many in a colour.
constexpr int kGrain = 4 * kSome, kShared = 4 * kGrain;
constexpr float kFar = 1e30F;      // m/s
constexpr double kRoughest = 1e6;  // a friction beyond all slip, and finite in float32
}  // namespace

template <class Number>
void BlockSweeps<Number>::clear() {
  blocks_.clear();
  deep_.clear();
  colourEnds_.clear();
}

template <class Number>
void BlockSweeps<Number>::fill(const Bodies& bodies, const std::vector<Contact>& contacts,
                               const ContactLayout& layout, Number relaxation) {
  colourEnds_ = layout.colourEnds();
  relaxation_ = relaxation;
  back_ = true;
  deep_.clear();
  blocks_.resize(layout.blocks());
  const std::vector<int>& inLane = layout.inLane();
  // Contacts of a block lie far apart: those of the next one are asked for ahead.
  const auto askFor = [&](int block) {
    for (int l = 0; l < kLanes; ++l) {
      const int which = inLane[kLanes * block + l];
      if (which < 0) continue;
      const char* contact = reinterpret_cast<const char*>(&contacts[which]);
      for (std::size_t at = 0; at < sizeof(Contact); at += 64) __builtin_prefetch(contact + at);
    }
  };
  const int count = static_cast<int>(blocks_.size());
  pool_.blocks(0, count, kShared, [&](int k, int end) {
    for (; k < end; ++k) {
      if (k + 1 < count) askFor(k + 1);
      fillBlock(blocks_[k], bodies, contacts, inLane.data() + kLanes * k, relaxation);
    }
  });
}

template <class Number>
void BlockSweeps<Number>::fillBlock(Block& block, const Bodies& bodies, const std::vector<Contact>& contacts,
                                    const int* which, Number relaxation) {
  block = Block{};
  for (int l = 0; l < kLanes; ++l) {
    if (which[l] < 0) continue;
    const Contact& c = contacts[which[l]];
    block.a[l] = kNumbers * c.a;
    block.b[l] = kNumbers * c.b;
    block.count = std::max<int>(block.count, c.count);
    const InverseMass &a = bodies.inverse[c.a], &b = bodies.inverse[c.b];
    auto brief = [](double x) { return static_cast<Number>(x); };
    numbers(block.nx)[l] = brief(c.normal.x);
    numbers(block.ny)[l] = brief(c.normal.y);
    numbers(block.friction)[l] = brief(std::min(c.friction, kRoughest));
    numbers(block.inverseA)[l] = brief(a.mass);
    numbers(block.inertiaA)[l] = brief(a.inertia);
    numbers(block.inverseB)[l] = brief(b.mass);
    numbers(block.inertiaB)[l] = brief(b.inertia);
    const Vec2 tangent = perpendicular(c.normal);
    for (int p = 0; p < c.count; ++p) {
      const ContactPoint& from = c.points[p];
      Point& to = block.points[p];
      numbers(to.armAN)[l] = brief(cross(from.armA, c.normal));
      numbers(to.armBN)[l] = brief(cross(from.armB, c.normal));
      numbers(to.armAT)[l] = brief(cross(from.armA, tangent));
      numbers(to.armBT)[l] = brief(cross(from.armB, tangent));
      numbers(to.gap)[l] = brief(from.gap);
      numbers(to.impulseN)[l] = brief(from.impulseN);
      numbers(to.impulseT)[l] = brief(from.impulseT);
      numbers(block.total)[l] -=
          numbers(to.impulseN)[l];  // which the first sweep counts, but belongs to the step before
    }
  }
  for (int p = 0; p < block.count; ++p) {
    Point& to = block.points[p];
    auto mass = [&](Vector armA, Vector armB) {
      const Vector inverse =
          block.inverseA + block.inverseB + block.inertiaA * armA * armA + block.inertiaB * armB * armB;
      return choose(inverse > Vector{}, wide(relaxation) / inverse, Vector{});
    };
    to.massN = mass(to.armAN, to.armBN);
    to.massT = mass(to.armAT, to.armBT);
    for (int l = 0; l < kLanes; ++l)  // a contact of one point beside one of two
      if (which[l] >= 0 && contacts[which[l]].count <= p) numbers(to.massN)[l] = numbers(to.massT)[l] = 0;
  }
  if (block.count < 2) return;
  // Of two points that are hardly two each does half.
  const Point &p = block.points[0], &q = block.points[1];
  constexpr Number kApart = static_cast<Number>(1e-4), kHalf = static_cast<Number>(0.5);
  const Vector shared = block.inverseA + block.inverseB + block.inertiaA * p.armAN * q.armAN +
                        block.inertiaB * p.armBN * q.armBN,
               per = wide(1 / relaxation),
               rest = wide<Number>(1) - shared * p.massN * per * shared * q.massN * per;
  const auto areTwo = rest > wide(kApart);
  block.firstBySecond = choose(areTwo, shared * p.massN * per, Vector{});
  block.secondByFirst = choose(areTwo, shared * q.massN * per, Vector{});
  block.both = choose(areTwo, wide<Number>(1) / rest, wide(kHalf));
}

template <class Number>
void BlockSweeps<Number>::warmStart(Bodies& bodies) const {
  Motion* velocity = bodies.velocity.data();
  for (const Block& block : blocks_) {
    Vector px{}, py{}, turnA{}, turnB{};
    for (int k = 0; k < block.count; ++k) {
      const Point& p = block.points[k];
      // Tangent: the normal turned by 90 degrees counterclockwise.
      px += block.nx * p.impulseN - block.ny * p.impulseT;
      py += block.ny * p.impulseN + block.nx * p.impulseT;
      turnA -= p.armAN * p.impulseN + p.armAT * p.impulseT;
      turnB += p.armBN * p.impulseN + p.armBT * p.impulseT;
    }
    scatterAdd(velocity, block.a, -block.inverseA * px, -block.inverseA * py, block.inertiaA * turnA);
    scatterAdd(velocity, block.b, block.inverseB * px, block.inverseB * py, block.inertiaB * turnB);
  }
}

/// Moves the bodies of a block apart where they overlap, on places alone.
template <class Number>
void BlockSweeps<Number>::separate(const Block& block, const MoveApart& apart, Motion* moved,
                                   Relative<Vector>& d) {
  const Vector cap = wide(static_cast<Number>(apart.most));
  const Vector share = wide(-static_cast<Number>(apart.share)), inverse = block.inverseA + block.inverseB;
  Vector sum{}, turnA{}, turnB{};
  for (int k = 0; k < block.count; ++k) {
    const Point& p = block.points[k];
    const Vector gap = p.gap + block.nx * d.x + block.ny * d.y + d.turnB * p.armBN - d.turnA * p.armAN;
    const Vector overlap = smaller(larger(share * gap, Vector{}), cap) * p.massN;
    const Vector byA = block.inertiaA * p.armAN * overlap, byB = block.inertiaB * p.armBN * overlap;
    sum += overlap;
    turnA -= byA;
    turnB += byB;
    d.x += inverse * block.nx * overlap;
    d.y += inverse * block.ny * overlap;
    d.turnA -= byA;
    d.turnB += byB;
  }
  const Vector px = block.nx * sum, py = block.ny * sum;
  scatterAdd(moved, block.a, -block.inverseA * px, -block.inverseA * py, turnA);
  scatterAdd(moved, block.b, block.inverseB * px, block.inverseB * py, turnB);
}

/// Begins a sub-step: how fast each point may close; and who overlaps is moved apart.
template <class Number>
inline Number BlockSweeps<Number>::begin(Block& block, Motion* moved, Number perSecond,
                                         const MoveApart& apart) {
  Relative<Vector> d;
  gather(moved, block.a, block.b, d);
  const Vector along = block.nx * d.x + block.ny * d.y;
  Vector deepest{};
  for (int k = 0; k < block.count; ++k) {
    Point& p = block.points[k];
    const Vector gap = p.gap + along + d.turnB * p.armBN - d.turnA * p.armAN;
    deepest = smaller(deepest, gap);
    p.allowed = larger(gap, Vector{}) * wide(perSecond);
    block.total += p.impulseN;  // what the last sub-step came to
  }
  const Number overlap = -smallestOf(deepest);
  if (overlap > static_cast<Number>(apart.slop)) separate(block, apart, moved, d);
  return overlap;
}

template <class Number>
bool BlockSweeps<Number>::separateDeep(Bodies& bodies, const MoveApart& apart) {
  const MoveApart own = unrelaxed(apart);
  Motion* moved = bodies.moved.data();
  for (const int k : deep_) {
    Relative<Vector> d;
    gather(moved, blocks_[k].a, blocks_[k].b, d);
    separate(blocks_[k], own, moved, d);
  }
  return !deep_.empty();
}

// Two points at once: what each asks for by itself, less what the other one gives it. Where one lets go, the
// other one is alone (the 2 x 2 linear complementarity problem by its cases, as in Catto's block solver). One
// after the other they would tilt what stands on both, and towers of boxes sway.
template <class Number>
template <int kPoints>
inline void BlockSweeps<Number>::changeNormals(Block& block, const Relative<Vector>& v, Vector parts[kPoints],
                                               Vector change[kPoints]) {
  const Vector along = block.nx * v.x + block.ny * v.y;
  Vector asked[kPoints];
  for (int k = 0; k < kPoints; ++k) {
    const Point& p = block.points[k];
    parts[k] = along + (v.turnB * p.armBN - v.turnA * p.armAN) + p.allowed;
    asked[k] = -p.massN * parts[k];
  }
  const Vector p0 = block.points[0].impulseN;
  if constexpr (kPoints == 1) {
    change[0] = larger(asked[0], -p0);
  } else {
    const Vector p1 = block.points[1].impulseN;
    const Vector d0 = block.both * (asked[0] - block.firstBySecond * asked[1]),
                 d1 = block.both * (asked[1] - block.secondByFirst * asked[0]);
    const Vector x0 = p0 + d0, x1 = p1 + d1;
    const Vector alone0 = larger(asked[0] + block.firstBySecond * p1, -p0),
                 alone1 = larger(asked[1] + block.secondByFirst * p0, -p1);
    const auto hold = smaller(x0, x1) < Vector{};
    // The one that would bear more, if it bears anything alone.
    const Vector none = wide<Number>(-kFar);
    const auto first = choose(alone0 > -p0, x0, none) > choose(alone1 > -p1, x1, none);
    change[0] = choose(hold, choose(first, alone0, -p0), d0);
    change[1] = choose(hold, choose(first, -p1, alone1), d1);
  }
}

template <class Number>
template <int kPoints>
inline typename BlockSweeps<Number>::Pushes BlockSweeps<Number>::solve(Block& block, Relative<Vector> v,
                                                                       Order order) {
  const Vector nx = block.nx, ny = block.ny;
  const Vector inverse = block.inverseA + block.inverseB;
  const Vector givenX = inverse * nx, givenY = inverse * ny;
  Vector normal{}, tangential{}, turnA{}, turnB{}, largest{};
  const Vector far = wide<Number>(kFar);
  Vector least = far;
  auto turn = [&](Vector armA, Vector armB, Vector by) {
    const Vector byA = block.inertiaA * armA * by, byB = block.inertiaB * armB * by;
    turnA -= byA;
    turnB += byB;
    v.turnA -= byA;
    v.turnB += byB;
  };
  auto rub = [&] {
    for (int k = 0; k < kPoints; ++k) {
      Point& p = block.points[k];
      const Vector vt = (nx * v.y - ny * v.x) + (v.turnB * p.armBT - v.turnA * p.armAT);
      const Vector most = block.friction * p.impulseN;
      const Vector slide = smaller(larger(-p.massT * vt, -most - p.impulseT), most - p.impulseT);
      p.impulseT += slide;
      tangential += slide;
      v.x -= givenY * slide;
      v.y += givenX * slide;
      turn(p.armAT, p.armBT, slide);
    }
  };
  if (order == Order::frictionFirst) rub();
  Vector parts[kPoints], change[kPoints];
  changeNormals<kPoints>(block, v, parts, change);
  for (int k = 0; k < kPoints; ++k) {
    Point& p = block.points[k];
    const Vector total = p.impulseN + change[k];
    p.impulseN = total;
    normal += change[k];
    turn(p.armAN, p.armBN, change[k]);
    // The change of the velocity: all that was amiss, or less where the contact lets go.
    const Vector amiss = choose(parts[k] < Vector{}, -parts[k], parts[k]);
    largest = larger(largest, choose(change[k] != Vector{}, amiss, Vector{}));
    const Vector bears = larger(total, larger(p.impulseT, -p.impulseT));
    least = smaller(least, choose(p.massN > Vector{}, choose(bears > Vector{}, Vector{}, parts[k]), far));
  }
  v.x += givenX * normal;
  v.y += givenY * normal;
  if (order == Order::normalsFirst) rub();
  block.spare = smallestOf(least);
  block.change = largestOf(largest);
  return {nx * normal - ny * tangential, ny * normal + nx * tangential, turnA, turnB};
}

template <class Number>
inline Number BlockSweeps<Number>::solveSome(Block* const* some, int count, Order order, Motion* velocity) {
  Relative<Vector> v[kSome];
  for (int k = 0; k < count; ++k) gather(velocity, some[k]->a, some[k]->b, v[k]);
  Number change = 0;
  for (int k = 0; k < count; ++k) {
    v[k] = some[k]->count == 2 ? solve<2>(*some[k], v[k], order) : solve<1>(*some[k], v[k], order);
    change = std::max(change, some[k]->change);
  }
  for (int k = 0; k < count; ++k) {
    const Block& block = *some[k];
    const Pushes& by = v[k];
    scatterAdd(velocity, block.a, -block.inverseA * by.x, -block.inverseA * by.y, by.turnA);
    scatterAdd(velocity, block.b, block.inverseB * by.x, block.inverseB * by.y, by.turnB);
  }
  return change;
}

template <class Number>
template <class Todo>
Number BlockSweeps<Number>::shared(int begin, int end, Todo&& todo) {
  if (end - begin < kShared) return todo(begin, end);
  return static_cast<Number>(pool_.max(begin, end, kGrain, 0, todo));
}

template <class Number>
template <class Todo>
Number BlockSweeps<Number>::eachColour(bool back, Todo&& todo) {
  const int count = static_cast<int>(colourEnds_.size());
  Number result = 0;
  for (int k = 0; k < count; ++k) {
    const int colour = back ? count - 1 - k : k;
    result = std::max(result, shared(colour > 0 ? colourEnds_[colour - 1] : 0, colourEnds_[colour], todo));
  }
  return result;
}

template <class Number>
double BlockSweeps<Number>::sweepFirst(Bodies& bodies, double h, const MoveApart& apart) {
  const Number perSecond = static_cast<Number>(1 / h);
  const MoveApart own = unrelaxed(apart);
  back_ = !back_ && !(relaxation_ > 1);
  overlap_.resize(blocks_.size());
  change_ = eachColour(back_, [&](int k, int end) {
    Number result = 0;
    Block* some[kSome];
    while (k < end) {
      int count = 0;
      for (; count < kSome && k < end; ++k) {
        some[count++] = &blocks_[k];
        overlap_[k] = begin(blocks_[k], bodies.moved.data(), perSecond, own);
      }
      result = std::max(result, solveSome(some, count, Order::normalsFirst, bodies.velocity.data()));
    }
    return result;
  });
  deep_.clear();
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    if (static_cast<double>(overlap_[k]) > apart.deep) deep_.push_back(static_cast<int>(k));
  if (back_) std::reverse(deep_.begin(), deep_.end());
  return static_cast<double>(change_);
}

template <class Number>
double BlockSweeps<Number>::sweep(Bodies& bodies) {
  change_ = eachColour(!back_, [&](int k, int end) {
    Number result = 0;
    Block* some[kSome];
    while (k < end) {
      int count = 0;
      for (; count < kSome && k < end; ++k)
        if (!(blocks_[k].spare > kSpare * change_)) some[count++] = &blocks_[k];
      result = std::max(result, solveSome(some, count, Order::frictionFirst, bodies.velocity.data()));
    }
    return result;
  });
  return static_cast<double>(change_);
}

template <class Number>
void BlockSweeps<Number>::beginRough(double above) {
  rough_.clear();
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    if (static_cast<double>(blocks_[k].change) >= above) rough_.push_back(static_cast<int>(k));
}

template <class Number>
double BlockSweeps<Number>::sweepRough(Bodies& bodies, double above) {
  Number largest = 0;
  int next = 0;
  for (const int end : colourEnds_) {
    const int first = next;
    while (next < static_cast<int>(rough_.size()) && rough_[next] < end) ++next;
    const Number result = shared(first, next, [&](int at, int last) {
      Number some = 0;
      Block* blocks[kSome];
      while (at < last) {
        int count = 0;
        for (; count < kSome && at < last; ++at) {
          Block& block = blocks_[rough_[at]];
          if (block.spare > kSpare * change_)
            block.change = 0;
          else
            blocks[count++] = &block;
        }
        some = std::max(some, solveSome(blocks, count, Order::frictionFirst, bodies.velocity.data()));
      }
      return some;
    });
    largest = std::max(largest, result);
  }
  std::erase_if(rough_, [&](int k) { return static_cast<double>(blocks_[k].change) < above; });
  change_ = largest;
  return static_cast<double>(largest);
}

template <class Number>
void BlockSweeps<Number>::read(int place, Contact& contact) const {
  const Block& block = blocks_[place / kLanes];
  const int lane = place % kLanes;
  for (int p = 0; p < contact.count; ++p) {
    contact.points[p].impulseN = static_cast<double>(numbers(block.points[p].impulseN)[lane]);
    contact.points[p].impulseT = static_cast<double>(numbers(block.points[p].impulseT)[lane]);
    contact.total += contact.points[p].impulseN;
  }
  contact.total += static_cast<double>(numbers(block.total)[lane]);
}

template <class Number>
void BlockSweeps<Number>::drop(int place) {
  Block& block = blocks_[place / kLanes];
  const int lane = place % kLanes;
  numbers(block.total)[lane] = 0;
  for (Point& p : block.points)
    for (Vector* of : {&p.massN, &p.massT, &p.impulseN, &p.impulseT}) numbers(*of)[lane] = 0;
  block.a[lane] = block.b[lane] = 0;
}

template class BlockSweeps<double>;
template class BlockSweeps<float>;

}  // namespace smokebox
