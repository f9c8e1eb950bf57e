// Which points of which bodies touch or are about to.
//
// Most pairs move little against each other in a step: their contacts are found once, at its start, with a
// margin for what may happen (calm contacts). Pairs that close in fast, or of which a body is thrown off the
// way that was expected of it, are looked at anew in every sub-step (lively contacts); those that could pass
// through each other within a sub-step by a swept test.
#pragma once
#include <limits>
#include <vector>

#include "base/threads.h"
#include "rigid/broad_phase.h"
#include "rigid/contact.h"
#include "rigid/contact_blocks.h"
#include "rigid/pair_contacts.h"
#include "rigid/passing.h"
#include "rigid/press.h"

namespace smokebox {

class NarrowPhase {
 public:
  explicit NarrowPhase(ThreadPool& pool) : pool_(pool) {}
  /// Sorts the pairs into calm and lively, and finds the calm contacts for a step of `dt`.
  void beginStep(const Bodies& bodies, BroadPhase& broad, const Press& press, Vec2 gravity, double dt,
                 int subSteps);
  /// Finds the lively contacts for the coming sub-step, with the impulses of the last one; `since`: by body,
  /// the moment within it from which its way is straight (null: its start).
  void refresh(const Bodies& bodies, const BroadPhase& broad, double h, const std::vector<double>* since);
  /// The same for those alone that became lively since.
  void refreshNew(const Bodies& bodies, const BroadPhase& broad, double h, const std::vector<double>* since);
  /// After impacts, which have changed the bodies' ways by `struck`: looks again at the lively pairs that
  /// have had none themselves.
  void refreshAfterImpacts(const Bodies& bodies, const BroadPhase& broad, double h,
                           const std::vector<Motion>& struck, const std::vector<double>& struckAt);
  /// Bodies that would leave the way that was expected of them if they moved as fast as now, and by `struck`
  /// (null: nothing), in this sub-step or in the next one: from then on their pairs are lively. `now`: some
  /// do now (look at the new ones before they move).
  enum class Stir { none, later, now };
  Stir stir(const Bodies& bodies, const std::vector<Motion>* struck, BroadPhase& broad, Vec2 gravity,
            ContactBlocks& blocks, double timeLeft);
  /// May any lively pair pass through each other within the sub-step?
  bool mayPass(const Bodies& bodies, double h) const;
  /// Pairs that would pass through each other by moving `way`: both are stopped where they meet.
  void stopPassing(const Bodies& bodies, const BroadPhase& broad, double h, const std::vector<double>* since,
                   std::vector<Motion>& way);
  /// Bodies between others that close in whatever pushes back (a press): no impulses can part them all. These
  /// are not carried on, or they would grow without bound, and make none faster than the fastest around it
  /// was `before`. Has any been taken off the record?
  bool yieldCrushed(Bodies& bodies, const std::vector<Motion>& before);
  /// A sub-step has passed.
  void advance() { elapsed_ += h_; }
  /// Remembers the contacts and their impulses for the next step; the calm ones are up to date.
  void endStep(BroadPhase& broad);

  std::vector<Contact>& calm() { return calm_; }
  const std::vector<Contact>& calm() const { return calm_; }
  std::vector<SolvedContact>& lively() { return lively_; }
  const std::vector<SolvedContact>& lively() const { return lively_; }
  /// Contacts of a lively pair count only while it is so: calm ones that were dropped.
  bool isDropped(int calm) const { return dropped_[calm]; }
  std::size_t bytes() const;

