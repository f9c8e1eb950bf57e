#include "rigid/contact_blocks.h"

#include <algorithm>
#include <bit>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace smokebox {

namespace {

using Lanes = ContactBlocks::Lanes;
using Motions = ContactBlocks::Motions;
constexpr int kColours = 64;
// So few contacts would leave most lanes empty: they are solved one by one.
constexpr int kFew = 12;
// Within a colour: those that bear or not, of two points or one, for blocks are done, or left out, as a
// whole.
constexpr int kKinds = 4;
// A block that parted faster than it needs by so many times what the last sweep changed is left out.
constexpr double kSpare = 4;
// More points than so many are swept but once in a sub-step, and each one gives more than it is asked for
// (successive over-relaxation): bins of 10,000 overlap less by it. A pyramid of 5,000 boxes, 20,000 points,
// would not stand.
constexpr long kMany = 30000;
constexpr float kOverRelaxed = 1.3F;

typedef double Four __attribute__((vector_size(32)));

static_assert(sizeof(Motion) == ContactBlocks::kNumbers * sizeof(double));
/// Bodies' motions, two in a row; `at` counts numbers, not bodies: that needs no multiplication.
inline Lanes rows(const Motion* from, int low, int high) {
  const double* numbers = &from->x;
  const Four a = *reinterpret_cast<const Four*>(numbers + low),
             b = *reinterpret_cast<const Four*>(numbers + high);
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}

/// Eight bodies' motions, one a lane.
inline Motions gather(const Motion* from, const int* index) {
  const Lanes r02 = rows(from, index[0], index[2]), r13 = rows(from, index[1], index[3]);
  const Lanes r46 = rows(from, index[4], index[6]), r57 = rows(from, index[5], index[7]);
  // x and turn, y and nothing: of 0, 1 in the first half, of 2, 3 in the second one; of 4, 5 and 6, 7
  const Lanes xt = __builtin_shufflevector(r02, r13, 0, 8, 2, 10, 4, 12, 6, 14),
              y = __builtin_shufflevector(r02, r13, 1, 9, 3, 11, 5, 13, 7, 15);
  const Lanes xtAfter = __builtin_shufflevector(r46, r57, 0, 8, 2, 10, 4, 12, 6, 14),
              yAfter = __builtin_shufflevector(r46, r57, 1, 9, 3, 11, 5, 13, 7, 15);
  return {__builtin_shufflevector(xt, xtAfter, 0, 1, 4, 5, 8, 9, 12, 13),
          __builtin_shufflevector(y, yAfter, 0, 1, 4, 5, 8, 9, 12, 13),
          __builtin_shufflevector(xt, xtAfter, 2, 3, 6, 7, 10, 11, 14, 15)};
}

inline Four low(Lanes a) { return __builtin_shufflevector(a, a, 0, 1, 2, 3); }
inline Four high(Lanes a) { return __builtin_shufflevector(a, a, 4, 5, 6, 7); }

/// A body that does not move may be in several lanes: each gives back what it was.
inline void scatter(Motion* to, const int* index, const Motions& m) {
  const Lanes xyEven = __builtin_shufflevector(m.x, m.y, 0, 8, 2, 10, 4, 12, 6, 14),
              xyOdd = __builtin_shufflevector(m.x, m.y, 1, 9, 3, 11, 5, 13, 7, 15);
  const Lanes zero{};
  const Lanes turnEven = __builtin_shufflevector(m.turn, zero, 0, 8, 2, 10, 4, 12, 6, 14),
              turnOdd = __builtin_shufflevector(m.turn, zero, 1, 9, 3, 11, 5, 13, 7, 15);
  const Lanes r02 = __builtin_shufflevector(xyEven, turnEven, 0, 1, 8, 9, 2, 3, 10, 11),
              r46 = __builtin_shufflevector(xyEven, turnEven, 4, 5, 12, 13, 6, 7, 14, 15);
  const Lanes r13 = __builtin_shufflevector(xyOdd, turnOdd, 0, 1, 8, 9, 2, 3, 10, 11),
              r57 = __builtin_shufflevector(xyOdd, turnOdd, 4, 5, 12, 13, 6, 7, 14, 15);
  auto storeRow = [&](int at, Four row) { *reinterpret_cast<Four*>(&to->x + at) = row; };
  storeRow(index[0], low(r02));
  storeRow(index[1], low(r13));
  storeRow(index[2], high(r02));
  storeRow(index[3], high(r13));
  storeRow(index[4], low(r46));
  storeRow(index[5], low(r57));
  storeRow(index[6], high(r46));
  storeRow(index[7], high(r57));
}

template <class Short>
inline Lanes wide(Short a) {
#ifdef __AVX512F__
  return reinterpret_cast<Lanes>(
      _mm512_maskz_cvtps_pd(0xff, reinterpret_cast<__m256>(a)));  // GCC 12 takes it in halves
#else
  return __builtin_convertvector(a, Lanes);
#endif
}
inline ContactBlocks::ShortLanes brief(Lanes a) {
  return __builtin_convertvector(a, ContactBlocks::ShortLanes);
}
inline Lanes larger(Lanes a, Lanes b) { return a > b ? a : b; }
inline Lanes smaller(Lanes a, Lanes b) { return a < b ? a : b; }
inline double largestOf(Lanes a) {
  const Four lower = low(a), upper = high(a), four = lower > upper ? lower : upper;
  const Four turned = __builtin_shufflevector(four, four, 2, 3, 0, 1), two = four > turned ? four : turned;
  return std::max(two[0], two[1]);
}
inline double smallestOf(Lanes a) { return -largestOf(-a); }

}  // namespace

