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
  const std::vector<Camera> turn = turntable(camera, 4);
  ASSERT_EQ(turn.size(), 4u);
  EXPECT_EQ(turn[0].from, camera.from);
  const Camera& quarter = turn[1];
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
  const std::vector<Camera> turn = turntable(scene.camera, 5);
  const RenderStats sum = render_frames(scene, turn, *tracer, {.depth = 2}, [&](int frame, RenderResult& result) {
    order.push_back(frame);
    Scene turned = scene;
    turned.camera = turn[static_cast<std::size_t>(frame)];
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
  EXPECT_THROW(render_frames(scene, turntable(scene.camera, 20), *tracer, {},
                             [&](int, RenderResult&) {
                               if (++frames == 2) throw Error("the disk is full");
                             }),
               Error);
  EXPECT_LE(frames, 2);
}

TEST(Animation, ACameraThatSeesNothingIsToldOfBeforeAnyWork) {
  const Scene scene = a_scene();
  std::vector<Camera> cameras = turntable(scene.camera, 3);
  cameras[2].at = cameras[2].from;
  int frames = 0;
  try {
    render_frames(scene, cameras, *make_tracer("embree", scene.geometry), {}, [&](int, RenderResult&) { ++frames; });
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("in frame 2, the camera sees nothing"), std::string::npos) << error.what();
  }
  EXPECT_EQ(frames, 0);
}

}  // namespace
}  // namespace rayengine::test
