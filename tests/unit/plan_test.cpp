// What a tolerance makes of a scene: the choices by numbers made up here, the models that carry them out, and the check
// that the promise is kept, which must notice when it is not.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "engine/measure/tessellate.h"
#include "engine/plan/patches.h"
#include "engine/plan/planned.h"
#include "engine/plan/verify.h"
#include "engine/tracers.h"
#include "tests/eager_device.h"

namespace rayengine {
namespace {

constexpr Tolerance half_pixel{0.5}, exact{0};

ObjectStatistics far_mesh(std::uint32_t triangles, double spacing) {
  return {.triangles = triangles, .radius = 1, .distance = 100, .spacing = spacing};
}

SceneStatistics scene_of(std::vector<ObjectStatistics> objects) {
  SceneStatistics scene{.objects = objects.size(), .pixel = 1e-3, .rays = 1e5};
  for (const ObjectStatistics& o : objects) scene.extent = std::max(scene.extent, o.distance + o.radius);
  for (const ObjectStatistics& o : objects) {
    const bool quadric = o.thickness > 0;
    scene.drift[static_cast<std::size_t>(quadric ? Object::Kind::quadric : Object::Kind::mesh)].add(o, scene.extent);
    scene.triangles += o.triangles;
    scene.quadrics += quadric;
    if (o.triangles >= smallest_mesh) scene.meshes.push_back(o);
  }
  return scene;
}

Representation chosen_for(const ObjectStatistics& o, const Tolerance& tolerance = half_pixel) {
  return plan_model(scene_of({o}), usual_device(), tolerance).objects.at(0).representation;
}

TEST(Plan, RefusesTolerancesThatSayNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-1e-9, nan, infinity, -infinity}) {
    EXPECT_THROW(plan_model({}, usual_device(), {bad}), Error) << bad;
    EXPECT_THROW(plan_tracing({}, usual_device(), {bad}, false), Error) << bad;
    EXPECT_THROW(check({bad}), Error) << bad;
  }
}

TEST(Plan, LooksForBallsOnlyWherePatchesLieOnThem) {
  ObjectStatistics mesh = far_mesh(100000, 0.2);
  EXPECT_EQ(chosen_for(mesh), Representation::kept);
  mesh.ball_share = 1;
  EXPECT_EQ(chosen_for(mesh), Representation::recognised);
  EXPECT_EQ(chosen_for(mesh, exact), Representation::kept);
  mesh.triangles = 100;
  EXPECT_TRUE(plan_model(scene_of({mesh}), usual_device(), half_pixel).objects.empty());
}

TEST(Plan, LooksAtPartsOnlyWhereRaysRepayIt) {
  ObjectStatistics mesh = far_mesh(100000, 0.2);
  mesh.quadric_share = 1;
  EXPECT_EQ(chosen_for(mesh), Representation::recalled);  // which looks for none
  const Effort prepare{.prepare = true};
  EXPECT_EQ(plan_model(scene_of({mesh}), usual_device(), half_pixel, prepare).objects[0].representation,
            Representation::recognised_parts);
  mesh.quadric_share = 0;
  EXPECT_EQ(chosen_for(mesh), Representation::kept);
  mesh.quadric_share = 1;
  DeviceMeasurements quick = usual_device();
  quick.recognise_parts = 0;
  EXPECT_EQ(plan_model(scene_of({mesh}), quick, half_pixel).objects[0].representation,
            Representation::recognised_parts);
}

TEST(Plan, AllowancesFollowTheDistance) {
  ObjectStatistics near = far_mesh(1000, 1), far = near, within = near;
  far.distance = 200;
  within.distance = 0;
  const ModelPlan plan = plan_model(scene_of({near, far, within}), usual_device(), half_pixel);
  EXPECT_GT(plan.objects[0].allowance, 0.3 * 0.5 * 1e-3 * 100);
  EXPECT_LE(plan.objects[0].allowance, 0.5 * 1e-3 * 100);
  EXPECT_DOUBLE_EQ(plan.objects[1].allowance, 2 * plan.objects[0].allowance);
  EXPECT_EQ(plan.objects[2].allowance, 0);
}