void ContactBlocks::build(const Bodies& bodies, const std::vector<Contact>& contacts, std::vector<int>& rest,
                          Vec2 down) {
  const int count = static_cast<int>(contacts.size());
  used_.assign(bodies.count(), 0);
  colour_.resize(count);
  place_.assign(count, -1);
  start_.assign(kKinds * kColours + 1, 0);
  kind_.resize(count);
  rest.clear();
  blocks_.clear();
  points_ = 0;
  if (count <= kFew) {
    for (int k = 0; k < count; ++k) rest.push_back(k);
    return;
  }
  // First what bears along gravity, then what bears sideways, last what is merely near: a sweep in this order
  // leaves the least undone, and does not change with what comes near.
  brief_.resize(count);
  for (int k = 0; k < count; ++k) {
    const Contact& c = contacts[k];
    const bool bears = c.points[0].impulseN > 0 || c.points[1].impulseN > 0;
    const double along = dot(c.normal, down);
    brief_[k] = {c.a, c.b, !bears ? 2 : along * along > 0.5 ? 0 : 1, c.count};
  }
  for (const int rank : {0, 1, 2})
    for (int k = 0; k < count; ++k) {
      const Brief& c = brief_[k];
      if (c.rank != rank) continue;
      const bool movesA = bodies.moves(c.a), movesB = bodies.moves(c.b);
      const std::uint64_t used = (movesA ? used_[c.a] : 0) | (movesB ? used_[c.b] : 0);
      if (~used == 0) {
        colour_[k] = -1;
        rest.push_back(k);
        continue;
      }
      const int colour = std::countr_one(used);
      colour_[k] = colour;
      if (movesA) used_[c.a] |= std::uint64_t{1} << colour;
      if (movesB) used_[c.b] |= std::uint64_t{1} << colour;
      kind_[k] = kKinds * colour + (rank < 2 ? 0 : 2) + (c.count == 2 ? 0 : 1);
      ++start_[kind_[k] + 1];
    }
  // Each colour begins a new block.
  std::size_t blocks = 0;
  for (int colour = 0; colour < kColours; ++colour) {
    int lane = static_cast<int>(blocks) * kLanes;
    for (int kind = kKinds * colour; kind < kKinds * (colour + 1); ++kind) {
      const int lanes = start_[kind + 1];
      start_[kind] = lane;
      lane += lanes;
    }
    blocks = (lane + kLanes - 1) / kLanes;
  }
  inLane_.assign(kLanes * blocks, -1);
  for (int k = 0; k < count; ++k)
    if (colour_[k] >= 0) inLane_[place_[k] = start_[kind_[k]]++] = k;
  blocks_.resize(blocks);
  for (std::size_t k = 0; k < blocks; ++k) {
    fill(blocks_[k], bodies, contacts, inLane_.data() + kLanes * k);
    points_ += kLanes * blocks_[k].count;
  }
  if (!areMany()) return;
  for (Block& block : blocks_)
    for (Point& p : block.points) {
      p.massN *= kOverRelaxed;
      p.massT *= kOverRelaxed;
    }
}

