// Objects copied from one geometry to another: the same bits, and so the same hits.

#include <gtest/gtest.h>

#include "accel/tracer.h"
#include "engine/measure/rays.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

const Affine placed = Affine::translate({0.1, 0.2, 0.3}) * Affine::rotate({1, 2, 3}, 40) * Affine::scale({1, 0.7, 1.3});

Mesh tetrahedron(const glm::dvec3& at) {
  Mesh mesh;
  for (const glm::dvec3& p : {glm::dvec3(0), glm::dvec3(.9, 0, 0), glm::dvec3(0, .9, 0), glm::dvec3(0, 0, .9)}) {
    mesh.positions.push_back(at + p);
    mesh.normals.emplace_back(0.36f, 0.48f, 0.8f);
  }
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

/// One of each kind, and one more of each that stays behind.
std::shared_ptr<const Geometry> assorted() {
  GeometryBuilder builder;
  builder.add(tetrahedron({1, 0, 0}));
  builder.add(QuadricShape{QuadricType::cylinder, true}, 4, placed);
  const auto group = builder.build();
  builder.add(tetrahedron({5, 5, 5}));
  builder.add(QuadricShape{QuadricType::sphere, false, {}, {}, Box{{-2, -2, 0}, {2, 2, 2}}}, 7,
              Affine::translate({4, 4, 4}));
  builder.add(group, Affine::translate({-3, 3, 0}));
  builder.add(tetrahedron({0.1, 0, 0}), 1, placed);
  builder.add(QuadricShape{QuadricType::saddle, false, {}, {}, Box{glm::dvec3(-1), glm::dvec3(.8)}}, 2,
              Affine::translate({0, 2, 0}) * placed);
  builder.add(group, Affine::translate({0, -2, 0.1}) * placed, 3);
  return builder.build();
}

TEST(CopiedObjects, AreTheSameBits) {
  const auto all = assorted();
  GeometryBuilder builder;
  for (std::uint32_t object : {3u, 4u, 5u}) EXPECT_EQ(builder.add(*all, object), object - 3);
  const auto some = builder.build();
  EXPECT_EQ(some->triangles.size(), 4u);
  EXPECT_EQ(some->normals, std::vector<glm::vec3>(all->normals.begin() + 4, all->normals.end()));
  EXPECT_EQ(some->quadrics.size(), 1u);
  EXPECT_EQ(some->forms.size(), 1u);
  EXPECT_EQ(some->groups, all->groups);
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(some->objects[i].material, all->objects[i + 3].material);
    EXPECT_EQ(primitive_count(*some, i), primitive_count(*all, i + 3));
  }
  const auto first = make_tracer("reference", some), whole = make_tracer("reference", all);
  std::size_t hits = 0;
  for (const Ray& ray : random_rays(some->bounds, 5000)) {
    const HitLists expected = whole->all({&ray, 1}), lists = first->all({&ray, 1});
    std::vector<Hit> kept;
    for (const Hit& h : expected.hits)
      if (h.object >= 3) kept.push_back(h);
    ASSERT_EQ(lists.hits.size(), kept.size());
    for (std::size_t i = 0; i < kept.size(); ++i) {
      EXPECT_EQ(lists.hits[i].t, kept[i].t);
      EXPECT_EQ(lists.hits[i].object + 3, kept[i].object);
      EXPECT_EQ(lists.hits[i].primitive, kept[i].primitive);
      ++hits;
    }
  }
  EXPECT_GT(hits, 300u);
}

TEST(CopiedObjects, MeshesAreFoundAgainAsGiven) {
  const auto all = assorted();
  const Mesh given = tetrahedron({5, 5, 5}), found = mesh_of(*all, 0);
  EXPECT_EQ(found.positions, given.positions);
  EXPECT_EQ(found.normals, given.normals);
  EXPECT_EQ(found.triangles, given.triangles);
}

/// Doubles are held from the first vertex on that single precision cannot tell; those before it are told by it.
TEST(GeometryBuilder, KeepsDoublesAfterVerticesThatNeedNone) {
  const glm::dvec3 third(1.0 / 3, 0, 0);
  Mesh single{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}}, exact = single;
  exact.positions[1] = third;
  GeometryBuilder builder;
  builder.add(single);
  EXPECT_TRUE(builder.build()->exact_vertices.empty());
  for (const Mesh& mesh : {single, exact, single}) builder.add(mesh);
  const auto geometry = builder.build();
  ASSERT_EQ(geometry->exact_vertices.size(), 9u);
  EXPECT_EQ(geometry->vertex(1), single.positions[1]);
  EXPECT_EQ(geometry->vertex(4), third);
  EXPECT_EQ(geometry->vertex(8), single.positions[2]);
}

}  // namespace
}  // namespace rayengine
