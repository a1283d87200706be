// The kernels, in single and in double precision, against the oracle's formulas. `u` is the unit round-off throughout.

#include "accel/kernels/kernels.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "accel/geometry.h"
#include "accel/random.h"
#include "cpu/reference/quadric.h"
#include "cpu/reference/triangle.h"

namespace rayengine {
namespace {

using reference::quad;

template <class REAL>
class KernelsOf : public testing::Test {
 public:
  static constexpr double u = std::numeric_limits<REAL>::epsilon() / 2;
  using Vec = kernels::Vec3<REAL>;

  static Vec vec(const glm::dvec3& v) {
    return {static_cast<REAL>(v.x), static_cast<REAL>(v.y), static_cast<REAL>(v.z)};
  }
  /// Rounded to what the kernel sees, so that the oracle gets the same numbers.
  static glm::dvec3 seen(const glm::dvec3& v) {
    const Vec r = vec(v);
    return {r.x, r.y, r.z};
  }
  static glm::dvec3 in_cube(Random& random, double size) {
    return seen({random.between(-size, size), random.between(-size, size), random.between(-size, size)});
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(KernelsOf, Reals);

// ---- triangles

template <class REAL>
struct TriangleAnswer {
  REAL t, u, v;
  kernels::Mask<REAL> hit;
};

template <class REAL>
TriangleAnswer<REAL> ask(kernels::Vec3<REAL> o, kernels::Vec3<REAL> d, kernels::Vec3<REAL> a, kernels::Vec3<REAL> b,
                         kernels::Vec3<REAL> c) {
  TriangleAnswer<REAL> answer;
  kernels::triangle(o, d, a, b, c, answer.t, answer.u, answer.v, answer.hit);
  return answer;
}

std::shared_ptr<const Geometry> triangles(std::vector<glm::dvec3> corners, std::vector<glm::uvec3> indices) {
  GeometryBuilder builder;
  builder.add(Mesh{std::move(corners), {}, std::move(indices)});
  return builder.build();
}

/// The least distance of the triangle's edges' lines from the ray, seen along it.
double distance_from_edges(const Ray& ray, const std::array<glm::dvec3, 3>& k) {
  double least = infinity;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 edge = k[(i + 1) % 3] - k[i], across = glm::cross(ray.direction, edge);
    least = std::min(least, std::abs(glm::dot(across, k[i] - ray.origin)) / glm::length(across));
  }
  return least;
}

TYPED_TEST(KernelsOf, TriangleDecidesRightlyAndItsTIsWithinTheBound) {
  int hits = 0, unsure = 0;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    Random random(1, i);
    const std::array<glm::dvec3, 3> k{this->in_cube(random, 1), this->in_cube(random, 1), this->in_cube(random, 1)};
    const glm::dvec3 normal = glm::cross(k[1] - k[0], k[2] - k[0]);
    const glm::dvec3 origin = this->in_cube(random, 4);
    const Ray ray{origin, 0, this->seen(this->in_cube(random, 1) - origin), infinity};
    const double longest = std::max({glm::length(k[1] - k[0]), glm::length(k[2] - k[1]), glm::length(k[0] - k[2])});
    const double slenderness = longest * longest / glm::length(normal);
    const double bound = 32 * this->u * 8 * slenderness;  // coordinates are below 8
    const double slope = std::abs(glm::dot(glm::normalize(normal), ray.direction));

    const auto geometry = triangles({k[0], k[1], k[2]}, {{0, 1, 2}});
    const auto exact = reference::cross_triangle(reference::LocalRay(ray), *geometry, 0);
    const auto answer = ask<TypeParam>(this->vec(ray.origin), this->vec(ray.direction), this->vec(k[0]),
                                       this->vec(k[1]), this->vec(k[2]));
    if (static_cast<bool>(answer.hit) != exact.has_value()) {
      ASSERT_LT(distance_from_edges(ray, k), bound) << "ray " << i;
      ++unsure;
    } else if (exact && slope > 4 * bound) {
      ++hits;
      ASSERT_NEAR(answer.t, static_cast<double>(exact->t), bound / slope * 2) << "ray " << i;
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_LT(unsure, 20);
}

TYPED_TEST(KernelsOf, TriangleNeighboursLeaveNoGap) {
  int both = 0;
  for (std::uint64_t i = 0; i < 100000; ++i) {
    Random random(2, i);
    const glm::dvec3 a = this->in_cube(random, 1), b = this->in_cube(random, 1), o = this->in_cube(random, 4);
    const glm::dvec3 d = this->seen(a + random.unit() * (b - a) - o);
    // The apexes lie on either side of the plane through the edge and the ray.
    const glm::dvec3 side = glm::cross(d, b - a) / glm::length(glm::cross(d, b - a));
    const glm::dvec3 left = this->seen(0.5 * (a + b) + side), right = this->seen(0.5 * (a + b) - side);
    const auto ask_with = [&](const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& r) {
      return static_cast<bool>(
          ask<TypeParam>(this->vec(o), this->vec(d), this->vec(p), this->vec(q), this->vec(r)).hit);
    };
    const bool first = ask_with(a, b, left), second = ask_with(b, a, right);
    ASSERT_TRUE(first || second) << "ray " << i;
    both += first && second;
  }
  EXPECT_LT(both, 5000);
}

TYPED_TEST(KernelsOf, TriangleMissesWhatHasNoAreaOrIsSeenEdgeOn) {
  const auto v = [this](double x, double y, double z) { return this->vec({x, y, z}); };
  EXPECT_FALSE(ask<TypeParam>(v(.25, .25, 1), v(0, 0, -1), v(0, 0, 0), v(0, 0, 0), v(1, 1, 0)).hit);
  EXPECT_FALSE(ask<TypeParam>(v(1, 1, 1), v(0, 0, -1), v(0, 0, 0), v(1, 1, 0), v(2, 2, 0)).hit);
  EXPECT_FALSE(ask<TypeParam>(v(-1, .5, 0), v(1, 0, 0), v(0, 0, 0), v(1, 0, 0), v(0, 1, 0)).hit);
  const TypeParam nan = std::numeric_limits<TypeParam>::quiet_NaN();
  EXPECT_FALSE(ask<TypeParam>(v(.25, .25, 1), v(0, 0, -1), v(0, 0, 0), v(1, 0, nan), v(0, 1, 0)).hit);
}

// ---- quadrics

/// Roots along the ray by the kernels, for any matrix.
template <class REAL>
std::array<REAL, 2> roots(const QuadricMatrix& m, kernels::Vec3<REAL> o, kernels::Vec3<REAL> d) {
  std::array<REAL, 10> q;
  std::copy(m.begin(), m.end(), q.begin());
  kernels::Vec3<REAL> p;
  REAL s, a, b, c, near, far;
  kernels::approach(o, d, p, s);
  kernels::general_coefficients(q[0], q[1], q[2], q[3], q[4], q[5], q[6], q[7], q[8], q[9], p, d, a, b, c);
  kernels::roots(a, b, c, near, far);
  const REAL none = std::numeric_limits<REAL>::max();
  return {near == none ? none : s + near, far == none ? none : s + far};
}

/// The same of a ball or an infinite cylinder by the kernels of their own.
template <class REAL>
std::array<REAL, 2> round_roots(QuadricType type, kernels::Vec3<REAL> o, kernels::Vec3<REAL> d) {
  const bool ball = type == QuadricType::sphere;
  REAL dd, near, far;
  const REAL under_root = kernels::round_discriminant(ball, o, d, dd);
  kernels::round_roots(ball, o, d, dd, under_root, near, far);
  return {near, far};
}

std::shared_ptr<const Geometry> unclipped(const QuadricMatrix& matrix) {
  GeometryBuilder builder;
  builder.add(QuadricShape{QuadricType::general, false, {}, matrix, {}});
  return builder.build();
}

std::vector<quad> exact_roots(const Ray& ray, const Geometry& geometry) {
  std::vector<quad> result;
  for (const auto& c : reference::cross_quadric(reference::LocalRay(ray), geometry, geometry.quadrics[0]))
    result.push_back(c.t);
  std::sort(result.begin(), result.end());
  return result;
}

const std::vector<QuadricMatrix>& matrices() {
  static const auto all = [] {
    std::vector<QuadricMatrix> m;
    for (std::size_t i = 0; i + 1 < quadric_type_count; ++i) m.push_back(unit_matrix(static_cast<QuadricType>(i)));
    m.push_back({1, .25, -.5, .125, .75, .375, -1, -.5, .25, -.625});
    return m;
  }();
  return all;
}

/// Half the gradient's slope along the ray at t, and the size of the quadric form's terms about the closest approach.
struct Conditioning {
  double slope, size;
};

Conditioning conditioning(const QuadricMatrix& m, const Ray& ray, double t) {
  const glm::dvec3 p = ray.at(t),
                   g{m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[1] * p.x + m[4] * p.y + m[5] * p.z + m[6],
                     m[2] * p.x + m[5] * p.y + m[7] * p.z + m[8]};
  double entries = 0;
  for (const double a : m) entries = std::max(entries, std::abs(a));
  const double reach = 1 + glm::length(ray.origin);
  return {std::abs(glm::dot(g, ray.direction)), entries * reach * reach};
}

/// Holds roots(origin, direction) along 3000 rays against the exact ones of a quadric.
template <class REAL, class Roots>
void expect_roots_within_the_bound(const QuadricMatrix& m, std::uint64_t seed, const Roots& roots) {
  using Of = KernelsOf<REAL>;
  const auto geometry = unclipped(m);
  int roots_seen = 0, unsure = 0;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    Random random(seed, i);
    const glm::dvec3 origin = Of::in_cube(random, 4), direction = Of::in_cube(random, 1.5) - origin;
    const Ray ray{origin, -infinity, Of::seen(glm::normalize(direction)), infinity};
    const std::vector<quad> exact = exact_roots(ray, *geometry);
    const auto found = roots(Of::vec(ray.origin), Of::vec(ray.direction));
    const auto count =
        static_cast<std::size_t>(std::count_if(found.begin(), found.end(), [](REAL t) { return std::abs(t) < 1e30; }));
    if (count != exact.size()) {
      ++unsure;
      continue;
    }
    for (std::size_t k = 0; k < exact.size(); ++k) {
      const double t = static_cast<double>(exact[k]);
      const Conditioning at = conditioning(geometry->forms[0].matrix, ray, t);
      // Off by e in the form, a root is off by e over its slope; a root far away carries the rounding of t itself.
      const double form_error = 64 * Of::u * at.size * (1 + t * t / (1 + glm::dot(ray.origin, ray.origin)));
      if (at.slope * at.slope < 16 * form_error * at.size) continue;
      ++roots_seen;
      ASSERT_NEAR(found[k], t, form_error / at.slope + 8 * Of::u * (std::abs(t) + 8)) << "ray " << i;
    }
  }
  EXPECT_GT(roots_seen, 1000);
  EXPECT_LE(unsure, 6);
}

TYPED_TEST(KernelsOf, QuadricRootsAreWithinTheBoundForEveryType) {
  for (std::size_t type = 0; type < matrices().size(); ++type) {
    SCOPED_TRACE("type " + std::to_string(type));
    const QuadricMatrix& m = matrices()[type];
    expect_roots_within_the_bound<TypeParam>(m, 3 + type, [&](auto o, auto d) { return roots<TypeParam>(m, o, d); });
  }
}

TYPED_TEST(KernelsOf, RoundRootsAreWithinTheSameBound) {
  for (const QuadricType type : {QuadricType::sphere, QuadricType::cylinder}) {
    SCOPED_TRACE(to_string(type));
    expect_roots_within_the_bound<TypeParam>(unit_matrix(type), 3,
                                             [&](auto o, auto d) { return round_roots<TypeParam>(type, o, d); });
  }
}

/// Holds roots(origin, direction) of the unit sphere against the exact ones, from ten to ten thousand radii away.
template <class REAL, class Roots>
void expect_far_spheres_decided(const Roots& roots) {
  using Of = KernelsOf<REAL>;
  const auto geometry = unclipped(unit_matrix(QuadricType::sphere));
  for (const double distance : {1e1, 1e2, 1e3, 1e4}) {
    int wrong = 0, hits = 0;
    double worst = 0;
    const int count = 5000;
    for (int i = 0; i < count; ++i) {
      Random random(4, static_cast<std::uint64_t>(i));
      const glm::dvec3 origin = Of::seen(distance * random.direction());
      const glm::dvec3 aside = glm::normalize(glm::cross(origin, random.direction()));
      const double radius = 1.2 * std::sqrt(random.unit());
      const Ray ray{origin, 0, Of::seen(glm::normalize(radius * aside - origin)), infinity};
      const std::vector<quad> exact = exact_roots(ray, *geometry);
      const auto found = roots(Of::vec(ray.origin), Of::vec(ray.direction));
      wrong += (found[0] < 1e30) == exact.empty();
      if (exact.empty() || radius > 0.5) continue;
      ++hits;
      worst = std::max(worst, std::abs(found[0] - static_cast<double>(exact[0])));
    }
    // The shortest distance from the centre is known to a few u times the distance.
    EXPECT_LE(wrong, 16 * Of::u * distance * count) << "distance " << distance;
    EXPECT_LE(worst, 3 * Of::u * distance) << "distance " << distance;
    EXPECT_GT(hits, count / 10);
  }
}

TYPED_TEST(KernelsOf, FarSpheresAreDecidedAsWellAsTheMethodPromises) {
  const QuadricMatrix sphere = unit_matrix(QuadricType::sphere);
  expect_far_spheres_decided<TypeParam>([&](auto o, auto d) { return roots<TypeParam>(sphere, o, d); });
  expect_far_spheres_decided<TypeParam>(
      [](auto o, auto d) { return round_roots<TypeParam>(QuadricType::sphere, o, d); });
}

// ---- boxes

struct Slabs {
  quad enter, leave;
};

/// Textbook slabs, with the box grown by `pad`.
Slabs exact_slabs(const Box& box, const Ray& ray, double pad) {
  Slabs s{ray.tmin, ray.tmax};
  for (int i = 0; i < 3; ++i) {
    const quad lower = quad(box.lower[i]) - pad, upper = quad(box.upper[i]) + pad, o = ray.origin[i],
               d = ray.direction[i];
    if (d == 0) {
      if (o < lower || o > upper) return {1, 0};
      continue;
    }
    const quad a = (lower - o) / d, b = (upper - o) / d;
    s.enter = std::max(s.enter, std::min(a, b));
    s.leave = std::min(s.leave, std::max(a, b));
  }
  return s;
}

TYPED_TEST(KernelsOf, BoxIsNeverMissedAndNeverMuchTooWide) {
  int hits = 0, misses = 0;
  for (std::uint64_t i = 0; i < 50000; ++i) {
    Random random(5, i);
    Box box;
    box.add(this->in_cube(random, 1));
    box.add(this->in_cube(random, 1));
    Ray ray{this->in_cube(random, 3), 0, this->in_cube(random, 1),
            static_cast<double>(static_cast<TypeParam>(random.between(0, 20)))};
    const int axis = static_cast<int>(random.below(3));
    const std::size_t kind = random.below(4);
    if (kind == 0) ray.direction = this->seen(random.between(.1, 1) * (box.lower - ray.origin));  // through a corner
    if (kind == 1) ray.direction[axis] = random.below(2) ? 0.0 : -0.0;                            // along an axis
    if (kind == 2) ray.origin[axis] = box.upper[axis], ray.direction[axis] = 0;                   // in a face
    TypeParam enter, leave;
    kernels::box(this->vec(box.lower), this->vec(box.upper), this->vec(ray.origin), this->vec(ray.direction),
                 TypeParam(0), static_cast<TypeParam>(ray.tmax), static_cast<TypeParam>(1 + 8 * this->u), enter, leave);
    const bool hit = enter <= leave;
    const Slabs exact = exact_slabs(box, ray, 0), wide = exact_slabs(box, ray, 64 * this->u);
    ASSERT_TRUE(hit || exact.enter > exact.leave) << "missed, ray " << i;
    ASSERT_TRUE(!hit || wide.enter <= wide.leave * (1 + 16 * this->u)) << "too wide, ray " << i;
    ++(hit ? hits : misses);
  }
  EXPECT_GT(hits, 5000);
  EXPECT_GT(misses, 5000);
}

}  // namespace
}  // namespace rayengine
