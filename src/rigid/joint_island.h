// Joints that hang together, solved at once.
//
// The constraints hold at the places that bodies have at the sub-step's end, while impulses act along the
// directions of its start (SHAKE: Ryckaert, Ciccotti, Berendsen 1977): with leapfrog that is symplectic, so
// the energy of a pendulum does not drift. Newton's iterations find the impulses, with the matrix J' M^-1 J^T
// of all rows: J' is that of the start (J) while this brings the solution nearer fast enough, and then that
// of the end, without which a heavy load on a light chain is not found. Limits, ropes and motors ("drives")
// have a staircase of impulse over rate; which stair each is on is part of the iteration (a primal-dual
// active set: Hintermueller, Ito, Kunisch 2002).
//
// A strong pull on a light body swings it faster than the sub-step can follow: w^2 = (arms . forces) /
// inertia. Where w h > 1/2, the body's inertia in the joints' rows grows to what makes that swing implicit,
// as that of a spring of this stiffness (spring_row.h; Andrews, Teichmann, Kry 2017: geometric stiffness).
// Forces at rest stay as they are.
//
// Limits: where a body turns by more than about a radian in a sub-step there may be no such impulse; then the
// island takes its constraints as linear, for that sub-step. Joints that contradict one another pull with
// forces that are not carried on from one sub-step to the next.
#pragma once
#include "rigid/block_factor.h"
#include "rigid/joint_rows.h"

namespace smokebox {

struct Joint {
  JointDef def;
  bool there = true;
  double startAngle = 0;     // of b less that of a
  JointRow impulse{};        // of the sub-step, N s and N m s
  std::array<bool, 3> on{};  // rows in the direct solve
};

class JointIsland {
 public:
  /// False if it is too dense for a direct solve.
  bool layOut(const std::vector<int>& joints, const std::vector<Joint>& all, const Bodies& bodies);

  void warmStart(std::vector<Joint>& joints, Bodies& bodies, double h);
  /// Until it holds. Returns the largest rate, m/s, that it found and took away.
  double solve(std::vector<Joint>& joints, Bodies& bodies, double h);
  /// Takes its constraints as linear and bodies with their own inertia until the sub-step's end: then sweeps
  /// over this and contacts are projections in one metric, and do not diverge.
  void stayLinear(const std::vector<Joint>& joints, const Bodies& bodies);
  /// Before impacts, which last no time: the joints as the bodies are now, with the ropes and limits that
  /// held in the last sub-step, and no motor.
  void beginImpacts(const std::vector<Joint>& joints, Bodies& bodies);
  /// Two bodies (-1: none) were changed at once: adds what the joints make of it to the velocities of all.
  void react(const std::array<int, 2>& struck, const std::array<Motion, 2>& change, Bodies& bodies);
  /// visit(body) for all that hang on it and move.
  template <class Visit>
  void eachBody(const Bodies& bodies, Visit&& visit) const {
    for (const Place& p : places_)
      if (bodies.moves(p.body)) visit(p.body);
  }
  /// After a sub-step: joints only lead bodies elsewhere, so what they give much energy to was flung by rows
  /// that all but contradict one another. It counts as not settled.
  void doubt(const std::vector<Joint>& joints, const Bodies& bodies);
  /// Did no motion satisfy it in this sub-step, or is a joint farther open than a sub-step closes?
  bool isTorn() const { return !settled_ || linear_ || isOpen_; }
  /// Marks all its bodies if it is torn or one of them is marked. False: nothing new.
  bool mark(std::vector<char>& marked) const;

  std::size_t bytes() const;

 private:
  /// A drive's impulse over its rate falls: any from `push` up at `low`, `push` between `low` and `speed`,
  /// any down to -push at `speed`, -push up to `high`, any from -push down there.
  struct Drive {
    double low = 0, high = 0, speed = 0;
    double push = 0;  // N s
  };
  struct Link {
    int joint = 0;
    int a = -1, b = -1;            // bodies; -1: the world
    int placeA = -1, placeB = -1;  // in places_
    JointJacobians rows;           // at the sub-step's start: what impulses act along
    JointJacobians atEnd;          // what rates are measured along, in the matrix
    JointRow gap{};                // at the sub-step's start
    JointRow goal{};               // at its end, of equalities
    JointRow ownInertia{};         // rate of each row from its own impulse
    Drive drive;
    double driveGoal = 0;        // rate
    std::array<bool, 3> in{};    // rows in the matrix
    int side = 0;                // in impacts: the sign of a drive's impulse; 0: it has no drive that holds
    std::array<bool, 3> open{};  // rows: farther than a sub-step closes
    double reach = 0;            // m
    double off = 0;              // its widest gap, as a share of its reach, or rad
    JointRow tolerance{};        // of gaps
  };
  struct Coupling {
    int slot = 0, row = 0, column = 0, body = 0;
  };
  struct Place {
    int body = 0;
    Frame frame;
    double angle = 0;
    InverseMass inverse;
    double kept = 1;   // of its spin, when its inertia grew
    double swing = 0;  // N s m: how fast the joints' moment on it falls as it turns
    Motion free;       // its velocity without the joints
  };

  void place(const Bodies& bodies, double h);
  JointPlace placeOf(const Link& link) const;
  JointRow ratesOf(const Link& link, const Joint& joint, const Bodies& bodies, double h) const;
  bool chooseStair(Link& link, Joint& joint, double rate, bool mayJoin, double& impulse) const;
  void factor(const std::vector<Joint>& joints);
  void factor();
  void findReaction(const std::array<int, 2>& struck, const std::array<Motion, 2>& change);
  void prepare(Link& link, Joint& joint, double h);
  void stiffen(const std::vector<Joint>& joints, Bodies& bodies, double h);
  void stiffenAgain(const std::vector<Joint>& joints, Bodies& bodies, double h);
  double kinetic(const Bodies& bodies) const;
  void goLinear(const std::vector<Joint>& joints);
  void apply(const Link& link, const JointRow& impulse, Bodies& bodies) const;

  std::vector<Link> links_;
  std::vector<Place> places_;
  std::vector<Coupling> couplings_;
  BlockFactor<3> matrix_;
  std::vector<JointRow> unknowns_, implied_;  // implied_: pivots of rows that count as nothing
  /// Of a sub-step: the constraints as they are; if that fails, as linear, to know the impulses; as they are,
  /// with inertia to match these; and if that fails too, as linear.
  enum class Phase { asTheyAre, probe, stiffened, linear };
  Phase phase_ = Phase::asTheyAre;
  double probeEnergy_ = 0;  // of the probe's solution, J
  bool linear_ = false, curved_ = false, settled_ = true;
  bool isOpen_ = false, stays_ = false;
};

}  // namespace smokebox