bool ContactBlocks::areMany() const { return points_ > kMany; }

void ContactBlocks::fill(Block& block, const Bodies& bodies, const std::vector<Contact>& contacts,
                         const int* which) {
  block = Block{};
  struct {
    Lanes inverseA{}, inertiaA{}, inverseB{}, inertiaB{};
    Lanes armAN[2]{}, armBN[2]{}, armAT[2]{}, armBT[2]{};
  } exact;
  for (int l = 0; l < kLanes; ++l) {
    block.contact[l] = which[l];
    if (which[l] < 0) continue;
    const Contact& c = contacts[which[l]];
    block.a[l] = kNumbers * c.a;
    block.b[l] = kNumbers * c.b;
    block.count = std::max(block.count, c.count);
    const InverseMass &a = bodies.inverse[c.a], &b = bodies.inverse[c.b];
    block.nx[l] = static_cast<float>(c.normal.x);
    block.ny[l] = static_cast<float>(c.normal.y);
    block.friction[l] = static_cast<float>(c.friction);
    exact.inverseA[l] = a.mass;
    exact.inertiaA[l] = a.inertia;
    exact.inverseB[l] = b.mass;
    exact.inertiaB[l] = b.inertia;
    const Vec2 tangent = perpendicular(c.normal);
    for (int p = 0; p < c.count; ++p) {
      const ContactPoint& from = c.points[p];
      exact.armAN[p][l] = cross(from.armA, c.normal);
      exact.armBN[p][l] = cross(from.armB, c.normal);
      exact.armAT[p][l] = cross(from.armA, tangent);
      exact.armBT[p][l] = cross(from.armB, tangent);
      Point& to = block.points[p];
      to.gap[l] = from.gap;
      to.impulseN[l] = from.impulseN;
      to.impulseT[l] = from.impulseT;
      block.total[l] -= from.impulseN;  // which the first sweep counts, but belongs to the step before
    }
  }
  block.inverseA = brief(exact.inverseA);
  block.inertiaA = brief(exact.inertiaA);
  block.inverseB = brief(exact.inverseB);
  block.inertiaB = brief(exact.inertiaB);
  for (int p = 0; p < block.count; ++p) {
    Point& to = block.points[p];
    to.armAN = brief(exact.armAN[p]);
    to.armBN = brief(exact.armBN[p]);
    to.armAT = brief(exact.armAT[p]);
    to.armBT = brief(exact.armBT[p]);
    auto mass = [&](Lanes armA, Lanes armB) {
      const Lanes inverse =
          exact.inverseA + exact.inverseB + exact.inertiaA * armA * armA + exact.inertiaB * armB * armB;
      return brief(inverse > 0 ? 1 / inverse : Lanes{});
    };
    to.massN = mass(exact.armAN[p], exact.armBN[p]);
    to.massT = mass(exact.armAT[p], exact.armBT[p]);
    for (int l = 0; l < kLanes; ++l)  // a contact of one point beside one of two
      if (which[l] >= 0 && contacts[which[l]].count <= p) to.massN[l] = to.massT[l] = 0;
  }
}

