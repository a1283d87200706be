#include "accel/walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "accel/isa/walk_kernel.h"
#include "accel/kernels/kernels.h"

using namespace rayengine;

namespace {

using Wide = __float128;

struct Stop {
  std::uint32_t treelet;
  double t;
};

/// What a test asks of a scene: its boxes as given, and what a walk may be judged by.
struct WalkScene {
  std::vector<TreeletPrimitive> primitives;
  Treelets treelets;
  std::vector<std::uint32_t> treelet_of;  ///< of each primitive; ids count through all

  WalkScene(std::vector<TreeletPrimitive> p, std::uint32_t K)
      : primitives(std::move(p)), treelet_of(primitives.size()) {
    treelets = build_treelets(primitives, K);
    for (std::uint32_t i = 0; i < treelets.treelets.size(); ++i)
      for (std::uint32_t k = 0; k < treelets.treelets[i].triangle_count; ++k)
        treelet_of[treelets.triangles[treelets.treelets[i].first_triangle + k]] = i;
  }
};

/// Clutter of all sizes between flat walls, some of no thickness.
std::vector<TreeletPrimitive> clutter(glm::dvec3 center, double scale) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
  std::vector<TreeletPrimitive> result;
  for (std::uint32_t i = 0; i < 600; ++i) {
    glm::dvec3 lower = point(), upper = lower + std::pow(0.5, i % 12) * glm::abs(point());
    if (i % 3 == 0) {  // on a wall of the lattice, flat
      const int axis = static_cast<int>(random() % 3);
      lower[axis] = upper[axis] = std::round(2 * lower[axis]) / 2;
    }
    result.push_back({{center + scale * lower, center + scale * upper}, TreeletPrimitive::triangle, i});
  }
  return result;
}

/// Where a ray is in a box, with 113 bits; false where it misses. Rays that only touch it are in it.
bool meets(const Ray& ray, const Box& box, double grown, Wide& enter) {
  enter = ray.tmin;
  Wide leave = std::min(ray.tmax, std::numeric_limits<double>::max());  // no hit can say more
  for (int i = 0; i < 3; ++i) {
    const Wide lower = Wide(box.lower[i]) - grown - ray.origin[i], upper = Wide(box.upper[i]) + grown - ray.origin[i];
    if (ray.direction[i] == 0) {
      if (lower > 0 || upper < 0) return false;
      continue;
    }
    const Wide a = lower / ray.direction[i], b = upper / ray.direction[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

std::vector<TreeletEntry> list(Isa isa, const Treelets& treelets, const Ray& ray, std::uint32_t capacity,
                               WalkCursor& cursor) {
  std::vector<TreeletEntry> entries(capacity);
  std::uint32_t count = ~0u;
  walk_with(isa, treelets, {&ray, 1}, {&cursor, 1}, capacity, entries, {&count, 1});
  EXPECT_LE(count, capacity);
  entries.resize(count);
  return entries;
}

std::vector<TreeletEntry> whole_list(Isa isa, const Treelets& treelets, const Ray& ray) {
  WalkCursor cursor;
  const auto entries = list(isa, treelets, ray, static_cast<std::uint32_t>(treelets.treelets.size()) + 1, cursor);
  EXPECT_TRUE(cursor.finished());
  return entries;
}

/// All that walk() promises of the list of one ray, but resuming.
void expect_right(Isa isa, const WalkScene& scene, const Ray& ray) {
  const auto entries = whole_list(isa, scene.treelets, ray);
  std::vector<double> entry_of(scene.treelets.treelets.size(), infinity);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    ASSERT_EQ(entry_of[entries[i].treelet], infinity) << "listed twice";
    entry_of[entries[i].treelet] = entries[i].t;
    ASSERT_GE(entries[i].t, ray.tmin);
    ASSERT_LE(entries[i].t, ray.tmax);
    ASSERT_GE(entries[i].t, entries[i > 0 ? i - 1 : 0].t);
  }
  std::vector<bool> needed(entry_of.size(), false);
  const double extent = 1 / scene.treelets.frame.scale;
  const double grown = extent * 0x1p-18 + 0x1p-46 * glm::length(ray.origin - scene.treelets.frame.center);
  std::vector<Box> boxes(entry_of.size());
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    Wide enter;
    boxes[scene.treelet_of[i]].add(scene.primitives[i].bounds);
    if (!meets(ray, scene.primitives[i].bounds, 0, enter)) continue;
    ASSERT_LE(Wide(entry_of[scene.treelet_of[i]]), enter) << "primitive " << i << ": its treelet is missing or late";
  }
  for (const TreeletEntry& e : entries) {
    if (e.t == infinity) continue;  // where no t can be told apart
    Wide enter;
    ASSERT_TRUE(meets(ray, boxes[e.treelet], grown, enter)) << "treelet " << e.treelet << " is far from the ray";
    ASSERT_GE(e.t, double(enter) * (1 - 1e-6) - 1e-9 * extent);
  }
}

std::vector<Isa> machine_isas() {
  std::vector<Isa> isas;
  for (const Isa isa : {Isa::sse2, Isa::avx2, Isa::avx512})
    if (isa <= best_isa()) isas.push_back(isa);
  return isas;
}

std::vector<Ray> random_rays(glm::dvec3 center, double scale, double distance, int count) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 away = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    const glm::dvec3 target(unit(random), unit(random), unit(random));
    const glm::dvec3 from = center + scale * distance * away;
    rays.push_back({from, 0, (center + scale * target - from) * std::exp(20 * unit(random)), infinity});
  }
  return rays;
}