TEST(Plan, ZeroIsProven) {
  const TracingPlan plan = plan_tracing(scene_of({far_mesh(1000, 1)}), usual_device(), exact, false);
  EXPECT_EQ(plan.precision, Precision::certified);
  EXPECT_EQ(plan.error, 0);
}

/// A ball so far away that single precision cannot tell its radius.
TEST(Plan, TakesThePrecisionThatTheDistanceNeeds) {
  ObjectStatistics ball{.radius = 1, .thickness = 1, .distance = 10};
  const TracerCost* fast = nullptr;
  for (const TracerCost& t : usual_device().tracers)
    if (t.precision == Precision::fast) fast = &t;
  ASSERT_TRUE(fast);
  const double near = predicted_error(scene_of({ball}), *fast, half_pixel);
  ball.distance = 1e5;
  EXPECT_GT(predicted_error(scene_of({ball}), *fast, half_pixel), 1000 * near);
  const TracingPlan plan = plan_tracing(scene_of({ball}), usual_device(), half_pixel, false);
  EXPECT_NE(plan.precision, Precision::fast);
  EXPECT_LE(plan.error, 0.1 * half_pixel.value);
}

/// Embree's fast mode is no choice where a ray can pass between triangles.
TEST(Plan, TakesNoTracerThatLeaks) {
  DeviceMeasurements device = usual_device();
  for (TracerCost& t : device.tracers)
    if (t.precision == Precision::fast) t.triangle = {}, t.quadric = {};
  const ObjectStatistics ball{.radius = 1, .thickness = 1, .distance = 10};
  EXPECT_EQ(plan_tracing(scene_of({ball}), device, half_pixel, false).precision, Precision::fast);
  EXPECT_NE(plan_tracing(scene_of({ball, far_mesh(12, 1)}), device, half_pixel, false).precision, Precision::fast);
}

TEST(Plan, BuildsQuicklyForFewRaysAmongTriangles) {
  SceneStatistics scene = scene_of({far_mesh(1000000, 1)});
  const auto planned = [&] { return plan_tracing(scene, usual_device(), half_pixel, false); };
  EXPECT_EQ(planned().build, Build::quick);
  scene.rays = 1e9;
  EXPECT_EQ(planned().build, Build::thorough);
  scene.rays = 1e5;
  ++scene.quadrics;
  EXPECT_EQ(planned().build, Build::thorough);
  scene = scene_of({far_mesh(12, 1)});
  scene.rays = 1e9;
  EXPECT_EQ(planned().build, Build::thorough);
}

/// A GPU by numbers made up: its structures are shown everywhere, and taken where there is one.
DeviceMeasurements with_gpu(const char* tracer, double per_ray) {
  DeviceMeasurements device = usual_device();
  for (const std::uint32_t treelet : {0u, 64u, 16u})
    if ((treelet == 0) == (std::string_view(tracer) == "grid")) {
      TracerCost& cost = device.tracers.emplace_back();
      cost = {.tracer = tracer, .treelet = treelet, .triangle_roundoff = 0x1p-24, .quadric_roundoff = 0x1p-24};
      for (PrimitiveCost* p : {&cost.triangle, &cost.quadric}) p->coherent.fill(per_ray * (1 + treelet));
    }
  return device;
}

