#include "engine/load/polygon.h"

#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "tests/load/loading.h"

namespace rayengine {
namespace {

using Polygon = std::vector<glm::dvec3>;

Polygon flat(std::initializer_list<std::array<double, 2>> points) {
  Polygon polygon;
  for (const auto& [x, y] : points) polygon.emplace_back(x, y, 0);
  return polygon;
}

/// A gear: teeth outward, so that half the corners are not convex.
Polygon gear(int corners, double inner) {
  Polygon polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * M_PI * i / corners, radius = i / 2 % 2 ? 1 : inner;
    polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return polygon;
}

/// How often the triangles, and how often the outline itself, go round a point in the plane z = 0.
int winding(const Polygon& p, const std::vector<std::uint32_t>& ring, double x, double y) {
  int count = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const glm::dvec3 &a = p[ring[i]], &b = p[ring[(i + 1) % ring.size()]];
    const double side = (b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y);
    if (a.y <= y && b.y > y && side > 0) ++count;
    if (a.y > y && b.y <= y && side < 0) --count;
  }
  return count;
}

/// Every triangle turns as the polygon does, and each point is in as many triangles as the outline goes round it.
void expect_tiling(const Polygon& p) {
  const auto triangles = triangulate(p);
  ASSERT_EQ(triangles.size(), p.size() - 2);
  std::vector<std::uint32_t> outline(p.size());
  for (std::uint32_t i = 0; i < p.size(); ++i) outline[i] = i;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1.2, 1.2);
  for (int k = 0; k < 200; ++k) {
    const double x = coordinate(random), y = coordinate(random);
    int covered = 0;
    for (const glm::uvec3& t : triangles) {
      const int once = winding(p, {t.x, t.y, t.z}, x, y);
      ASSERT_GE(once, 0) << "a triangle is turned over";
      covered += once;
    }
    ASSERT_EQ(covered, winding(p, outline, x, y)) << x << " " << y;
  }
}

TEST(Polygon, ATriangleIsItself) {
  EXPECT_EQ(triangulate(flat({{0, 0}, {1, 0}, {0, 1}})), std::vector{glm::uvec3(0, 1, 2)});
}

TEST(Polygon, AConvexOneIsAFanAboutItsFirstVertex) {
  EXPECT_EQ(triangulate(flat({{0, 0}, {1, 0}, {1, 1}, {0, 1}})),
            (std::vector{glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}));
}

TEST(Polygon, ConcaveOnesAreTiled) {
  expect_tiling(flat({{0, 0}, {1, -1}, {0, 1}, {-1, -1}}));                                                   // a dart
  expect_tiling(flat({{-1, -1}, {1, -1}, {1, 1}, {0.5, 1}, {0.5, -0.5}, {-0.5, -0.5}, {-0.5, 1}, {-1, 1}}));  // a U
  expect_tiling(gear(144, 0.8));
  expect_tiling(gear(144, 0.1));
}

TEST(Polygon, FacesWhereItsOutlineTurns) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) {
      Polygon polygon;
      for (const glm::dvec3& p : gear(16, 0.5)) {
        glm::dvec3 turned(0);
        turned[(axis + 1) % 3] = p.x, turned[(axis + 2) % 3] = side * p.y;
        polygon.push_back(turned);
      }
      for (const glm::uvec3& t : triangulate(polygon))
        EXPECT_GE(side * glm::cross(polygon[t.y] - polygon[t.x], polygon[t.z] - polygon[t.x])[axis], 0);
    }
}

TEST(Polygon, CornersOnAStraightSideAreKept) {
  expect_tiling(flat({{-1, -1}, {0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}}));
}

TEST(Polygon, AHoleJoinedByABridgeStaysOpen) {
  const Polygon ring = flat(
      {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}, {-0.5, -0.5}, {-0.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}, {-0.5, -0.5}});
  expect_tiling(ring);
}

TEST(Polygon, RandomStarsAreTiled) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(0.05, 1);
  for (int size = 4; size < 60; ++size) {
    Polygon star;
    for (int i = 0; i < size; ++i) {
      const double angle = 2 * M_PI * i / size, r = radius(random);
      star.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
    }
    expect_tiling(star);
  }
}

TEST(Polygon, WhatHasNoAnswerStillEnds) {
  EXPECT_EQ(triangulate(flat({{0, 0}, {1, 1}, {1, 0}, {0, 1}})).size(), 2u);          // a bow tie
  EXPECT_EQ(triangulate(flat({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {1, 0}})).size(), 3u);  // a line
  EXPECT_EQ(triangulate(Polygon(10, glm::dvec3(1, 2, 3))).size(), 8u);                // a point
  EXPECT_EQ(triangulate(Polygon{{1e300, 0, 0}, {0, 1e300, 0}, {-1e300, 0, 0}, {0, -1e300, 0}, {1e300, 1, 0}}).size(),
            3u);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  Polygon tangle;
  for (int i = 0; i < 2000; ++i) tangle.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  EXPECT_EQ(triangulate(tangle).size(), 1998u);
}

TEST(Polygon, TheLargestConcaveOneIsCutInSeconds) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(triangulate(gear(20000, 0.9)).size(), 19998u);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
  const std::string message = test::error_of([] { triangulate(gear(largest_concave_polygon + 4, 0.9)); });
  EXPECT_EQ(message, "a polygon that is not convex has 65540 vertices; cut it into pieces of at most 65536");
}

TEST(Polygon, ALargeConvexOneIsAFan) {
  Polygon circle;
  for (int i = 0; i < 100000; ++i) circle.emplace_back(std::cos(2 * M_PI * i / 1e5), std::sin(2 * M_PI * i / 1e5), 0);
  EXPECT_EQ(triangulate(circle).size(), 99998u);
}

}  // namespace
}  // namespace rayengine