class Walk : public testing::TestWithParam<Isa> {};

INSTANTIATE_TEST_SUITE_P(EveryIsa, Walk, testing::ValuesIn(machine_isas()), [](const auto& info) {
  return std::string(info.param == Isa::sse2 ? "sse2" : info.param == Isa::avx2 ? "avx2" : "avx512");
});

TEST_P(Walk, ListsAllThatRandomRaysMeet) {
  const WalkScene scene(clutter({}, 1), 8);
  for (const double distance : {0.0, 0.5, 3.0, 1e4, 1e7})
    for (const Ray& ray : random_rays({}, 1, distance, 200))
      ASSERT_NO_FATAL_FAILURE(expect_right(GetParam(), scene, ray));
}

TEST_P(Walk, StandsAnyPlaceAndScale) {
  for (const double scale : {1e-200, 1e-12, 1e12, 1e200}) {
    const glm::dvec3 center = scale * glm::dvec3(1e5, -3e5, 7);
    const WalkScene scene(clutter(center, scale), 8);
    for (const Ray& ray : random_rays(center, scale, 4, 100))
      ASSERT_NO_FATAL_FAILURE(expect_right(GetParam(), scene, ray));
  }
}

TEST_P(Walk, StandsDirectionsOfAnyLength) {
  const WalkScene scene(clutter({}, 1), 8);
  for (const Ray& ray : random_rays({}, 1, 3, 50)) {
    const auto expected = whole_list(GetParam(), scene.treelets, ray);
    for (const int exponent : {-990, -900, -30, 30, 900, 990}) {
      Ray longer = ray;
      longer.direction *= std::ldexp(1, exponent);
      const auto entries = whole_list(GetParam(), scene.treelets, longer);
      ASSERT_EQ(entries.size(), expected.size());
      for (std::size_t i = 0; i < entries.size(); ++i) {
        EXPECT_EQ(entries[i].treelet, expected[i].treelet);
        EXPECT_EQ(entries[i].t, std::ldexp(expected[i].t, -exponent));
      }
    }
  }
}

TEST_P(Walk, MissesNothingAlongAxesAndInPlanes) {
  const WalkScene scene(clutter({}, 1), 4);
  std::mt19937 random(2);
  std::uniform_int_distribution<int> lattice(-4, 4);
  for (int i = 0; i < 1000; ++i) {
    // Origins in the lattice's planes; directions with zeros of both signs, and with what is next to zero.
    Ray ray{0.5 * glm::dvec3(lattice(random), lattice(random), lattice(random)), 0, {}, infinity};
    const double nothing[] = {0.0, -0.0, 1e-320, -1e-320, 1e-30, -1e-30};
    for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = nothing[random() % 6];
    ray.direction[i % 3] = i & 1 ? 1 : -1;
    if (i % 5 == 0) ray.direction[(i + 1) % 3] = 1;
    if (i % 7 == 0) ray.origin[i % 3] -= 1e7 * ray.direction[i % 3];
    ASSERT_NO_FATAL_FAILURE(expect_right(GetParam(), scene, ray)) << i;
  }
}

TEST_P(Walk, MissesNothingFromFacesAndCornersOfBoxes) {
  const WalkScene scene(clutter({1e6, 0, -1e6}, 3), 4);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (std::size_t i = 0; i < scene.primitives.size(); i += 4) {
    const Box& box = scene.primitives[i].bounds;
    for (int corner = 0; corner < 8; ++corner) {
      Ray ray;
      for (int axis = 0; axis < 3; ++axis) ray.origin[axis] = corner >> axis & 1 ? box.upper[axis] : box.lower[axis];
      ray.direction = {unit(random), unit(random), unit(random)};
      if (corner & 1) ray.direction[corner % 3] = -0.0;
      ASSERT_NO_FATAL_FAILURE(expect_right(GetParam(), scene, ray));
    }
  }
}

