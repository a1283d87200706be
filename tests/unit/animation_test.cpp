#include "engine/render/animation.h"

#include <gtest/gtest.h>

#include <mutex>

#include "render_scenes.h"

namespace rayengine::test {
namespace {

Scene a_scene() {
  GeometryBuilder builder;
  builder.add(unit_sphere);
  builder.add(unit_sphere, 0, Affine::translate({2, 0, 0.5}));
  Scene scene = scene_of(builder, {.color = {1, 0.5f, 0.2f}}, {.from = {0, -6, 2}, .at = {0, 0, 0}, .up = {0, 0, 1}});
  scene.camera.size = {48, 32};
  scene.lights = {point_light({4, -4, 8})};
  return scene;
}

TEST(Animation, TheCameraTurnsAboutWhatItLooksAt) {
  const Camera camera{.from = {1, -6, 2}, .at = {1, 0, 0}, .up = {0, 0, 1}};
  EXPECT_EQ(turntable(camera, 0, 4).from, camera.from);
  const Camera quarter = turntable(camera, 1, 4);
  EXPECT_NEAR(quarter.from.x, 7, 1e-12);
  EXPECT_NEAR(quarter.from.y, 0, 1e-12);
  EXPECT_NEAR(quarter.from.z, 2, 1e-12);
  EXPECT_EQ(quarter.at, camera.at);
}

TEST(Animation, FramesAreThoseRenderedAlone) {
  const Scene scene = a_scene();
  const auto tracer = make_tracer("embree", scene.geometry);
  std::vector<int> order;
  std::uint64_t rays = 0;
  const RenderStats sum = render_turn(scene, *tracer, {.depth = 2}, 5, [&](int frame, RenderResult& result) {
    order.push_back(frame);
    Scene turned = scene;
    turned.camera = turntable(scene.camera, frame, 5);
    RenderResult alone = render(turned, *tracer, {.depth = 2});
    rays += alone.stats.rays[0] + alone.stats.rays[1];
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 48; ++x)
        for (int c = 0; c < 4; ++c) ASSERT_EQ(result.image.pixel(x, y)[c], alone.image.pixel(x, y)[c]);
  });
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(sum.rays[0] + sum.rays[1], rays);
}

TEST(Animation, AFailureEndsIt) {
  const Scene scene = a_scene();
  const auto tracer = make_tracer("embree", scene.geometry);
  int frames = 0;
  EXPECT_THROW(render_turn(scene, *tracer, {}, 20,
                           [&](int, RenderResult&) {
                             if (++frames == 2) throw Error("the disk is full");
                           }),
               Error);
  EXPECT_LE(frames, 2);
}

}  // namespace
}  // namespace rayengine::test
