// The oracle against rational arithmetic, on scenes of small whole numbers, where tangents, rims, edges and ties
// abound, and on placements that round.

#include <gtest/gtest.h>

#include "accel/random.h"
#include "cpu/reference_tracer.h"
#include "tests/unit/exact_world.h"

namespace rayengine {
namespace {

constexpr int rays_each = 2500, few_rays = 500;

struct Solid {
  std::string name;
  QuadricShape shape;
};

std::vector<Solid> solids() {
  std::vector<Solid> all;
  for (std::size_t i = 0; i + 1 < quadric_type_count; ++i) {
    const auto type = static_cast<QuadricType>(i);
    all.push_back({std::string(to_string(type)), {.type = type}});
    if (type >= QuadricType::cylinder && type <= QuadricType::hyperboloid2)
      all.push_back({all.back().name + "_capped", {.type = type, .capped = true}});
  }
  all.push_back({"general",
                 {.type = QuadricType::general,
                  .matrix = QuadricMatrix{1, .5, 0, 0, 2, 0, .5, 3, 0, -4},
                  .box = Box{{-1, -1, -1}, {1, 2, .5}}}});
  return all;
}

/// Whole multiples of `step` up to `most` of either sign.
glm::dvec3 grid_point(Random& random, double step, int most) {
  const auto one = [&] { return step * std::round(random.between(-most - .5, most + .5)); };
  return {one(), one(), one()};
}

/// Through a point at quarters near the origin.
Ray small_ray(std::uint64_t i) {
  Random random(11, i);
  Ray ray{{0, 0, 0}, -infinity, {0, 0, 0}, infinity};
  while (ray.direction == glm::dvec3(0)) ray.direction = grid_point(random, 1, 9);
  ray.origin = grid_point(random, .25, 5) - std::round(random.between(1, 4)) * ray.direction;
  return ray;
}

std::vector<Hit> all(Tracer& tracer, const Ray& ray) { return tracer.all({&ray, 1}).hits; }

/// The same hits in the same order, each t the nearest double.
void expect_exact(const std::vector<Hit>& hits, const std::vector<test::Place>& places) {
  ASSERT_EQ(hits.size(), places.size());
  for (std::size_t k = 0; k < hits.size(); ++k) {
    EXPECT_EQ(hits[k].primitive, places[k].primitive);
    EXPECT_TRUE(test::is_nearest_double(hits[k].t, places[k])) << "t = " << hits[k].t;
  }
}

/// A ray cut at its first place as a double: the hit at tmin is out, the one at tmax is in, whatever doubles make of
/// it.
void expect_exact_ends(Tracer& tracer, Ray ray, const std::vector<test::Place>& places) {
  if (places.empty()) return;
  const double t = all(tracer, ray).front().t;  // the nearest double, on either side of the place
  ray.tmin = t;
  const bool beyond = places.front().compare(t, 1) > 0;
  const std::vector<Hit> later = all(tracer, ray);
  EXPECT_EQ(!later.empty() && later.front().t == t && later.front().primitive == places.front().primitive, beyond);
  ray.tmin = -infinity, ray.tmax = t;
  EXPECT_EQ(!all(tracer, ray).empty(), !beyond);
}

class ReferenceExactly : public testing::TestWithParam<Solid> {
 protected:
  static std::shared_ptr<const Geometry> placed(const Affine& map) {
    GeometryBuilder builder;
    builder.add(GetParam().shape, 0, map);
    return builder.build();
  }

  static void run(const Affine& map) {
    const auto geometry = placed(map);
    const auto tracer = make_reference_tracer(geometry);
    std::size_t met = 0;
    for (std::uint64_t i = 0; i < rays_each; ++i) {
      const Ray ray = small_ray(i);
      SCOPED_TRACE("ray " + std::to_string(i));
      const std::vector<test::Place> places = test::exact_hits(ray, *geometry, geometry->quadrics[0]);
      expect_exact(all(*tracer, ray), places);
      if (HasFatalFailure()) return;
      met += !places.empty();
    }
    EXPECT_GT(met, 100u) << "too few hits to prove anything";
    const bool endless = GetParam().shape.type == QuadricType::plane;
    EXPECT_TRUE(endless || met < rays_each - 100u) << "too few misses to prove anything";
  }
};
INSTANTIATE_TEST_SUITE_P(Quadrics, ReferenceExactly, testing::ValuesIn(solids()),
                         [](const auto& info) { return info.param.name; });

TEST_P(ReferenceExactly, WholeNumbers) { run({}); }
TEST_P(ReferenceExactly, PlacedWithRounding) {
  run(Affine::translate({.1, -.2, .3}) * Affine::rotate({1, 2, 3}, 40) * Affine::scale({1.5, 1, .7}));
}

TEST_P(ReferenceExactly, EndsOfTheInterval) {
  for (const Affine& map : {Affine{}, Affine::rotate({1, 2, 3}, 40)}) {
    const auto geometry = placed(map);
    const auto tracer = make_reference_tracer(geometry);
    for (std::uint64_t i = 0; i < few_rays; ++i)
      expect_exact_ends(*tracer, small_ray(i), test::exact_hits(small_ray(i), *geometry, geometry->quadrics[0]));
  }
}

/// Triangles with corners at halves, so that rays pass edges and vertices, lie in planes, and meet several at once.
std::shared_ptr<const Geometry> many_triangles() {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 60; ++i) {
    Random random(5, i);
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(grid_point(random, .25, 8));
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    if (i > 0) mesh.triangles.push_back({3 * i, 3 * i - 1, 3 * i - 2});
  }
  GeometryBuilder builder;
  builder.add(mesh);
  return builder.build();
}

TEST(ReferenceExactly, TrianglesOfWholeNumbers) {
  const auto geometry = many_triangles();
  const auto tracer = make_reference_tracer(geometry);
  std::size_t ties = 0;
  for (std::uint64_t i = 0; i < few_rays; ++i) {
    SCOPED_TRACE("ray " + std::to_string(i));
    const Ray ray = small_ray(i);
    const std::vector<test::Place> places = test::exact_hits(ray, *geometry);
    const std::vector<Hit> hits = all(*tracer, ray);
    expect_exact(hits, places);
    ASSERT_FALSE(HasFatalFailure());
    for (std::size_t k = 1; k < places.size(); ++k) {
      const bool tie = places[k - 1].compare(places[k]) == 0;
      EXPECT_EQ((hits[k - 1].status & status_tie) && (hits[k].status & status_tie) && hits[k - 1].t == hits[k].t, tie)
          << "hit " << k;
      ties += tie;
    }
  }
  EXPECT_GT(ties, 100u);
}

TEST(ReferenceExactly, EndsOfTheIntervalOnTriangles) {
  const auto geometry = many_triangles();
  const auto tracer = make_reference_tracer(geometry);
  for (std::uint64_t i = 0; i < few_rays; ++i)
    expect_exact_ends(*tracer, small_ray(i), test::exact_hits(small_ray(i), *geometry));
}

}  // namespace
}  // namespace rayengine
