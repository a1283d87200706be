#include <gtest/gtest.h>

#include <cmath>

#include "cpu/reference_tracer.h"

namespace rayengine {
namespace {

struct Crossing {
  double t;
  std::uint32_t primitive;
  glm::vec3 normal;
};

/// A quadric, a ray, and every crossing in order, worked out by hand.
struct Case {
  const char* name;
  QuadricShape shape;
  Affine to_world;
  Ray ray;
  std::vector<Crossing> crossings;
};

QuadricShape shape(QuadricType type) { return {type, false, {}, {}, {}}; }
QuadricShape capped(QuadricType type) { return {type, true, {}, {}, {}}; }
QuadricShape clipped(QuadricType type, double zmin, double zmax, bool caps = false) {
  return {type, caps, std::array{zmin, zmax}, {}, {}};
}
QuadricShape form(const QuadricMatrix& matrix, std::optional<Box> box = {}) {
  return {QuadricType::general, false, {}, matrix, box};
}
Ray ray(glm::dvec3 origin, glm::dvec3 direction, double tmin = 0, double tmax = infinity) {
  return {origin, tmin, direction, tmax};
}

std::unique_ptr<Tracer> tracer_of(const QuadricShape& quadric, const Affine& to_world = {}) {
  GeometryBuilder builder;
  builder.add(quadric, 0, to_world);
  return make_reference_tracer(builder.build());
}

std::unique_ptr<Tracer> tracer_of(const Mesh& mesh) {
  GeometryBuilder builder;
  builder.add(mesh);
  return make_reference_tracer(builder.build());
}

Hit closest(Tracer& tracer, const Ray& ray) {
  Hit hit;
  tracer.closest({&ray, 1}, {&hit, 1}, RayClass::primary);
  return hit;
}

bool any(Tracer& tracer, const Ray& ray) {
  std::uint32_t status = 77;
  tracer.any({&ray, 1}, {&status, 1}, RayClass::shadow);
  return status == status_hit;
}

std::vector<Hit> all(Tracer& tracer, const Ray& ray) { return tracer.all({&ray, 1}).hits; }

using enum QuadricType;
const double s2 = std::sqrt(0.5), s5 = std::sqrt(0.2);
const Affine ellipsoid = Affine::translate({1, 0, 0}) * Affine::scale({2, 4, 8});
const std::vector<Case> cases{
    {"sphere", shape(sphere), {}, ray({-3, 0, 0}, {1, 0, 0}), {{2, 0, {-1, 0, 0}}, {4, 0, {1, 0, 0}}}},
    {"sphere by a long direction",
     shape(sphere),
     {},
     ray({0, -3, 0}, {0, 4, 0}),
     {{.5, 0, {0, -1, 0}}, {1, 0, {0, 1, 0}}}},
    {"sphere from inside", shape(sphere), {}, ray({0, 0, 0}, {0, 0, 2}), {{.5, 0, {0, 0, 1}}}},
    {"sphere behind", shape(sphere), {}, ray({0, 0, 3}, {0, 0, 1}), {}},
    {"sphere, tangent", shape(sphere), {}, ray({-4, 1, 0}, {1, 0, 0}), {}},
    {"sphere, an ulp inside the tangent",
     shape(sphere),
     {},
     ray({-4, 1 - 0x1p-53, 0}, {1, 0, 0}),
     {{4 - 0x1p-26, 0, {-0x1p-26, 1, 0}}, {4 + 0x1p-26, 0, {0x1p-26, 1, 0}}}},
    {"sphere, an ulp outside the tangent", shape(sphere), {}, ray({-4, 1 + 0x1p-52, 0}, {1, 0, 0}), {}},
    {"sphere from far away",
     shape(sphere),
     {},
     ray({-0x1p60, 0, 0}, {0x1p60, 0, 0}),
     {{1, 0, {-1, 0, 0}}, {1, 0, {1, 0, 0}}}},
    {"sphere, from its surface outward", shape(sphere), {}, ray({1, 0, 0}, {1, 0, 0}), {}},
    {"sphere, from its surface inward", shape(sphere), {}, ray({1, 0, 0}, {-1, 0, 0}), {{2, 0, {-1, 0, 0}}}},
    {"sphere, clip is closed",
     clipped(sphere, -.5, 0),
     {},
     ray({-2, 0, 0}, {1, 0, 0}),
     {{1, 0, {-1, 0, 0}}, {3, 0, {1, 0, 0}}}},
    {"sphere, clipped away", clipped(sphere, -.5, 0), {}, ray({0, 0, -2}, {0, 0, 1}), {}},
    {"sphere, one root clipped", clipped(sphere, 0, 2), {}, ray({0, 0, -2}, {0, 0, 1}), {{3, 0, {0, 0, 1}}}},
    {"ellipsoid", shape(sphere), ellipsoid, ray({1, -8, 0}, {0, 1, 0}), {{4, 0, {0, -1, 0}}, {12, 0, {0, 1, 0}}}},
    {"cylinder", shape(cylinder), {}, ray({-2, 0, 1}, {1, 0, 0}), {{1, 0, {-1, 0, 0}}, {3, 0, {1, 0, 0}}}},
    {"cylinder, above its end", shape(cylinder), {}, ray({-2, 0, 1 + 0x1p-52}, {1, 0, 0}), {}},
    {"cylinder, open ends", shape(cylinder), {}, ray({.5, 0, -1}, {0, 0, 1}), {}},
    {"cylinder, caps", capped(cylinder), {}, ray({.5, 0, -1}, {0, 0, 1}), {{1, 1, {0, 0, -1}}, {2, 2, {0, 0, 1}}}},
    {"cylinder, in through a cap and out by the side",
     capped(cylinder),
     {},
     ray({0, 0, -.5}, {1, 0, 1}),
     {{.5, 1, {0, 0, -1}}, {1, 0, {1, 0, 0}}}},
    {"cylinder, along its wall", shape(cylinder), {}, ray({1, 0, -1}, {0, 0, 1}), {}},
    {"cylinder, mirrored and turned",
     capped(cylinder),
     Affine::scale({1, 1, -2}),
     ray({0, 0, 1}, {0, 0, -1}),
     {{1, 1, {0, 0, 1}}, {3, 2, {0, 0, -1}}}},
    {"cone", shape(cone), {}, ray({-2, 0, .5}, {1, 0, 0}), {{1.5, 0, {-s2, 0, -s2}}, {2.5, 0, {s2, 0, -s2}}}},
    {"cone, the other nappe is clipped", shape(cone), {}, ray({0, -1.5, -1}, {0, 1, 1}), {{1.25, 0, {0, -s2, -s2}}}},
    {"cone along its axis: only its cap",
     capped(cone),
     {},
     ray({.25, 0, 2}, {0, 0, -1}),
     {{1, 2, {0, 0, 1}}, {1.75, 0, {s2, 0, -s2}}}},
    {"cone, through the apex", capped(cone), {}, ray({0, 0, -1}, {0, 0, 1}), {{2, 2, {0, 0, 1}}}},
    {"frustum",
     clipped(cone, .5, 1, true),
     {},
     ray({.25, 0, 2}, {0, 0, -1}),
     {{1, 2, {0, 0, 1}}, {1.5, 1, {0, 0, -1}}}},
    {"both nappes",
     clipped(cone, -1, 1),
     {},
     ray({.5, 0, -2}, {0, 0, 1}),
     {{1.5, 0, {s2, 0, s2}}, {2.5, 0, {s2, 0, -s2}}}},
    {"paraboloid",
     shape(paraboloid),
     {},
     ray({-2, 0, .25}, {1, 0, 0}),
     {{1.5, 0, {-s2, 0, -s2}}, {2.5, 0, {s2, 0, -s2}}}},
    {"paraboloid along its axis",
     capped(paraboloid),
     {},
     ray({.5, 0, -1}, {0, 0, 1}),
     {{1.25, 0, {s2, 0, -s2}}, {2, 2, {0, 0, 1}}}},
    {"hyperboloid1", shape(hyperboloid1), {}, ray({-2, 0, 0}, {1, 0, 0}), {{1, 0, {-1, 0, 0}}, {3, 0, {1, 0, 0}}}},
    {"hyperboloid1, its rim",
     shape(hyperboloid1),
     {},
     ray({1.25, 0, -2}, {0, 0, 1}),
     {{1.25, 0, {1.25 / std::hypot(1.25, .75), 0, .75 / std::hypot(1.25, .75)}},
      {2.75, 0, {1.25 / std::hypot(1.25, .75), 0, -.75 / std::hypot(1.25, .75)}}}},
    {"hyperboloid1, caps",
     capped(hyperboloid1),
     {},
     ray({.5, 0, -2}, {0, 0, 1}),
     {{1, 1, {0, 0, -1}}, {3, 2, {0, 0, 1}}}},
    {"hyperboloid2",
     shape(hyperboloid2),
     {},
     ray({.75, 0, 3}, {0, 0, -1}),
     {{1.75, 0, {.6 / std::hypot(.6, 1), 0, -1 / std::hypot(.6, 1)}},
      {4.25, 0, {.6 / std::hypot(.6, 1), 0, 1 / std::hypot(.6, 1)}}}},
    {"hyperboloid2, capped",
     capped(hyperboloid2),
     {},
     ray({0, 0, -3}, {0, 0, 1}),
     {{1, 1, {0, 0, -1}}, {2, 0, {0, 0, 1}}, {4, 0, {0, 0, -1}}, {5, 2, {0, 0, 1}}}},
    {"saddle", shape(saddle), {}, ray({.5, 0, 1}, {0, 0, -1}), {{.75, 0, {s2, 0, -s2}}}},
    {"saddle, beyond its box", shape(saddle), {}, ray({1.25, 1, 1}, {0, 0, -1}), {}},
    {"saddle, the box is closed", shape(saddle), {}, ray({1, 1, 1}, {0, 0, -1}), {{1, 0, {2. / 3, -2. / 3, -1. / 3}}}},
    {"saddle, clipped", clipped(saddle, -1, .125), {}, ray({.5, 0, 1}, {0, 0, -1}), {}},
    {"plane", shape(plane), {}, ray({1e9, -7, 3}, {1, 1, -2}), {{1.5, 0, {0, 0, 1}}}},
    {"plane, in parallel", shape(plane), {}, ray({0, 0, 1}, {1, 0, 0}), {}},
    {"plane, within it", shape(plane), {}, ray({0, 0, 0}, {1, 0, 0}), {}},
    {"disk", shape(disk), Affine::scale({4, 2, 1}), ray({3, 1, 1}, {0, 0, -1}), {{1, 0, {0, 0, 1}}}},
    {"disk, its rim", shape(disk), {}, ray({1, 0, 1}, {0, 0, -1}), {{1, 0, {0, 0, 1}}}},
    {"disk, beyond its rim", shape(disk), {}, ray({1 + 0x1p-52, 0, 1}, {0, 0, -1}), {}},
    {"general sphere of radius 5",
     form({1, 0, 0, 0, 1, 0, 0, 1, 0, -25}),
     {},
     ray({-8, 3, 0}, {1, 0, 0}),
     {{4, 0, {-.8, .6, 0}}, {12, 0, {.8, .6, 0}}}},
    {"general, cut by a box",
     form({1, 0, 0, 0, 1, 0, 0, 1, 0, -25}, Box{{0, -9, -9}, {4, 9, 9}}),
     {},
     ray({-8, 3, 0}, {1, 0, 0}),
     {{12, 0, {.8, .6, 0}}}},
    {"general with mixed terms: xy = 1",
     form({0, .5, 0, 0, 0, 0, 0, 0, 0, -1}),
     {},
     ray({0, .5, 0}, {1, 0, 0}),
     {{2, 0, {s5 / 2 / std::hypot(s5 / 2, 2 * s5), 2 * s5 / std::hypot(s5 / 2, 2 * s5), 0}}}},
    {"general: a plane by its linear terms",
     form({0, 0, 0, 0, 0, 0, 0, 0, 1, -1}),
     {},
     ray({0, 0, 2}, {0, 0, -1}),
     {{1.5, 0, {0, 0, 1}}}},
    {"general: a pair of planes",
     form({1, 0, 0, 0, 0, 0, 0, 0, 0, -1}),
     {},
     ray({-3, 0, 0}, {1, 0, 0}),
     {{2, 0, {-1, 0, 0}}, {4, 0, {1, 0, 0}}}},
    {"general: a double plane is tangent everywhere",
     form({1, 0, 0, 0, 0, 0, 0, 0, 0, 0}),
     {},
     ray({-3, 0, 0}, {1, 0, 0}),
     {}},
    {"general: imaginary", form({1, 0, 0, 0, 1, 0, 0, 1, 0, 1}), {}, ray({-3, 0, 0}, {1, 0, 0}), {}},
    {"general: all zero", form({}), {}, ray({-3, 0, 0}, {1, 0, 0}), {}},
};

void expect_crossing(const Hit& hit, const Crossing& expected) {
  EXPECT_LE(std::abs(hit.t - expected.t), hit.error + 0x1p-52 * std::abs(expected.t));
  EXPECT_GT(hit.error, 0);
  EXPECT_LE(hit.error, 0x1p-52 * std::abs(hit.t));
  EXPECT_EQ(hit.primitive, expected.primitive);
  EXPECT_EQ(hit.object, 0u);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(hit.normal[i], expected.normal[i], 1e-6) << "normal " << i;
}

TEST(Reference, QuadricsAgreeWithCasesWorkedOutByHand) {
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const auto tracer = tracer_of(c.shape, c.to_world);
    const std::vector<Hit> hits = all(*tracer, c.ray);
    ASSERT_EQ(hits.size(), c.crossings.size());
    for (std::size_t i = 0; i < hits.size(); ++i) expect_crossing(hits[i], c.crossings[i]);
    EXPECT_EQ(any(*tracer, c.ray), !c.crossings.empty());
    const Hit first = closest(*tracer, c.ray);
    EXPECT_EQ(first.hit(), !c.crossings.empty());
    if (first.hit()) expect_crossing(first, c.crossings.front());
  }
}

TEST(Reference, EveryQuadricTypeHasACaseThatHitsAndOneThatMisses) {
  for (std::size_t i = 0; i < quadric_type_count; ++i) {
    bool hits = false;
    for (const Case& c : cases) hits = hits || (static_cast<std::size_t>(c.shape.type) == i && !c.crossings.empty());
    EXPECT_TRUE(hits) << to_string(static_cast<QuadricType>(i));
  }
}

TEST(Reference, IntervalsAreOpenBelowAndClosedAbove) {
  const auto tracer = tracer_of(shape(sphere));
  EXPECT_EQ(closest(*tracer, ray({-3, 0, 0}, {1, 0, 0}, 2)).t, 4);
  EXPECT_EQ(closest(*tracer, ray({-3, 0, 0}, {1, 0, 0}, 0, 2)).t, 2);
  EXPECT_FALSE(closest(*tracer, ray({-3, 0, 0}, {1, 0, 0}, 0, 2 - 0x1p-52)).hit());
  EXPECT_FALSE(closest(*tracer, ray({-3, 0, 0}, {1, 0, 0}, 4)).hit());
  EXPECT_EQ(closest(*tracer, ray({3, 0, 0}, {1, 0, 0}, -infinity)).t, -4);
  EXPECT_FALSE(closest(*tracer, ray({-3, 0, 0}, {1, 0, 0}, infinity, infinity)).hit());
}

TEST(Reference, ThePlanetOfTheStabilitySuite) {
  const double r = 6371000;
  const auto tracer = tracer_of(form({1, 0, 0, 0, 1, 0, 0, 1, 0, -r * r}));
  const double angle[]{0, .5, 1, 1.4}, expected[]{2, 2.278988, 3.701633, 11.767042};
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(closest(*tracer, ray({0, 0, r + 2}, {std::sin(angle[i]), 0, -std::cos(angle[i])})).t, expected[i],
                1e-6);
}

TEST(Reference, NearlyAxisParallelRaysInACylinder) {
  const auto tracer = tracer_of(clipped(cylinder, -1e7, 1e7));
  for (double e = 1e-1; e > 1e-7; e /= 10) {
    const double exact = .5 * std::sqrt(1 + e * e) / e;  // the wall is half a unit away
    const double length = std::sqrt(1 + e * e);
    const Hit hit = closest(*tracer, ray({.5, 0, 0}, {e / length, 0, 1 / length}));
    EXPECT_NEAR(hit.t, exact, 1e-12 * exact);
  }
}

TEST(Reference, InvalidRaysMissAndSaySo) {
  const double nan = std::nan("");
  const auto tracer = tracer_of(shape(sphere));
  for (const Ray& bad : {ray({nan, 0, 0}, {1, 0, 0}), ray({0, 0, 0}, {0, 0, 0}), ray({0, 0, 0}, {infinity, 0, 0}),
                         ray({0, 0, 0}, {1, 0, 0}, 2, 1), ray({0, 0, 0}, {1, 0, 0}, nan)}) {
    const Hit hit = closest(*tracer, bad);
    EXPECT_EQ(hit.status, status_invalid);
    EXPECT_EQ(hit.t, infinity);
    EXPECT_EQ(hit.object, no_id);
    std::uint32_t status = 0;
    tracer->any({&bad, 1}, {&status, 1}, RayClass::shadow);
    EXPECT_EQ(status, status_invalid);
    EXPECT_TRUE(all(*tracer, bad).empty());
  }
}

TEST(Reference, RefusesAnswersOfAnotherLengthThanTheRays) {
  const auto tracer = tracer_of(shape(sphere));
  std::vector<Ray> rays(2);
  std::vector<Hit> hits(1);
  EXPECT_THROW(tracer->closest(rays, hits, RayClass::primary), Error);
}

const Mesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {}, {{0, 1, 2}, {0, 2, 3}}};

