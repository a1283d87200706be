#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <random>

#include "accel/tracer.h"
#include "accel/treelets.h"

using namespace rayengine;

namespace {

QuadricShape shape(QuadricType type) {
  QuadricShape s;
  s.type = type;
  return s;
}

/// A wavy sheet of triangles, spheres and cylinders above it, and a plane below.
std::shared_ptr<const Geometry> mixed_scene() {
  GeometryBuilder builder;
  Mesh sheet;
  constexpr unsigned n = 20;
  for (unsigned y = 0; y <= n; ++y)
    for (unsigned x = 0; x <= n; ++x) sheet.positions.emplace_back(x, y, std::sin(x + 0.3 * y));
  for (unsigned y = 0; y < n; ++y)
    for (unsigned x = 0; x < n; ++x) {
      const unsigned i = y * (n + 1) + x;
      sheet.triangles.emplace_back(i, i + 1, i + n + 1);
      sheet.triangles.emplace_back(i + 1, i + n + 2, i + n + 1);
    }
  builder.add(sheet);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0, n);
  for (int i = 0; i < 60; ++i)
    builder.add(shape(i % 2 ? QuadricType::sphere : QuadricType::cylinder), 0,
                Affine::translate({place(random), place(random), 2}) * Affine::scale(glm::dvec3(0.5)));
  builder.add(shape(QuadricType::plane));
  return builder.build();
}

/// Whether `ids` holds each number below `count` once.
bool is_permutation(std::vector<std::uint32_t> ids, std::size_t count) {
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0);
  std::sort(ids.begin(), ids.end());
  return ids == all;
}

}  // namespace

TEST(Treelets, HoldEveryPrimitiveOnceAndAtMostKEach) {
  const auto scene = mixed_scene();
  for (const std::uint32_t K : {1u, 7u, 64u, 100000u}) {
    const Treelets t = build_treelets(treelet_primitives(*scene), K);
    EXPECT_TRUE(is_permutation(t.triangles, scene->triangles.size()));
    EXPECT_TRUE(is_permutation(t.quadrics, scene->quadrics.size()));
    std::uint32_t triangles = 0, quadrics = 0;
    for (const Treelet& treelet : t.treelets) {
      EXPECT_LE(treelet.size(), K);
      EXPECT_GE(treelet.size(), 1u);
      EXPECT_EQ(treelet.first_triangle, triangles);
      EXPECT_EQ(treelet.first_quadric, quadrics);
      triangles += treelet.triangle_count, quadrics += treelet.quadric_count;
    }
    EXPECT_EQ(t.unbounded.first_quadric, quadrics);
    EXPECT_EQ(t.unbounded.triangle_count, 0u);
    ASSERT_EQ(t.unbounded.quadric_count, 1u);
    EXPECT_EQ(scene->quadrics[t.quadrics.back()].type, QuadricType::plane);
  }
}

TEST(Treelets, AreAsLargeAsKAllows) {
  const auto scene = mixed_scene();
  const Treelets one = build_treelets(treelet_primitives(*scene), 100000);
  EXPECT_EQ(one.treelets.size(), 1u);
  const Treelets t = build_treelets(treelet_primitives(*scene), 64);
  EXPECT_LT(t.treelets.size(), 3 * (scene->triangles.size() + scene->quadrics.size()) / 64);
}

TEST(Treelets, KeepQuadricsOfATypeTogether) {
  const auto scene = mixed_scene();
  const Treelets t = build_treelets(treelet_primitives(*scene), 64);
  for (const Treelet& treelet : t.treelets)
    for (std::uint32_t i = 1; i < treelet.quadric_count; ++i)
      EXPECT_LE(scene->quadrics[t.quadrics[treelet.first_quadric + i - 1]].type,
                scene->quadrics[t.quadrics[treelet.first_quadric + i]].type);
}

TEST(Treelets, BoxesHoldTheirPrimitives) {
  const auto scene = mixed_scene();
  const auto primitives = treelet_primitives(*scene);
  const Treelets t = build_treelets(primitives, 16);
  for (const WideNode& node : t.nodes)
    for (std::uint32_t lane = 0; lane < WideNode::width; ++lane) {
      if (!(node.children[lane] & WideNode::leaf) || node.planes[0][0][lane] > node.planes[0][1][lane]) continue;
      const Treelet& treelet = t.treelets[node.children[lane] ^ WideNode::leaf];
      const auto expect_held = [&](const Box& box) {
        const glm::dvec3 lower = (box.lower - t.frame.center) * t.frame.scale;
        const glm::dvec3 upper = (box.upper - t.frame.center) * t.frame.scale;
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_LE(node.planes[axis][0][lane], lower[axis]);
          EXPECT_GE(node.planes[axis][1][lane], upper[axis]);
        }
      };
      for (std::uint32_t i = 0; i < treelet.triangle_count; ++i)
        expect_held(primitives[t.triangles[treelet.first_triangle + i]].bounds);
      for (std::uint32_t i = 0; i < treelet.quadric_count; ++i)
        expect_held(primitives[scene->triangles.size() + t.quadrics[treelet.first_quadric + i]].bounds);
    }
}

TEST(Treelets, OfNothingAndOfPlanesAlone) {
  EXPECT_TRUE(build_treelets({}, 8).treelets.empty());
  GeometryBuilder builder;
  builder.add(shape(QuadricType::plane));
  const Treelets t = build_treelets(treelet_primitives(*builder.build()), 8);
  EXPECT_TRUE(t.treelets.empty());
  EXPECT_EQ(t.nodes.size(), 1u);
  EXPECT_EQ(t.unbounded.quadric_count, 1u);
}

TEST(Treelets, LeaveWhatIsTooFarOutToBeTestedAlways) {
  const TreeletPrimitive near{{{0, 0, 0}, {1, 1, 1}}, TreeletPrimitive::triangle, 0};
  const TreeletPrimitive far{{{0, 0, 0}, {1e305, 1, 1}}, TreeletPrimitive::triangle, 1};
  const Treelets t = build_treelets(std::array{far, near}, 8);
  EXPECT_EQ(t.triangles, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(t.treelets.size(), 1u);
  EXPECT_EQ(t.unbounded.triangle_count, 1u);
}

TEST(Treelets, KeepTheMiddleOfAScene) {
  GeometryBuilder builder;  // 5.55 is no number in single precision, which its box holds as well
  builder.add(Mesh{{{0, 0, 0}, {5.55, 0, 5.55}, {0, 5.55, 0}}, {}, {{0, 1, 2}}});
  const auto scene = builder.build();
  const auto primitives = treelet_primitives(*scene);
  EXPECT_EQ(build_treelets(primitives, 8, frame_bounds(*scene)).frame.center, glm::dvec3(2.775));
  EXPECT_NE(build_treelets(primitives, 8).frame.center, glm::dvec3(2.775));
}

TEST(Treelets, RefuseKOfZero) { EXPECT_THROW(build_treelets({}, 0), Error); }