TEST(Plan, TakesAStructureOfTheGpuWhereItIsThereAndFaster) {
  const SceneStatistics scene = scene_of({far_mesh(100000, 0.2)});
  const DeviceMeasurements grid = with_gpu("grid", 1e-12), stream = with_gpu("stream", 1e-12);
  EXPECT_EQ(plan_tracing(scene, grid, half_pixel, true).tracer, "grid");
  const TracingPlan without = plan_tracing(scene, grid, half_pixel, false);
  EXPECT_EQ(without.tracer, "embree");
  EXPECT_EQ(without.choices.at(1).instead.find("grid"), std::string::npos);
  EXPECT_EQ(plan_tracing(scene, stream, exact, true).treelet, 0u);
  EXPECT_EQ(plan_tracing(scene, with_gpu("grid", 1), half_pixel, true).tracer, "auto");
  const TracingPlan hybrid = plan_tracing(scene, stream, half_pixel, true);
  EXPECT_EQ(hybrid.tracer, "auto");
  EXPECT_EQ(hybrid.treelet, 16u);
  EXPECT_EQ(hybrid.choices.at(1).chosen, "treelets of 16, on the GPU");
  EXPECT_EQ(plan_tracing(scene, usual_device(), half_pixel, true).treelet, 0u);
}

TEST(Plan, SaysWhatOtherStructuresWouldTake) {
  SceneStatistics scene = scene_of({far_mesh(100000, 0.2)});
  const auto others = [&] {
    const Choice c = plan_tracing(scene, with_gpu("stream", 1), half_pixel, false).choices.at(1);
    std::vector<Alternative> all = c.others;
    all.insert(all.begin(), {c.instead, c.instead_seconds, c.instead_error});
    return all;
  };
  EXPECT_EQ(others().back().name, "treelets of 64, on the GPU, which is not here");
  EXPECT_TRUE(std::ranges::is_sorted(others(), {}, &Alternative::seconds));
  scene.triangles = 10;
  EXPECT_EQ(others().back().name, "none: all in one treelet, on the GPU, which is not here");
}

/// A ray may be answered by the half that computes in single precision.
TEST(Plan, KnowsThatTheHybridIsAsExactAsTheLessExactHalf) {
  const ObjectStatistics ball{.radius = 1, .thickness = 1, .distance = 1e5};
  const TracingPlan alone = plan_tracing(scene_of({ball}), usual_device(), {1e-3}, false),
                    hybrid = plan_tracing(scene_of({ball}), usual_device(), {1e-3}, true);
  EXPECT_EQ(alone.tracer, "embree");
  EXPECT_EQ(hybrid.tracer, "bvh");
  EXPECT_LT(hybrid.error, 1e-4);
}

/// Where scattered rays meet a handful, boxes cost more than they spare.
TEST(Plan, NeedsNoStructureForAHandful) {
  const auto planned = [](std::size_t balls, bool coherent) {
    SceneStatistics scene = scene_of(std::vector(balls, ObjectStatistics{.radius = 1, .thickness = 1, .distance = 10}));
    scene.coherent = coherent;
    return plan_tracing(scene, usual_device(), half_pixel, false);
  };
  EXPECT_EQ(planned(3, false).build, Build::none);
  EXPECT_EQ(planned(3, false).tracer, "bvh");
  EXPECT_EQ(planned(3, true).build, Build::thorough);
  EXPECT_EQ(planned(300, false).build, Build::thorough);
}

TEST(Device, ReadsTimesBetweenThoseThatWereMeasured) {
  const PrimitiveCost cost{.counts = {8, 64, 512}, .coherent = {3, 6, 12}, .scattered = {1, 2, 3}};
  const auto coherent = [&](Build build, double primitives) { return per_ray(cost, build, true, primitives); };
  EXPECT_DOUBLE_EQ(coherent(Build::thorough, 1), 3);
  EXPECT_DOUBLE_EQ(coherent(Build::thorough, 16), 4);
  EXPECT_DOUBLE_EQ(coherent(Build::thorough, 64), 6);
  EXPECT_DOUBLE_EQ(coherent(Build::thorough, 1024), 14);
  EXPECT_DOUBLE_EQ(coherent(Build::none, 36), 4.5);
  EXPECT_DOUBLE_EQ(per_ray(cost, Build::thorough, false, 512), 3);
}