TEST(Reference, TrianglesGiveBarycentricsAndTheCounterClockwiseNormal) {
  const auto tracer = tracer_of(square);
  const Hit hit = closest(*tracer, ray({.75, .25, 2}, {0, 0, -4}));
  EXPECT_EQ(hit.t, .5);
  EXPECT_EQ(hit.primitive, 0u);
  EXPECT_EQ(hit.u, .5f);
  EXPECT_EQ(hit.v, .25f);
  EXPECT_EQ(hit.normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(closest(*tracer, ray({.75, .25, -2}, {0, 0, 4})).normal, glm::vec3(0, 0, 1)) << "from behind";
}

TEST(Reference, ASharedEdgeIsATieThatTheLowestIdWins) {
  const auto tracer = tracer_of(square);
  const Ray on_edge = ray({0, 0, 1}, {1. / 3, 1. / 3, -1});
  EXPECT_EQ(closest(*tracer, on_edge).primitive, 0u);
  EXPECT_EQ(closest(*tracer, on_edge).status, status_hit | status_tie);
  EXPECT_FALSE(std::signbit(closest(*tracer, on_edge).u)) << "zero has one sign";
  EXPECT_EQ(all(*tracer, on_edge).size(), 2u) << "the square is no closed mesh";
  const Ray beside = ray({0, 0, 1}, {1. / 3, std::nextafter(1. / 3, 1.), -1});
  EXPECT_EQ(all(*tracer, beside).size(), 1u);
  EXPECT_EQ(closest(*tracer, beside).primitive, 1u);
  EXPECT_EQ(closest(*tracer, beside).status, status_hit);
}

/// Eight triangles, whose corners and edges lines from the centre can be aimed at without rounding.
const Mesh octahedron{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                      {},
                      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};

TEST(Reference, AllHitsOfAClosedMeshCountACrossingAtAnEdgeOrAVertexOnce) {
  const auto tracer = tracer_of(octahedron);
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const glm::dvec3 d(x, y, z);
        EXPECT_EQ(all(*tracer, ray({0, 0, 0}, d)).size(), 1u) << x << y << z;
        EXPECT_EQ(all(*tracer, ray(-3. * d, d)).size(), 2u) << x << y << z;
        // Past the body along its edges and corners: in and out again, or not at all.
        const glm::dvec3 aside(y, z, x);
        EXPECT_EQ(all(*tracer, ray(aside - 3. * d, d)).size() % 2, 0u) << x << y << z;
      }
}