 private:
  static constexpr int kTogether = 256;  // pairs that a thread looks at, at a time
  static constexpr double kNoBound = std::numeric_limits<double>::infinity();
  /// Where both are sunk, contacts are found anew once they have moved by this share of what they may stray
  /// for that.
  static constexpr double kReuseSunk = 0.5;
  struct LivelyPair {
    PairKey key;
    int first = 0, count = 0;    // in lively_
    bool swept = false;          // could pass through each other within a sub-step
    double clear = -1;           // what was found holds until they have moved so far against each other, m
    int pair = -1;               // in the broad phase's list; -1: found within the step
    double near = 0, reuse = 0;  // what is looked for, and how long that holds then, m
    bool due = false;            // is to be looked at in this sub-step
    int found = 0;               // contacts, then
  };
  /// What is expected of a body's way, as all are looked at in each sub-step.
  struct Expected {
    Motion velocity;         // at the step's start
    Motion within{0, 0, 0};  // who is not off by more, squared, along any axis does not leave
  };
  /// What else that takes of those few that are off by more.
  struct Room {
    double room = 0;   // how far its points may be from where that takes them, m
    double limit = 0;  // the same while its pairs are calm and may be stirred, else without bound
    double turn = 0;   // the same for what it may turn from there, rad
    double reach = 0;  // how far a turn moves its points, m/rad
  };
  void setLimit(int body, double limit, double mostTurn);
  /// Puts into leaving_ who leaves in this sub-step or in the next one; does any in this one?
  bool findLeaving(const Bodies& bodies, const std::vector<Motion>* struck, double timeLeft);
  void listPairs(const Bodies& bodies, const std::vector<BodyPair>& pairs);
  void makeLively(const PairKey& key, int pair, const Contact* old, int count);
  /// What is asked of a body at the step's start for each of its pairs, side by side in a line of the cache:
  /// where a bound is enough, in float32.
  struct alignas(64) Seen {
    Vec2 position, velocity;
    double angleRad = 0;
    float turn = 0;  // rad/s
    float thinnest = 0, turningReach = 0;
    float room = 0;  // as Room's
    float sunk = 0;  // the part of it that is for what it lies in, m
    bool bounces = false;
    bool pushes = false;  // moves, and nothing moves it
  };
  static_assert(sizeof(Seen) == 64);
  /// What a thread finds of some pairs: those that are due to be looked at anew and their contacts, one
  /// pair's after the other's; those that are lively.
  struct Part {
    std::vector<int> due, lively;
    std::vector<Contact> found;
    int contacts = 0, first = 0;  // calm ones of them all, and where they begin
    PairContacts finder;
  };
  /// Of the pairs begin to end: which are lively, which are due ...
  void sortPairs(Part& part, BroadPhase& broad, int begin, int end, double slow, double dt);
  /// ... the contacts of those ...
  void findDue(Part& part, const Bodies& bodies, BroadPhase& broad);
  /// ... and all the calm ones, found or kept, at their places.
  void takePairs(const Part& part, const Bodies& bodies, std::vector<BodyPair>& pairs, int begin, int end);
  static double relativeWay(const Seen& a, const Seen& b, double dt);
  /// Do the bodies of a pair move too much in a step for what was found at its start?
  static bool movesFast(const Seen& a, const Seen& b, double way, double slow, double dt);
  /// Do the contacts of the last step still hold? If not: notes for which places they are found now.
  bool mayKeep(const Seen& a, const Seen& b, BodyPair& pair, Vec2 shift, double way) const;
  /// Is a lively pair to be looked at in this sub-step?
  bool isDue(LivelyPair& pair, const Bodies& bodies, Vec2 shift, double h);
  void dropContacts(const LivelyPair& pair);
  void replace(LivelyPair& pair, const Bodies& bodies, Contact* found, int count);

  std::vector<Contact> calm_, next_, memory_;
  std::vector<SolvedContact> lively_;
  std::vector<char> dropped_;
  std::vector<LivelyPair> pairs_;
  int refreshed_ = 0;  // so many of them have been looked at in this sub-step
  std::vector<Expected> expected_;
  std::vector<Room> rooms_;
  std::vector<Seen> seen_;
  std::vector<int> stirred_;
  std::vector<Motion> way_;       // of those that leave theirs
  std::vector<char> livelyPair_;  // by index of the broad phase's pairs
  // By body: the range of the pairs in which it is the first one, and that in the list of where it is second.
  std::vector<int> pairsOfFirst_, pairsOfSecond_, pairsAt_;
  bool pairsListed_ = false;
  PairContacts finder_;
  std::vector<int> due_;  // lively pairs whose contacts are to be found
  std::vector<Part> parts_;
  std::vector<PairKey> late_, swept_;
  Passing passing_;
  std::vector<int> leaving_, turned_, crushed_;
  std::vector<int> leavingOf_;      // so many of each part of the bodies
  std::vector<double> crushSpeed_;  // by crushed body
  std::vector<int> crushedAt_;      // in crushed_, by body; -1: it is not
  double elapsed_ = 0, h_ = 0;
  ThreadPool& pool_;
};

}  // namespace smokebox