TEST(Plan, EveryChoiceSaysWhy) {
  SceneStatistics scene = scene_of({far_mesh(100000, 0.2), far_mesh(10, 1)});
  scene.meshes[0].ball_share = 1;
  for (const Choice& c : plan_model(scene, usual_device(), half_pixel).choices) {
    EXPECT_FALSE(c.subject.empty() || c.chosen.empty() || c.why.empty());
    EXPECT_GE(c.seconds, 0);
  }
  const TracingPlan tracing = plan_tracing(scene, usual_device(), half_pixel, false);
  EXPECT_FALSE(tracing.choices.at(0).instead.empty());
  EXPECT_GT(tracing.seconds, 0);
}

TEST(Plan, LeavesTheProcessorHalfToTheHybridWhereThereIsAGpu) {
  const SceneStatistics scene = scene_of({far_mesh(100000, 0.2)});
  EXPECT_EQ(plan_tracing(scene, usual_device(), half_pixel, true).tracer, "auto");
  EXPECT_EQ(plan_tracing(scene, usual_device(), half_pixel, false).tracer, "embree");
}

TEST(DeviceMeasurements, AreReadAsWritten) {
  const DeviceMeasurements& device = usual_device();
  const DeviceMeasurements again = device_from_text(to_text(device));
  EXPECT_EQ(to_text(again), to_text(device));
  ASSERT_EQ(again.tracers.size(), device.tracers.size());
  EXPECT_EQ(again.tracers[1].quadric.scattered[1], device.tracers[1].quadric.scattered[1]);
}

TEST(DeviceMeasurements, OfAnotherFormAreRefused) {
  const std::string good = to_text(usual_device());
  for (const std::string& bad : {std::string(), std::string("nonsense"), good.substr(0, good.size() / 2),
                                 good.substr(0, good.find('\n')), good + "embree sharp 1", "x" + good})
    EXPECT_THROW(device_from_text(bad), Error) << bad;
}

/// Many balls as one mesh of triangles, 512 each.
Scene tessellated_balls() {
  GeometryBuilder balls, builder;
  for (int i = 0; i < 27; ++i)
    balls.add(QuadricShape{}, 0, Affine::translate({3 * (i % 3), 3 * (i / 3 % 3), 3 * (i / 9)}));
  const auto triangles = tessellate(*balls.build(), 3)->geometry;
  Mesh all;
  for (std::uint32_t object = 0; object < triangles->objects.size(); ++object) {
    const Mesh ball = mesh_of(*triangles, object);
    const auto base = static_cast<std::uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), ball.positions.begin(), ball.positions.end());
    for (const glm::uvec3& t : ball.triangles) all.triangles.push_back(t + base);
  }
  builder.add(QuadricShape{QuadricType::plane}, 0, Affine::translate({0, 0, -2}));
  builder.add(all);
  Scene scene;
  scene.geometry = builder.build();
  scene.camera = {.from = {100, -180, 80}, .at = {3, 3, 3}, .fov = 4, .size = {64, 64}};
  return scene;
}

TEST(Patches, KnowBallsFromTubesAndFromNeither) {
  const auto look = [](const QuadricShape& shape, const Affine& map) {
    GeometryBuilder builder;
    builder.add(shape, 0, map);
    return look_at_patches(*tessellate(*builder.build(), 4)->geometry, 0, 24);
  };
  const Affine somewhere = Affine::translate({100, 20, 3}) * Affine::scale({1, 2, 0.5});
  EXPECT_GT(look({}, somewhere).ball_share, 0.9);
  const Patches tube = look({QuadricType::hyperboloid1}, somewhere);
  EXPECT_GT(tube.quadric_share, 0.9);
  EXPECT_LT(tube.ball_share, 0.1);
  Mesh bumpy = subdivided_sphere(5);
  for (glm::dvec3& p : bumpy.positions) p *= 1 + 0.01 * std::sin(40 * p.x) * std::sin(37 * p.y) * std::sin(41 * p.z);
  GeometryBuilder builder;
  builder.add(bumpy);
  EXPECT_LT(look_at_patches(*builder.build(), 0, 24).quadric_share, 0.2);
}