void ContactBlocks::warmStart(Bodies& bodies) const {
  Motion* velocity = bodies.velocity.data();
  for (const Block& block : blocks_) {
    Motions va = gather(velocity, block.a), vb = gather(velocity, block.b);
    for (int k = 0; k < block.count; ++k) {
      const Point& p = block.points[k];
      // Tangent: the normal turned by 90 degrees counterclockwise.
      const Lanes px = wide(block.nx) * p.impulseN - wide(block.ny) * p.impulseT,
                  py = wide(block.ny) * p.impulseN + wide(block.nx) * p.impulseT;
      va.x -= wide(block.inverseA) * px;
      va.y -= wide(block.inverseA) * py;
      va.turn -= wide(block.inertiaA) * (wide(p.armAN) * p.impulseN + wide(p.armAT) * p.impulseT);
      vb.x += wide(block.inverseB) * px;
      vb.y += wide(block.inverseB) * py;
      vb.turn += wide(block.inertiaB) * (wide(p.armBN) * p.impulseN + wide(p.armBT) * p.impulseT);
    }
    scatter(velocity, block.a, va);
    scatter(velocity, block.b, vb);
  }
}

/// Moves the bodies of a block apart where they overlap, on places alone.
inline void ContactBlocks::separate(const Block& block, const Apart& apart, Motion* moved, Motions& da,
                                    Motions& db) {
  const Lanes nx = wide(block.nx), ny = wide(block.ny), cap = Lanes{} + apart.most;
  for (int k = 0; k < block.count; ++k) {
    const Point& p = block.points[k];
    const Lanes armA = wide(p.armAN), armB = wide(p.armBN);
    const Lanes gap = p.gap + nx * (db.x - da.x) + ny * (db.y - da.y) + db.turn * armB - da.turn * armA;
    const Lanes overlap = smaller(larger(-apart.share * gap, Lanes{}), cap) * wide(p.massN);
    da.x -= wide(block.inverseA) * nx * overlap;
    da.y -= wide(block.inverseA) * ny * overlap;
    da.turn -= wide(block.inertiaA) * armA * overlap;
    db.x += wide(block.inverseB) * nx * overlap;
    db.y += wide(block.inverseB) * ny * overlap;
    db.turn += wide(block.inertiaB) * armB * overlap;
  }
  scatter(moved, block.a, da);
  scatter(moved, block.b, db);
}

template <int kPoints>
inline double ContactBlocks::solvePoints(Block& block, Bodies& bodies, double perSecond, const Apart* first) {
  Motion* velocity = bodies.velocity.data();
  Motion* moved = bodies.moved.data();
  const Lanes nx = wide(block.nx), ny = wide(block.ny);
  Motions da = gather(moved, block.a), db = gather(moved, block.b);
  const Lanes apart = nx * (db.x - da.x) + ny * (db.y - da.y);
  Lanes allowed[kPoints], deepest{};
  for (int k = 0; k < kPoints; ++k) {
    const Point& p = block.points[k];
    const Lanes gap = p.gap + apart + db.turn * wide(p.armBN) - da.turn * wide(p.armAN);
    deepest = smaller(deepest, gap);
    allowed[k] = larger(gap, Lanes{}) * (Lanes{} + perSecond);
    if (first) block.total += p.impulseN;  // what the last sub-step came to
  }
  if (first && smallestOf(deepest) < -first->slop) separate(block, *first, moved, da, db);

  // Of b against a; each one's own velocity follows from all the impulses at the end.
  Motions va = gather(velocity, block.a), vb = gather(velocity, block.b);
  const Lanes inverseA = wide(block.inverseA), inverseB = wide(block.inverseB);
  const Lanes inertiaA = wide(block.inertiaA), inertiaB = wide(block.inertiaB);
  const Lanes givenX = (inverseA + inverseB) * nx, givenY = (inverseA + inverseB) * ny;
  Lanes x = vb.x - va.x, y = vb.y - va.y;
  Lanes normal{}, tangential{}, largest{}, least = Lanes{} + 1e300;
  for (int k = 0; k < kPoints; ++k) {
    Point& p = block.points[k];
    const Lanes armAN = wide(p.armAN), armBN = wide(p.armBN), massN = wide(p.massN);
    const Lanes parts = (nx * x + ny * y) + (vb.turn * armBN - va.turn * armAN) + allowed[k];
    const Lanes total = larger(p.impulseN - massN * parts, Lanes{});
    const Lanes change = total - p.impulseN;
    p.impulseN = total;
    normal += change;
    x += givenX * change;
    y += givenY * change;
    va.turn -= inertiaA * armAN * change;
    vb.turn += inertiaB * armBN * change;
    // The change of the velocity: all that was amiss, or less where the contact lets go.
    const Lanes amiss = parts < 0 ? -parts : parts;
    largest = larger(largest, change != 0 ? amiss : Lanes{});
    least = smaller(least, massN > 0 ? (total > 0 ? Lanes{} : parts) : Lanes{} + 1e300);

    const Lanes armAT = wide(p.armAT), armBT = wide(p.armBT);
    const Lanes vt = (nx * y - ny * x) + (vb.turn * armBT - va.turn * armAT);
    const Lanes most = wide(block.friction) * total;
    const Lanes held = smaller(larger(p.impulseT - wide(p.massT) * vt, -most), most);
    const Lanes slide = held - p.impulseT;
    p.impulseT = held;
    tangential += slide;
    x -= givenY * slide;
    y += givenX * slide;
    va.turn -= inertiaA * armAT * slide;
    vb.turn += inertiaB * armBT * slide;
  }
  const Lanes px = nx * normal - ny * tangential, py = ny * normal + nx * tangential;
  va.x -= inverseA * px;
  va.y -= inverseA * py;
  vb.x += inverseB * px;
  vb.y += inverseB * py;
  block.spare = smallestOf(least);
  block.change = largestOf(largest);
  scatter(velocity, block.a, va);
  scatter(velocity, block.b, vb);
  return block.change;
}