TEST(Reference, TiltedNeighboursAreHitAtExactlyTheSameT) {
  // A ray from the world's origin along a corner's coordinates passes it without rounding.
  const Mesh roof{{{.1, .2, .3}, {1.7, .9, -.4}, {-.6, 1.3, .7}, {.8, -1.1, .45}}, {}, {{0, 1, 2}, {1, 0, 3}}};
  const auto tracer = tracer_of(roof);
  const std::vector<Hit> hits = all(*tracer, ray({0, 0, 0}, {.1, .2, .3}));
  ASSERT_EQ(hits.size(), 2u);
  EXPECT_EQ(hits[0].primitive, 0u);
  EXPECT_EQ(hits[0].t, 1);
  EXPECT_TRUE(hits[0].status & status_tie);
  EXPECT_TRUE(hits[1].status & status_tie);
}

TEST(Reference, RaysWithinATriangleAndTrianglesWithoutAreaMiss) {
  const auto flat = tracer_of(square);
  EXPECT_FALSE(any(*flat, ray({-1, .5, 0}, {1, 0, 0})));
  const auto needle = tracer_of(Mesh{{{0, 0, 0}, {.1, .2, .3}, {.3, .6, .9}}, {}, {{0, 0, 1}}});
  EXPECT_FALSE(any(*needle, ray({0, 0, -1}, {0, 0, 1})));
  const auto line = tracer_of(Mesh{{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}}, {}, {{0, 1, 2}}});
  EXPECT_FALSE(any(*line, ray({1, 2, 0}, {0, 0, 1})));
}