TEST_P(Walk, KeepsToTheInterval) {
  const WalkScene scene(clutter({}, 1), 8);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1, 5);
  for (Ray ray : random_rays({}, 1, 2, 500)) {
    ray.direction = glm::normalize(ray.direction);
    ray.tmin = unit(random);
    ray.tmax = ray.tmin + std::max(0.0, unit(random));
    ASSERT_NO_FATAL_FAILURE(expect_right(GetParam(), scene, ray));
  }
  for (Ray ray : random_rays({}, 1, 2, 100)) {
    ray.tmin = -infinity;
    ASSERT_NO_FATAL_FAILURE(expect_right(GetParam(), scene, ray));
  }
}

TEST_P(Walk, GoesOnWhereItStopped) {
  const WalkScene scene(clutter({}, 1), 4);
  for (const double distance : {0.0, 3.0})
    for (const Ray& ray : random_rays({}, 1, distance, 200)) {
      const auto expected = whole_list(GetParam(), scene.treelets, ray);
      for (const std::uint32_t capacity : {1u, 3u}) {
        std::vector<TreeletEntry> pieces;
        for (WalkCursor cursor; !cursor.finished();) {
          const auto piece = list(GetParam(), scene.treelets, ray, capacity, cursor);
          EXPECT_TRUE(cursor.finished() || piece.size() == capacity);
          pieces.insert(pieces.end(), piece.begin(), piece.end());
        }
        ASSERT_EQ(pieces.size(), expected.size());
        for (std::size_t i = 0; i < pieces.size(); ++i) {
          EXPECT_EQ(pieces[i].treelet, expected[i].treelet);
          EXPECT_EQ(pieces[i].t, expected[i].t);
        }
      }
    }
}

TEST_P(Walk, StopsEarlierWhenTmaxIsLowered) {
  const WalkScene scene(clutter({}, 1), 4);
  for (Ray ray : random_rays({}, 1, 3, 200)) {
    const auto expected = whole_list(GetParam(), scene.treelets, ray);
    if (expected.size() < 4) continue;
    WalkCursor cursor;
    list(GetParam(), scene.treelets, ray, 2, cursor);
    ray.tmax = 0.5 * (expected[2].t + expected.back().t);
    const auto rest = list(GetParam(), scene.treelets, ray, 1000, cursor);
    EXPECT_TRUE(cursor.finished());
    ASSERT_LE(rest.size(), expected.size() - 2);
    for (std::size_t i = 0; i < rest.size(); ++i) EXPECT_EQ(rest[i].treelet, expected[i + 2].treelet);
    // Only what begins within rounding of the new end may go either way.
    for (std::size_t i = rest.size() + 2; i < expected.size(); ++i) EXPECT_GE(expected[i].t, ray.tmax * (1 - 1e-5));
  }
}

namespace {

void expect_as_each_alone(Isa isa, const WalkScene& scene, const std::vector<Ray>& rays) {
  constexpr std::uint32_t capacity = 5;
  std::vector<WalkCursor> cursors(rays.size());
  std::vector<TreeletEntry> lists(rays.size() * capacity);
  std::vector<std::uint32_t> counts(rays.size());
  for (bool again = true; again;) {
    const std::vector<WalkCursor> before = cursors;
    walk_with(isa, scene.treelets, rays, cursors, capacity, lists, counts);
    again = false;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      WalkCursor cursor = before[i];
      const auto alone = list(isa, scene.treelets, rays[i], capacity, cursor);
      ASSERT_EQ(counts[i], alone.size());
      ASSERT_EQ(cursors[i].last, cursor.last);
      again = again || !cursor.finished();
      for (std::uint32_t k = 0; k < counts[i]; ++k) {
        ASSERT_EQ(lists[i * capacity + k].treelet, alone[k].treelet);
        ASSERT_EQ(lists[i * capacity + k].t, alone[k].t);
      }
    }
  }
}

/// Bundles of 16 rays that start and run nearly alike, some of them dead or cut short.
std::vector<Ray> bundles(double spread) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  std::vector<Ray> rays;
  for (const Ray& leader : random_rays({}, 1, 2, 100)) {
    for (int k = 0; k < 16; ++k) {
      Ray ray = leader;
      ray.direction = glm::normalize(ray.direction);
      for (int axis = 0; axis < 3; ++axis) {
        ray.origin[axis] += spread * normal(random);
        ray.direction[axis] *= 1 + spread * normal(random);
      }
      if (random() % 10 == 0) ray.direction.y = std::nan("");
      if (random() % 10 == 0) ray.origin.z += 100;
      if (random() % 10 == 0) ray.tmax = 2;
      if (random() % 10 == 0) ray.tmin = 1.5;
      rays.push_back(ray);
    }
  }
  return rays;
}

}  // namespace

