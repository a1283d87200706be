// What whole spheres gain over the same surfaces in general form, in boxes that just hold them: processor time of one
// against the other, in turns, by tracer, precision and class of rays. Usage: kernel_bench SCENE [SIDE [TRACER...]]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include "engine/load/load.h"
#include "engine/measure/rays.h"
#include "engine/tracers.h"

namespace {

using namespace rayengine;

constexpr int rounds = 7;
constexpr QuadricMatrix unit_sphere{1, 0, 0, 0, 1, 0, 0, 1, 0, -1};

/// The scene's spheres alone, as they are or in general form.
Scene spheres_of(Scene scene, bool general) {
  GeometryBuilder builder;
  QuadricShape shape;
  if (general) shape = {QuadricType::general, false, {}, unit_sphere, Box{glm::dvec3(-1), glm::dvec3(1)}};
  for (const Quadric& q : scene.geometry->quadrics)
    if (q.type == QuadricType::sphere) builder.add(shape, 0, object_to_world(q.to_object));
  scene.geometry = builder.build();
  return scene;
}

/// Of all threads, so that other work on the machine counts little, and software that renders in place of a GPU does.
double processor_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

struct Rays {
  const char* name;
  std::vector<Ray> rays;
  bool any;
};

std::vector<Rays> classes(const Scene& scene, int side) {
  Camera camera = scene.camera;
  camera.size = {side, side};
  std::vector<Ray> eye = primary_rays(camera);
  std::vector<Hit> hits(eye.size());
  make_tracer("bvh", scene.geometry)->closest(eye, hits, RayClass::primary);
  std::vector<Ray> shadow = shadow_rays(scene, eye, hits), bounce = bounce_rays(*scene.geometry, eye, hits);
  std::vector<Ray> chords = random_rays(scene.geometry->bounds, eye.size());
  return {{"primary", std::move(eye), false},
          {"shadow", std::move(shadow), true},
          {"bounce", std::move(bounce), false},
          {"random", std::move(chords), false}};
}

double seconds(Tracer& tracer, const Rays& r) {
  std::vector<Hit> hits(r.any ? 0 : r.rays.size());
  std::vector<std::uint32_t> status(r.any ? r.rays.size() : 0);
  const double start = processor_seconds();
  if (r.any)
    tracer.any(r.rays, status, RayClass::shadow);
  else
    tracer.closest(r.rays, hits, RayClass::bounce);
  return processor_seconds() - start;
}

void compare(const std::string& name, Precision precision, const Scene& spheres, const Scene& general,
             const std::vector<Rays>& all) {
  const TracerOptions options{.precision = precision, .threads = 1};
  const auto ours = make_tracer(name, spheres.geometry, options), theirs = make_tracer(name, general.geometry, options);
  for (const Rays& r : all) {
    std::vector<double> sphere, form, ratio;
    for (int round = -1; round < rounds; ++round) {  // the first warms up
      const double a = seconds(*ours, r), b = seconds(*theirs, r);
      if (round < 0) continue;
      sphere.push_back(a), form.push_back(b), ratio.push_back(b / a);
    }
    const double ns = 1e9 / static_cast<double>(r.rays.size());
    std::printf("%-8s %-10s %-8s %8.0f %8.0f  %5.2f\n", name.c_str(), std::string(to_string(precision)).c_str(), r.name,
                median(sphere) * ns, median(form) * ns, median(ratio));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: kernel_bench SCENE [SIDE [TRACER...]]\n");
    return 2;
  }
  const Scene scene = load_scene(argv[1]);
  const Scene spheres = spheres_of(scene, false), general = spheres_of(scene, true);
  std::vector<std::string> tracers(argv + std::min(argc, 3), argv + argc);
  if (tracers.empty()) tracers = {"embree", "bvh", "stream"};
  const auto all = classes(spheres, argc > 2 ? std::atoi(argv[2]) : 256);
  std::printf("%zu spheres; ns of processor time a ray\ntracer   precision  rays       sphere  general  ratio\n",
              spheres.geometry->quadrics.size());
  for (const std::string& name : tracers)
    for (const Precision precision : {Precision::fast, Precision::robust})
      if (!(name == "bvh" && precision == Precision::fast)) compare(name, precision, spheres, general, all);
}
