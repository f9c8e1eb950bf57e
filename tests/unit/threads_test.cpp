#include "base/threads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace smokebox {
namespace {

TEST(ThreadPool, EveryIndexIsVisitedOnceWhateverTheThreads) {
  // Truth: blocks cover [first, last) exactly.
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    for (int repeat = 0; repeat < 300; ++repeat) {
      std::vector<int> visits(1013, 0);
      pool.blocks(0, 1013, 7, [&](int begin, int end) {
        for (int k = begin; k < end; ++k) ++visits[k];
      });
      ASSERT_EQ(std::accumulate(visits.begin(), visits.end(), 0), 1013);
      ASSERT_EQ(*std::min_element(visits.begin(), visits.end()), 1);
    }
  }
}

TEST(ThreadPool, SumsAreTheSameToTheBit) {
  // Truth: blocks are added in order, so the rounding does not depend on who worked them out.
  auto sum = [](int threads) {
    ThreadPool pool(threads);
    return pool.sum(0, 100000, 64, [](int begin, int end) {
      double total = 0;
      for (int k = begin; k < end; ++k) total += 1.0 / (k + 1);
      return total;
    });
  };
  EXPECT_EQ(sum(1), sum(2));
  EXPECT_EQ(sum(1), sum(4));
}

TEST(ThreadPool, MaxPassesNotANumberOn) {
  // Truth: a NaN anywhere must reach the caller, else a broken simulation looks sound.
  ThreadPool pool(2);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double largest = pool.max(0, 10, 1, 0, [&](int begin, int) { return begin == 3 ? nan : begin; });
  EXPECT_TRUE(std::isnan(largest));
}

TEST(ThreadPool, AnExceptionOfABlockReachesTheCaller) {
  // Truth: nothing is swallowed, and the pool works on afterwards.
  ThreadPool pool(2);
  EXPECT_THROW(pool.blocks(0, 100, 1,
                           [](int begin, int) {
                             if (begin == 50) throw std::runtime_error("block 50");
                           }),
               std::runtime_error);
  int count = 0;
  pool.blocks(0, 1, 1, [&](int, int) { ++count; });
  EXPECT_EQ(count, 1);
}

}  // namespace
}  // namespace smokebox