inline double ContactBlocks::solveBlock(Block& block, Bodies& bodies, double perSecond, const Apart* first) {
  return block.count == 2 ? solvePoints<2>(block, bodies, perSecond, first)
                          : solvePoints<1>(block, bodies, perSecond, first);
}

double ContactBlocks::solve(Bodies& bodies, double h, const Apart* first) {
  double result = 0;
  for (Block& block : blocks_)
    if (first || !(block.spare > kSpare * change_))
      result = std::max(result, solveBlock(block, bodies, 1 / h, first));
  change_ = result;
  return result;
}

void ContactBlocks::beginRough(double above) {
  rough_.clear();
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    if (blocks_[k].change >= above) rough_.push_back(static_cast<int>(k));
}

double ContactBlocks::solveRough(Bodies& bodies, double h, double above) {
  double result = 0;
  std::size_t kept = 0;
  for (const int k : rough_) {
    if (blocks_[k].spare > kSpare * change_) continue;
    const double change = solveBlock(blocks_[k], bodies, 1 / h, nullptr);
    result = std::max(result, change);
    if (change >= above) rough_[kept++] = k;
  }
  rough_.resize(kept);
  change_ = result;
  return result;
}

void ContactBlocks::readLane(const Block& block, int lane, Contact& contact) {
  for (int p = 0; p < contact.count; ++p) {
    contact.points[p].impulseN = block.points[p].impulseN[lane];
    contact.points[p].impulseT = block.points[p].impulseT[lane];
    contact.total += block.points[p].impulseN[lane];
  }
  contact.total += block.total[lane];
}

void ContactBlocks::drop(int index, Contact& contact) {
  if (place_[index] < 0) return;
  Block& block = blocks_[place_[index] / kLanes];
  const int l = place_[index] % kLanes;
  readLane(block, l, contact);
  block.total[l] = 0;
  for (Point& p : block.points) p.massN[l] = p.massT[l] = p.impulseN[l] = p.impulseT[l] = 0;
  block.contact[l] = -1;
  place_[index] = -1;
}

void ContactBlocks::readBack(int index, Contact& contact) const {
  if (place_[index] >= 0) readLane(blocks_[place_[index] / kLanes], place_[index] % kLanes, contact);
}

}  // namespace smokebox