TEST(Reference, ARayThatStartsOnATriangleDoesNotHitIt) {
  const Mesh mesh{{{.1, .2, .3}, {1.7, .9, -.4}, {-.6, 1.3, .7}}, {}, {{0, 1, 2}}};
  const auto tracer = tracer_of(mesh);
  const glm::dvec3 away{.3, .1, .7};
  EXPECT_FALSE(any(*tracer, ray({.1, .2, .3}, away)));
  EXPECT_EQ(closest(*tracer, ray({.1, .2, .3}, away, -1)).t, 0);
}

TEST(Reference, TinyTrianglesAreHit) {
  for (const double s : {2e-4, 1e-15, 1e-23, 1e-100, 1e-300}) {
    const auto tracer = tracer_of(Mesh{{{0, 0, 0}, {s, 0, 0}, {0, s, 0}}, {}, {{0, 1, 2}}});
    const Hit hit = closest(*tracer, ray({s / 4, s / 4, 1}, {0, 0, -1}));
    EXPECT_EQ(hit.t, 1) << s;
  }
}

TEST(Reference, EqualPrimitivesTieAndTheLowestObjectWins) {
  GeometryBuilder builder;
  builder.add(shape(sphere), 0, Affine::translate({0, 0, 9}));
  builder.add(shape(sphere));
  builder.add(shape(sphere));
  const auto tracer = make_reference_tracer(builder.build());
  const Hit hit = closest(*tracer, ray({-3, 0, .25}, {1, 0, 0}));
  EXPECT_EQ(hit.object, 1u);
  EXPECT_EQ(hit.status, status_hit | status_tie);
  EXPECT_EQ(all(*tracer, ray({-3, 0, .25}, {1, 0, 0})).size(), 4u);
}