TEST(PlannedScene, PutsBallsInPlaceOfTriangles) {
  const Scene scene = tessellated_balls();
  const Planned planned = plan_scene(scene, {.tolerance = half_pixel, .rays = expected_rays(scene, 1)});
  ASSERT_EQ(planned.model.replaced.size(), 1u);
  EXPECT_EQ(planned.model.replaced[0].object, 1u);
  EXPECT_EQ(planned.model.replaced[0].quadrics, 27u);
  EXPECT_EQ(planned.model.replaced[0].triangles_left, 0u);
  const Scene& model = planned.model.scene;
  EXPECT_EQ(model.geometry->quadrics.size(), 28u);
  EXPECT_EQ(model.object_numbers.front(), 0u);
  EXPECT_EQ(model.object_numbers.back(), 1u);
  const auto tracer = make_tracer(planned.tracing.tracer, model.geometry, options_of(planned.tracing));
  const Verification found = verify(scene, model, *tracer, half_pixel, random_camera_rays(scene.camera, 20000));
  EXPECT_EQ(found.broken, 0u);
  EXPECT_GT(found.hits, 10000u);
  EXPECT_GT(found.largest, 0.01);  // the tessellation is seen to differ
}

/// A pipe of two tubes, whose ends are rings: no quadric has their outline, so that triangles stay beside quadrics.
Mesh pipe(std::uint32_t segments, double inner) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < segments; ++i) {
    const double angle = 2 * std::numbers::pi * i / segments;
    for (const double r : {1.0, inner})
      for (const double z : {0.0, 2.0}) mesh.positions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.emplace_back(a, b, c);
    mesh.triangles.emplace_back(a, c, d);
  };
  // Corners within a segment's four of each face's quadrilateral: from here, from the next one, and back.
  const std::uint32_t faces[4][4] = {{0, 0, 1, 1}, {3, 3, 2, 2}, {1, 1, 3, 3}, {2, 2, 0, 0}};
  for (const auto& f : faces)  // outside, inside, upper end, lower end
    for (std::uint32_t i = 0; i < segments; ++i) {
      const std::uint32_t here = 4 * i, next = 4 * ((i + 1) % segments);
      quad(here + f[0], next + f[1], next + f[2], here + f[3]);
    }
  return mesh;
}

TEST(PlannedScene, HasNoCracksBetweenQuadricsAndTriangles) {
  Scene scene;
  GeometryBuilder builder;
  builder.add(pipe(96, 0.7));
  scene.geometry = builder.build();
  scene.camera = {.from = {3, 0.5, 20}, .at = {0, 0, 1}, .up = {0, 1, 0}, .fov = 7, .size = {512, 512}};
  const DeviceMeasurements device = test::eager_device();
  const Planned planned = plan_scene(scene, {.tolerance = half_pixel, .rays = 1e6, .device = &device});
  ASSERT_EQ(planned.model.replaced.size(), 1u);
  const auto tracer = make_tracer("bvh", planned.model.scene.geometry);
  const auto rays = random_camera_rays(scene.camera, 200000);
  const Verification found = verify(scene, planned.model.scene, *tracer, half_pixel, rays);
  EXPECT_EQ(found.broken, 0u);
  EXPECT_GT(found.hits, 20000u);
}

/// A bumpy ball, thrice in one shape and once in another, the second between the others.
Scene repeated_balls() {
  Mesh ball = subdivided_sphere(4), other;
  for (glm::dvec3& p : ball.positions)  // few bits, so that moving them rounds nothing
    p = glm::round(0x1p20 * p * (1 + 0.1 * std::sin(9 * p.x) * std::cos(8 * p.y))) * 0x1p-20;
  other = ball;
  for (glm::dvec3& p : other.positions) p.z *= 0.75;
  GeometryBuilder builder;
  builder.add(ball, 0, Affine::translate({-2, 0, 0}));
  builder.add(other);
  builder.add(ball, 0, Affine::translate({2, 0, 0}));
  builder.add(ball, 0, Affine::translate({0, 0, 4}) * Affine::rotate({1, 2, 3}, 50));
  Scene scene;
  scene.geometry = builder.build();
  scene.camera = {.from = {3, -30, 5}, .at = {0, 0, 1}, .fov = 20, .size = {256, 256}};
  return scene;
}

