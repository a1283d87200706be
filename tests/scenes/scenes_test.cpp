// Every tracer against the oracle on whole scenes, the samples and the third-party ones, with the rays that pictures
// are made of: the camera's, from what they hit to the lights and by reflection, and random ones. Prints histograms of
// the differences in t.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <glm/geometric.hpp>

#include "cpu/reference_tracer.h"
#include "engine/batched.h"
#include "engine/load/load.h"
#include "engine/load/mesh_tools.h"
#include "engine/measure/compare.h"
#include "engine/measure/rays.h"
#include "engine/plan/planned.h"
#include "engine/plan/verify.h"
#include "engine/tracers.h"
#include "tests/data.h"
#include "tests/eager_device.h"
#include "tests/temporary.h"

namespace rayengine {
namespace {

constexpr int side = 48;                          // of the picture, in rays
constexpr std::size_t most_objects = 1000;        // for the tracer that makes a pass an object
constexpr std::size_t most_object_tests = 30000;  // primitives that it tests each ray against
constexpr std::size_t most_cone_tests = 5000;     // primitives that it tests each tile against

struct RaySet {
  const char* name;
  RayClass ray_class;
  std::vector<Ray> rays;
};

/// As mirrors send them on: from where `bounces` set out, which has a ray for every hit.
std::vector<Ray> reflected(std::span<const Ray> rays, std::span<const Hit> hits, std::vector<Ray> bounces) {
  auto bounce = bounces.begin();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i].hit()) continue;
    const glm::dvec3 normal = glm::normalize(glm::dvec3(hits[i].normal));
    (bounce++)->direction = rays[i].direction - 2 * glm::dot(rays[i].direction, normal) * normal;
  }
  return bounces;
}

std::vector<RaySet> ray_sets(Scene& scene, Tracer& oracle) {
  scene.camera.size = {side, side};
  std::vector<Ray> primary = primary_rays(scene.camera);
  std::vector<Hit> hits(primary.size());
  oracle.closest(primary, hits, RayClass::primary);
  std::vector<Ray> shadow = shadow_rays(scene, primary, hits);
  shadow.resize(std::min(shadow.size(), primary.size()));
  std::vector<Ray> mirrored = reflected(primary, hits, bounce_rays(*scene.geometry, primary, hits));
  std::vector<Ray> random = random_rays(scene.geometry->bounds, primary.size());
  return {{"primary", RayClass::primary, std::move(primary)},
          {"shadow", RayClass::shadow, std::move(shadow)},
          {"reflected", RayClass::bounce, std::move(mirrored)},
          {"random", RayClass::bounce, std::move(random)}};
}

std::vector<std::string> tracers_for(const Geometry& geometry) {
  std::vector<std::string> names{"embree", "bvh", "stream", "grid", "points"};
  if (geometry.objects.size() <= most_objects && geometry.primitive_count <= most_object_tests)
    names.push_back("objects");
  if (geometry.primitive_count <= most_cone_tests) names.push_back("cones");
  return names;
}

/// A file of the checkout, or of the third-party data where it says data:.
class Scenes : public testing::TestWithParam<const char*> {
 protected:
  std::filesystem::path file() const {
    const std::string name = GetParam();
    return name.starts_with("data:") ? test::data(name.substr(5)) : std::filesystem::path(SOURCE_DIR) / name;
  }

  void compare_all(Tracer& tracer, Tracer& oracle, const Scene& scene, const std::vector<RaySet>& sets) {
    for (const RaySet& set : sets) {
      SCOPED_TRACE(std::string(tracer.name()) + ", " + set.name + " rays");
      const Comparison c = compare(tracer, oracle, *scene.geometry, set.rays, set.ray_class);
      print(tracer, c);
      EXPECT_LE(c.beyond_bounds, leaks(tracer, *scene.geometry, set.rays.size()))
          << c.wrong_ids << " wrong ids, " << c.false_hits << " false hits, " << c.false_misses << " false misses";
      EXPECT_EQ(c.nans, 0u);
      expect_any(tracer, oracle, set, c);
    }
  }

 private:
  /// Embree's robust mode lets through a few of the rays that pass a vertex exactly.
  static std::uint64_t leaks(const Tracer& tracer, const Geometry& geometry, std::size_t rays) {
    return tracer.name() == "embree" && !geometry.triangles.empty() ? rays / 400 : 0;
  }

