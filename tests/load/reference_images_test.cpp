// POV-Ray's pictures of the data scenes (`direct`, linear, one ray a pixel), against ours.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/load/image_io.h"
#include "engine/load/load.h"
#include "engine/render/render.h"
#include "engine/tracers.h"
#include "tests/data.h"

namespace rayengine {
namespace {

constexpr int most_differing = 20;  // pixels of 262,144
const RenderOptions direct{.shading = Shading::direct};

/// "spd/balls-s4" gives "spd-ref/balls-s4.direct.pov.png".
std::string picture_name(const std::string& name) {
  const std::size_t slash = name.find('/');
  return name.substr(0, slash) + "-ref" + name.substr(slash) + ".direct.pov.png";
}

int level(float value) { return static_cast<int>(std::lround(255 * std::clamp(value, 0.0f, 1.0f))); }

/// The picture with values as its file stores them: it holds linear ones, but does not say so, and is read as sRGB.
Image read_linear(const std::filesystem::path& file) {
  Image image = read_image(file);
  for (float& v : image.pixels) v = v <= 0.0031308f ? v * 12.92f : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
  return image;
}

/// Whether two pixels are alike to one step of 8 bits in every channel.
bool alike(const float* a, const float* b) {
  for (int c = 0; c < 3; ++c)
    if (std::abs(level(a[c]) - level(b[c])) > 1) return false;
  return true;
}

/// What a ray through pixel coordinates (x, y) sees.
std::array<float, 3> color_at(const Scene& scene, Tracer& tracer, double x, double y) {
  Scene nudged = scene;
  nudged.camera.size = {1, 1};
  nudged.camera.at = camera_ray(scene.camera, x, y).at(1);
  const Image image = render(nudged, tracer, direct).image;
  return {image.pixels[0], image.pixels[1], image.pixels[2]};
}

/// Whether a ray a hundredth of a pixel beside the pixel's centre sees what the reference shows: then an edge runs
/// there.
bool is_on_edge(const Scene& scene, Tracer& tracer, int x, int y, const float* reference) {
  for (int direction = 0; direction < 8; ++direction) {
    const double angle = direction * std::acos(-1) / 4;
    const auto beside = color_at(scene, tracer, x + 0.5 + 0.01 * std::cos(angle), y + 0.5 + 0.01 * std::sin(angle));
    if (alike(beside.data(), reference)) return true;
  }
  return false;
}

/// Whether the oracle sees what we do: then the reference is wrong there (POV-Ray loses a few rays between triangles).
bool is_right(const Scene& scene, int x, int y, const float* ours) {
  const auto oracle = make_tracer("reference", scene.geometry);
  return alike(color_at(scene, *oracle, x + 0.5, y + 0.5).data(), ours);
}

void expect_picture(Scene scene, const std::filesystem::path& picture) {
  const Image reference = read_linear(picture);
  scene.camera.size = {reference.width, reference.height};
  const auto tracer = make_tracer("embree", scene.geometry);
  const Image ours = render(scene, *tracer, direct).image;
  int differing = 0;
  for (int y = 0; y < ours.height; ++y)
    for (int x = 0; x < ours.width; ++x) {
      const float *a = ours.pixel(x, y), *b = reference.pixel(x, y);
      if (alike(a, b) || ++differing > most_differing) continue;
      EXPECT_TRUE(is_on_edge(scene, *tracer, x, y, b) || is_right(scene, x, y, a))
          << "pixel " << x << ", " << y << ": ours " << level(a[0]) << ' ' << level(a[1]) << ' ' << level(a[2])
          << ", reference " << level(b[0]) << ' ' << level(b[1]) << ' ' << level(b[2]);
    }
  EXPECT_LE(differing, most_differing);
  testing::Test::RecordProperty("differing", differing);
}

class ReferencePicture : public testing::TestWithParam<const char*> {};

class NffPicture : public ReferencePicture {};
INSTANTIATE_TEST_SUITE_P(Scenes, NffPicture,
                         testing::Values("spd/balls-s4", "spd/gears-s4", "spd/jacks-s3", "spd/lattice-s12",
                                         "spd/mount-s6", "spd/nurbtst-default", "spd/rings-s7", "spd/rings-s20",
                                         "spd/shells-s5", "spd/sombrero-s3", "spd/teapot-s12", "spd/tetra-s6",
                                         "spd/tree-s11", "spd/tree-s15", "mol/1hpv.bs", "mol/1tii.bs"));

TEST_P(NffPicture, IsThatOfPovRay) {
  const std::string name = GetParam();
  DATA_OR_SKIP(file, name + ".nff");
  DATA_OR_SKIP(picture, picture_name(name));
  expect_picture(load_nff(file), picture);
}

class MeshPicture : public ReferencePicture {};
INSTANTIATE_TEST_SUITE_P(Scenes, MeshPicture,
                         testing::Values("bun_zipper.ply", "dragon_vrip_res2.ply", "koala.obj", "netgen-frame.stl",
                                         "occt-motor.stl", "spot.obj", "wingnut.obj"));

TEST_P(MeshPicture, IsThatOfPovRay) {
  const std::string name = GetParam(), stem = name.substr(0, name.find('.'));
  DATA_OR_SKIP(file, "mesh/" + name);
  DATA_OR_SKIP(view, "mesh-ref/" + stem + ".view.nff");
  DATA_OR_SKIP(picture, picture_name("mesh/" + stem));
  Scene scene = load_nff(view);
  std::vector<std::string> notes;
  GeometryBuilder builder;
  builder.add(load_mesh(file, notes));
  scene.geometry = builder.build();
  expect_picture(scene, picture);
}

}  // namespace
}  // namespace rayengine