/// At y = h a unit sphere is met h^2 / 2 later than at its middle, here less than any quad can tell.
constexpr double tiny = 0x1p-300;

TEST(Reference, IntervalsEndExactlyAtRootsToo) {
  const auto tracer = tracer_of(shape(sphere));
  const glm::dvec3 aside{-4, tiny, 0}, along{1, 0, 0};
  EXPECT_FALSE(any(*tracer, ray(aside, along, 0, 3)));
  EXPECT_TRUE(any(*tracer, ray({-4, 0, 0}, along, 0, 3)));
  EXPECT_EQ(closest(*tracer, ray(aside, along, 3)).t, 3);
  EXPECT_EQ(closest(*tracer, ray({-4, 0, 0}, along, 3)).t, 5);
}

TEST(Reference, RootsOfTwoQuadricsAreComparedExactly) {
  GeometryBuilder builder;
  builder.add(shape(sphere));
  builder.add(shape(sphere), 0, Affine::translate({0, tiny, 0}));
  const auto tracer = make_reference_tracer(builder.build());
  const auto expect = [&](double height, std::uint32_t object, std::uint32_t status) {
    const Hit hit = closest(*tracer, ray({-4, height, 0}, {1, 0, 0}));
    EXPECT_EQ(hit.object, object) << height;
    EXPECT_EQ(hit.status, status) << height;
  };
  expect(0, 0, status_hit);
  expect(tiny / 2, 0, status_hit | status_tie);
  expect(tiny, 1, status_hit);
}

