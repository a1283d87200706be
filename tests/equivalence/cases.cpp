#include "tests/equivalence/cases.h"

#include <cmath>
#include <numbers>

namespace rayengine::test {
namespace {

/// Turned, stretched and moved, in another way for every i.
Affine placement(int i) {
  return Affine::translate({3 * std::cos(i), 3 * std::sin(2. * i), .1 * i}) * Affine::rotate({1, i, 2}, 40 * i) *
         Affine::scale({1 + .1 * (i % 5), 1, 1 - .1 * (i % 3)});
}

Case many(const std::string& name, const QuadricShape& shape) {
  GeometryBuilder builder;
  for (int i = 0; i < 24; ++i) builder.add(shape, 0, placement(i));
  return {name, builder.build()};
}

QuadricShape ellipsoid_with_a_box() {
  return {QuadricType::general,
          false,
          {},
          QuadricMatrix{1, .25, 0, 0, 2, 0, .5, 1.5, 0, -1},
          Box{{-1, -.5, -1}, {.5, 1, 1}}};
}

Mesh torus(unsigned rings, unsigned sides) {
  Mesh mesh;
  for (unsigned i = 0; i < rings; ++i)
    for (unsigned k = 0; k < sides; ++k) {
      const double a = 2 * std::numbers::pi * i / rings, b = 2 * std::numbers::pi * k / sides, r = 2 + std::cos(b);
      mesh.positions.push_back({r * std::cos(a), r * std::sin(a), std::sin(b)});
      const unsigned next = (i + 1) % rings * sides, here = i * sides, beside = (k + 1) % sides;
      mesh.triangles.push_back({here + k, next + k, next + beside});
      mesh.triangles.push_back({here + k, next + beside, here + beside});
    }
  return mesh;
}

Case instances() {
  GeometryBuilder inner;
  inner.add(torus(24, 12));
  inner.add(QuadricShape{QuadricType::cone, true, {}, {}, {}}, 0, Affine::translate({0, 0, .5}));
  const auto group = inner.build();
  GeometryBuilder outer;
  for (int i = 0; i < 12; ++i) outer.add(group, placement(i));
  return {"instances", outer.build()};
}

Case mixed() {
  GeometryBuilder builder;
  for (int i = 0; i < 40; ++i) {
    const auto type = static_cast<QuadricType>(i % 9);
    if (type != QuadricType::plane) builder.add(QuadricShape{type, false, {}, {}, {}}, 0, placement(i));
    builder.add(torus(8, 6), 0, placement(i + 3));
  }
  return {"mixed", builder.build()};
}

/// Unbounded below and finite above.
Case floor_and_bodies() {
  GeometryBuilder builder;
  builder.add(QuadricShape{QuadricType::plane, false, {}, {}, {}}, 0, Affine::translate({0, 0, -4}));
  for (int i = 0; i < 8; ++i) {
    builder.add(QuadricShape{}, 0, placement(i));
    builder.add(torus(8, 6), 0, placement(i + 3));
  }
  return {"floor", builder.build()};
}

Case far_away() {
  GeometryBuilder builder;
  for (int i = 0; i < 8; ++i) {
    builder.add(QuadricShape{}, 0, Affine::translate({1e6, 2e6, 0}) * placement(i));
    builder.add(torus(8, 6), 0, Affine::translate({1e6, 2e6, 0}) * placement(i));
  }
  return {"far_away", builder.build(), 300, 1};  // a float's ulp is an eighth here
}

}  // namespace

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (std::size_t i = 0; i + 1 < quadric_type_count; ++i) {
    const auto type = static_cast<QuadricType>(i);
    cases.push_back(many(std::string(to_string(type)), {type, false, {}, {}, {}}));
    if (type >= QuadricType::cylinder && type <= QuadricType::hyperboloid2)
      cases.push_back(many(std::string(to_string(type)) + "_capped", {type, true, {}, {}, {}}));
  }
  cases.push_back(many("general", ellipsoid_with_a_box()));
  cases.push_back(many("clipped_sphere", {QuadricType::sphere, false, std::array{-.5, .75}, {}, {}}));
  GeometryBuilder builder;
  builder.add(torus(64, 32));
  cases.push_back({"torus", builder.build()});
  cases.push_back(instances());
  cases.push_back(mixed());
  cases.push_back(floor_and_bodies());
  cases.push_back(far_away());
  return cases;
}

}  // namespace rayengine::test