TEST_P(Walk, AnswersManyRaysAsItAnswersEach) {
  const WalkScene scene(clutter({}, 1), 8);
  expect_as_each_alone(GetParam(), scene, random_rays({}, 1, 2, 301));
}

TEST_P(Walk, AnswersRaysThatKeepTogetherAsItAnswersEach) {
  const WalkScene fine(clutter({}, 1), 2), coarse(clutter({}, 1), 64);
  for (const double spread : {0.0, 1e-6, 1e-3, 0.1})
    for (const WalkScene* scene : {&fine, &coarse})
      ASSERT_NO_FATAL_FAILURE(expect_as_each_alone(GetParam(), *scene, bundles(spread))) << spread;
}

TEST_P(Walk, AnswersRaysAlongAnAxisTogetherAsItAnswersEach) {
  const WalkScene scene(clutter({}, 1), 16);
  std::vector<Ray> rays;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) rays.push_back({{x / 32.0 - 1, y / 32.0 - 1, 3}, 0, {0, -0.0, -1}, infinity});
  expect_as_each_alone(GetParam(), scene, rays);
}

TEST_P(Walk, ListsAllThatIsMetByRaysThatMeetVeryMuch) {
  std::vector<TreeletPrimitive> row;
  for (std::uint32_t i = 0; i < 1500; ++i) row.push_back({{{i, 0, 0}, {i + 0.5, 1, 1}}, TreeletPrimitive::triangle, i});
  const WalkScene scene(std::move(row), 1);
  std::vector<Ray> apart, together;
  for (int k = 0; k < 64; ++k) {
    const double way = k % 2 ? 1 : -1, at = 0.1 + 0.01 * k;
    apart.push_back({{k % 2 ? -1.0 : 1501.0, at, at}, 0, {way, 1e-6 * k, 0}, k % 3 ? infinity : 20 + k});
    together.push_back({{-1, at, at}, 0, {1, 1e-6 * k, 0}, k % 3 ? infinity : 20 + k});
  }
  for (const auto& rays : {apart, together}) {
    ASSERT_NO_FATAL_FAILURE(expect_as_each_alone(GetParam(), scene, rays));
    for (int k = 0; k < 4; ++k)
      ASSERT_NO_FATAL_FAILURE(expect_right(GetParam(), scene, rays[static_cast<std::size_t>(k)]));
  }
}

TEST_P(Walk, OfInvalidRaysIsEmpty) {
  const WalkScene scene(clutter({}, 1), 8);
  const double nan = std::nan("");
  const Ray invalid[] = {{{nan, 0, 0}, 0, {1, 0, 0}, infinity},     {{0, infinity, 0}, 0, {0, 1, 0}, infinity},
                         {{0, 0, 0}, 0, {0, nan, 1}, infinity},     {{0, 0, 0}, 0, {0, 1, -infinity}, infinity},
                         {{0, 0, 0}, 0, {0, -0.0, 0}, infinity},    {{0, 0, 0}, 1, {1, 0, 0}, 0.5},
                         {{0, 0, 0}, nan, {1, 0, 0}, infinity},     {{0, 0, 0}, 0, {1, 0, 0}, nan},
                         {{0, 0, 0}, infinity, {1, 0, 0}, infinity}};
  for (const Ray& ray : invalid) EXPECT_TRUE(whole_list(GetParam(), scene.treelets, ray).empty());
}

TEST_P(Walk, StandsRaysAtTheEndsOfTheRange) {
  const WalkScene scene(clutter({}, 1), 8);
  for (const double far : {1e30, 1e100, 1e300})
    for (const double length : {1e-320, 1.0, 1e308}) {
      const Ray ray{{far, 0.1, 0.1}, 0, {-length, 0, 0}, infinity};
      ASSERT_NO_FATAL_FAILURE(expect_right(GetParam(), scene, ray)) << far << " " << length;
    }
}

TEST_P(Walk, OfASceneWithoutBoxesIsEmpty) {
  const Treelets none = build_treelets({}, 8);
  EXPECT_TRUE(whole_list(GetParam(), none, {{0, 0, 0}, -infinity, {1, 0, 0}, infinity}).empty());
}

}  // namespace