TEST(Reference, ARootAndATriangleAreComparedExactly) {
  GeometryBuilder builder;
  builder.add(shape(sphere));
  builder.add(Mesh{{{-1, -9, -9}, {-1, 9, -9}, {-1, 0, 9}}, {}, {{0, 1, 2}}});
  const auto tracer = make_reference_tracer(builder.build());
  EXPECT_EQ(closest(*tracer, ray({-4, tiny, 0}, {1, 0, 0})).object, 1u);
  const Hit tie = closest(*tracer, ray({-4, 0, 0}, {1, 0, 0}));
  EXPECT_EQ(tie.object, 0u);
  EXPECT_EQ(tie.status, status_hit | status_tie);
}

TEST(Reference, InstancesAnswerWithTheirOwnIds) {
  GeometryBuilder inner;
  inner.add(square);
  inner.add(capped(cylinder), 0, Affine::translate({8, 0, 0}));
  const auto group = inner.build();
  GeometryBuilder outer;
  outer.add(shape(sphere), 0, Affine::translate({100, 0, 0}));
  outer.add(group);
  outer.add(group, Affine::translate({0, 0, 16}) * Affine::scale({4, 4, -2}));
  const auto tracer = make_reference_tracer(outer.build());

  const Hit plain = closest(*tracer, ray({.25, .75, 1}, {0, 0, -1}));
  EXPECT_EQ(plain.object, 1u);
  EXPECT_EQ(plain.primitive, 1u);
  const Hit cap = closest(*tracer, ray({32, 2, 20}, {0, 0, -1}));
  EXPECT_EQ(cap.t, 4);
  EXPECT_EQ(cap.object, 2u);
  EXPECT_EQ(cap.primitive, 3u) << "two triangles, the side, then the lower cap, which the mirror puts on top";
  EXPECT_EQ(cap.normal, glm::vec3(0, 0, 1));
  const Hit edge = closest(*tracer, ray({1, 1, 20}, {1. / 3, 1. / 3, -1}));
  EXPECT_EQ(edge.primitive, 0u);
  EXPECT_EQ(edge.status, status_hit | status_tie) << "shared edges stay exact through a placement";
}

TEST(Reference, ManyRaysThroughAClosedBodyCrossItAnEvenNumberOfTimes) {
  GeometryBuilder builder;
  for (int i = 0; i < 200; ++i)
    builder.add(
        capped(i % 2 ? cylinder : paraboloid), 0,
        Affine::translate({std::cos(i) * 5, std::sin(1.7 * i) * 5, i * .05}) * Affine::rotate({1, i, 2}, 40 * i));
  const auto tracer = make_reference_tracer(builder.build());
  std::vector<Ray> rays;
  for (int i = 0; i < 500; ++i)
    rays.push_back(ray({-40 * std::cos(i), -40 * std::sin(i), 3}, {std::cos(i), std::sin(i) + .001 * i, .01}));
  const HitLists lists = tracer->all(rays);
  ASSERT_EQ(lists.offsets.size(), rays.size() + 1);
  EXPECT_GT(lists.hits.size(), 1000u);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ((lists.offsets[i + 1] - lists.offsets[i]) % 2, 0u) << "ray " << i;
    for (std::size_t k = lists.offsets[i] + 1; k < lists.offsets[i + 1]; ++k)
      EXPECT_LE(lists.hits[k - 1].t, lists.hits[k].t);
  }
}

}  // namespace
}  // namespace rayengine