TEST(PlannedScene, HoldsMeshesOnceThatRepeat) {
  const Scene scene = repeated_balls();
  const DeviceMeasurements device = test::eager_device();
  for (const Tolerance& tolerance : {exact, half_pixel}) {
    const Planned planned = plan_scene(scene, {.tolerance = tolerance, .rays = 1e5, .device = &device});
    const Scene& model = planned.model.scene;
    const std::size_t turned = tolerance.value > 0;  // turns are rounded
    ASSERT_EQ(planned.model.replaced.size(), 1 + turned);
    EXPECT_EQ(model.geometry->instances.size(), 2 + turned);
    EXPECT_EQ(model.geometry->groups.size(), 1u);
    const auto tracer = make_tracer(planned.tracing.tracer, model.geometry, options_of(planned.tracing));
    const Verification found = verify(scene, model, *tracer, tolerance, random_camera_rays(scene.camera, 20000));
    EXPECT_EQ(found.broken, 0u) << tolerance.value;
    EXPECT_GT(found.hits, 1000u);
  }
}

TEST(PlannedScene, AtZeroIsTheSceneItself) {
  const Scene scene = tessellated_balls();
  const Planned planned = plan_scene(scene, {.tolerance = exact, .rays = 1e6});
  EXPECT_EQ(planned.model.scene.geometry, scene.geometry);
  EXPECT_TRUE(planned.model.replaced.empty());
  const auto tracer = make_tracer(planned.tracing.tracer, scene.geometry, options_of(planned.tracing));
  const Verification found = verify(scene, scene, *tracer, exact, random_camera_rays(scene.camera, 5000));
  EXPECT_EQ(found.broken, 0u);
}

/// A model whose balls are a little too large.
Scene swollen(double by) {
  Scene model = tessellated_balls();
  GeometryBuilder builder;
  builder.add(*model.geometry, 0);
  for (int i = 0; i < 27; ++i)
    builder.add(QuadricShape{}, 0,
                Affine::translate({3 * (i % 3), 3 * (i / 3 % 3), 3 * (i / 9)}) * Affine::scale(glm::dvec3(1 + by)));
  model.geometry = builder.build();
  model.object_numbers.assign(28, 1);
  model.object_numbers[0] = 0;
  return model;
}

TEST(Verification, SeesWhatIsFartherThanPromised) {
  const Scene scene = tessellated_balls();
  const double pixel = pixel_angle(scene.camera) * glm::distance(scene.camera.from, glm::dvec3(3));
  const auto broken = [&](double pixels, const Tolerance& tolerance) {
    const Scene model = swollen(pixels * pixel);
    const auto tracer = make_tracer("embree", model.geometry);
    return verify(scene, model, *tracer, tolerance, random_camera_rays(scene.camera, 4000)).broken;
  };
  EXPECT_EQ(broken(0.2, half_pixel), 0u);
  EXPECT_GT(broken(0.8, half_pixel), 700u);
  EXPECT_GT(broken(0, exact), 1000u);
  EXPECT_EQ(broken(0.2, {0.4 * pixel, Tolerance::Unit::scene}), 0u);
  EXPECT_GT(broken(0.8, {0.5 * pixel, Tolerance::Unit::scene}), 700u);
}

TEST(Verification, SeesObjectsChanged) {
  const Scene scene = tessellated_balls();
  Scene model = scene;
  model.object_numbers = {1, 0};
  const auto tracer = make_tracer("embree", scene.geometry);
  EXPECT_GT(verify(scene, model, *tracer, half_pixel, random_camera_rays(scene.camera, 1000)).broken, 900u);
}

}  // namespace
}  // namespace rayengine