  /// Whether anything is hit at all differs no more often than the nearest hit does.
  static void expect_any(Tracer& tracer, Tracer& oracle, const RaySet& set, const Comparison& c) {
    std::vector<std::uint32_t> ours(set.rays.size(), 99), exact(set.rays.size(), 99);
    tracer.any(set.rays, ours, set.ray_class);
    oracle.any(set.rays, exact, set.ray_class);
    std::uint64_t differences = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) differences += ours[i] != exact[i];
    EXPECT_LE(differences, c.false_hits + c.false_misses);
  }

  static void print(const Tracer& tracer, const Comparison& c) {
    std::string line;
    for (const std::uint64_t count : c.ulps) line.append(" ").append(std::to_string(count));
    std::printf("%-9s hits %4llu, ambiguous %3llu, t off by 0, 1, 2, 3-4, 5-8 ... ulps:%s\n",
                std::string(tracer.name()).c_str(), static_cast<unsigned long long>(c.hits),
                static_cast<unsigned long long>(c.ambiguous), line.c_str());
  }
};

INSTANTIATE_TEST_SUITE_P(Equal, Scenes,
                         testing::Values("scenes/cornell.json", "scenes/gallery.json", "scenes/glass.json",
                                         "scenes/knot.json", "scenes/sphereflake.json", "data:spd/balls-s4.nff",
                                         "data:spd/gears-s4.nff", "data:spd/jacks-s3.nff", "data:spd/lattice-s12.nff",
                                         "data:spd/mount-s6.nff", "data:spd/nurbtst-default.nff",
                                         "data:spd/rings-s7.nff", "data:spd/rings-s20.nff", "data:spd/shells-s5.nff",
                                         "data:spd/sombrero-s3.nff", "data:spd/teapot-s12.nff", "data:spd/tetra-s6.nff",
                                         "data:spd/tree-s11.nff", "data:spd/tree-s15.nff", "data:mesh/bun_zipper.ply",
                                         "data:mesh/dragon_vrip_res2.ply", "data:mesh/koala.obj", "data:mesh/spot.obj",
                                         "data:mesh/wingnut.obj", "data:mesh/occt-motor.stl",
                                         "data:mesh/netgen-frame.stl", "data:mol/1hpv.bs.nff", "data:mol/1tii.bs.nff"),
                         [](const auto& info) {
                           std::string name = std::filesystem::path(info.param).stem().string();
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

TEST_P(Scenes, AreTheSameForEveryTracer) {
  if (file().empty()) GTEST_SKIP() << "no " << GetParam() << " in " << test::data_folder() << ": set RAYENGINE_DATA";
  Scene scene = load_scene(file());
  const auto reference = make_reference_tracer(scene.geometry);
  Batched oracle(*reference);
  const std::vector<RaySet> sets = ray_sets(scene, oracle);
  EXPECT_GT(sets[2].rays.size(), sets[0].rays.size() / 20) << "too few hits to prove anything";
  for (const std::string& name : tracers_for(*scene.geometry))
    compare_all(*make_tracer(name, scene.geometry), oracle, scene, sets);
}

/// What a plan makes of a scene, whatever the making costs, against exact arithmetic on the scene as it was given.
TEST_P(Scenes, KeepToATolerance) {
  if (file().empty()) GTEST_SKIP() << "no " << GetParam() << " in " << test::data_folder() << ": set RAYENGINE_DATA";
  const test::TemporaryFolder cache;
  setenv("XDG_CACHE_HOME", cache.path().c_str(), 1);
  const DeviceMeasurements device = test::eager_device();
  Scene scene = load_scene(file());
  scene.camera.size = {side, side};  // few pixels are large ones: there is more to be replaced
  const std::vector<Ray> rays = random_camera_rays(scene.camera, 2000);
  for (const Effort& effort : {Effort{.prepare = true}, Effort{.recognise = true}})
    for (const double pixels : {0., 0.1, 1.}) {
      const Tolerance tolerance{pixels};
      const Planned planned = plan_scene(scene, {.tolerance = tolerance,
                                                 .rays = expected_rays(scene, 1),
                                                 .effort = effort,
                                                 .tools = cached_mesh_tools(),
                                                 .device = &device});
      const Scene& model = planned.model.scene;
      const auto tracer = make_tracer(planned.tracing.tracer, model.geometry, options_of(planned.tracing));
      const Verification found = verify(scene, model, *tracer, tolerance, rays);
      std::printf("%.1f pixels: %zu objects replaced, %llu of %llu rays agree beside, at most %.2g off\n", pixels,
                  planned.model.replaced.size(), static_cast<unsigned long long>(found.beside),
                  static_cast<unsigned long long>(found.rays), found.largest);
      EXPECT_EQ(found.broken, 0u) << pixels;
    }
}

}  // namespace
}  // namespace rayengine
