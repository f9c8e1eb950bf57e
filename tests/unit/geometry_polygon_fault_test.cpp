// What is wrong with polygons, and that nothing is wrong with good ones.
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

#include "geometry/shape.h"

namespace smokebox {
namespace {

TEST(PolygonFault, SimplePolygonsHaveNone) {
  // Convex, concave, either orientation, corners on a straight edge.
  EXPECT_EQ(polygonFault({{0, 0}, {1, 0}, {0, 1}}), "");
  EXPECT_EQ(polygonFault({{0, 0}, {0, 1}, {1, 0}}), "");
  EXPECT_EQ(polygonFault({{0, 0}, {2, 0}, {2, 2}, {1, 0.5}, {0, 2}}), "");
  EXPECT_EQ(polygonFault({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {0, 1}}), "");
  EXPECT_EQ(polygonFault({{1e-6, 0}, {2e-6, 0}, {1e-6, 3e-6}}), "");
}

TEST(PolygonFault, DegenerateOnesAreNamed) {
  // Too few points, no extent, repeated points, not finite.
  EXPECT_EQ(polygonFault({{0, 0}, {1, 0}}), "a polygon needs at least 3 points, this one has 2");
  EXPECT_EQ(polygonFault({{0, 0}, {1, 0}, {1, 0}, {0, 1}}), "edge 2 (1,0)-(1,0) has no length");
  EXPECT_EQ(polygonFault({{0, 0}, {1, 0}, {0, 1}, {0, 0}}), "edge 4 (0,0)-(0,0) has no length");
  EXPECT_EQ(polygonFault({{0, 0}, {1, 1}, {2, 2}, {0.5, 0.5}}),
            "all points lie on one line: the polygon has no area");
  EXPECT_EQ(polygonFault({{0, 0}, {1, 0}, {NAN, 1}}), "point 3 is not finite");
  EXPECT_EQ(polygonFault({{1, 1}, {1, 1}, {1, 1}}), "edge 1 (1,1)-(1,1) has no length");
}

TEST(PolygonFault, CrossingEdgesAreNamed) {
  // A bow tie, a spike that touches an edge, a corner shared by two loops, an edge folded back.
  EXPECT_EQ(polygonFault({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), "edge 1 (0,0)-(1,1) crosses edge 3 (1,0)-(0,1)");
  EXPECT_NE(polygonFault({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}).find("edge 1 (0,0)-(2,0) touches edge "),
            std::string::npos);
  EXPECT_NE(polygonFault({{0, 0}, {1, 1}, {2, 0}, {2, 2}, {1, 1}, {0, 2}}).find("touches"),
            std::string::npos);
  EXPECT_EQ(polygonFault({{0, 0}, {2, 0}, {1, 0}, {1, 1}}),
            "edge 1 (0,0)-(2,0) is folded back by edge 2 (2,0)-(1,0)");
}

TEST(PolygonFault, ManyCornersAreChecked) {
  // A gear of 4000 corners is simple; with one corner pulled across it is not. It takes no time to speak of.
  std::vector<Vec2> gear;
  const int n = 4000;
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * 3.14159265358979 * k / n, r = k % 2 ? 1 : 0.9;
    gear.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  const std::clock_t start = std::clock();  // of this process: others do not count
  EXPECT_EQ(polygonFault(gear), "");
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 1);
  gear[500] = {-1.2, 0};
  EXPECT_NE(polygonFault(gear).find("crosses"), std::string::npos);
}

}  // namespace
}  // namespace smokebox
