#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "cpu/reference_tracer.h"
#include "engine/measure/rays.h"
#include "gpu/objects/objects_tracer.h"

namespace rayengine {
namespace {

std::shared_ptr<const Geometry> bare_quadrics() {
  GeometryBuilder builder;
  for (int i = 0; i < 9; ++i) {
    const auto type = static_cast<QuadricType>(i);
    if (type != QuadricType::plane)
      builder.add(QuadricShape{type, false, {}, {}, {}}, 0, Affine::translate({2.5 * i, 0, 0}));
  }
  builder.add(QuadricShape{QuadricType::cylinder, true, {}, {}, {}}, 0, Affine::translate({0, 3, 0}));
  builder.add(Mesh{{{5, 3, 0}, {8, 3, 0}, {5, 5, 1}}, {}, {{0, 1, 2}}});
  return builder.build();
}

TEST(Objects, HalvesAreRightToTheirPrecision) {
  const auto geometry = bare_quadrics();
  const auto objects = make_objects_tracer(geometry, Precision::half);
  const auto oracle = make_reference_tracer(geometry);
  const auto rays = random_rays(geometry->bounds, 4000);
  std::vector<Hit> ours(rays.size()), exact(rays.size());
  objects->closest(rays, ours, RayClass::primary);
  oracle->closest(rays, exact, RayClass::primary);
  std::size_t same = 0, hits = 0, turned = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hits += exact[i].hit();
    if (!exact[i].hit() || exact[i].object != ours[i].object || exact[i].primitive != ours[i].primitive) continue;
    const bool same_root = std::abs(ours[i].t - exact[i].t) * glm::length(rays[i].direction) < 0.1;
    same += same_root;
    turned += same_root && glm::dot(ours[i].normal, exact[i].normal) < 0.95f;
  }
  ASSERT_GT(hits, 300u);
  EXPECT_GT(same, hits * 97 / 100);
  EXPECT_LT(turned, hits / 50);
  EXPECT_EQ(objects->limits().quadric_roundoff, 0x1p-11);
}

TEST(Objects, TestsMeshesThatOnePassIsTooShortFor) {
  Mesh mesh;  // a staircase of 70,000 steps, seen from above
  for (unsigned i = 0; i < 70000; ++i) {
    const double x = i, z = .001 * i;
    for (const glm::dvec3& corner : {glm::dvec3{x, 0, z}, glm::dvec3{x + 1, 0, z}, glm::dvec3{x, 1, z}})
      mesh.positions.push_back(corner);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  GeometryBuilder builder;
  builder.add(mesh);
  const auto objects = make_objects_tracer(builder.build(), Precision::robust);
  std::vector<Ray> rays;
  for (const double x : {0., 32767., 32768., 65534., 65535., 65536., 69999.})
    rays.push_back({{x + .25, .25, 100}, 0, {0, 0, -1}, infinity});
  std::vector<Hit> hits(rays.size());
  objects->closest(rays, hits, RayClass::primary);
  for (std::size_t i = 0; i < rays.size(); ++i)
    EXPECT_EQ(hits[i].primitive, static_cast<std::uint32_t>(rays[i].origin.x));
}

TEST(Objects, HalvesListNoHits) {
  const auto objects = make_objects_tracer(bare_quadrics(), Precision::half);
  EXPECT_THROW(objects->all({}), Error);
}

}  // namespace
}  // namespace rayengine
