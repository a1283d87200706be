// What rays take where there is next to nothing to hit: nanoseconds a ray of processor time, the least of many runs,
// for one primitive, two and so on. What a structure could cost at all is what more of them add. Usage: few_bench

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "accel/random.h"
#include "accel/stopwatch.h"
#include "engine/measure/rays.h"
#include "engine/query.h"
#include "engine/render/camera.h"
#include "engine/tracers.h"

namespace {

using namespace rayengine;

constexpr int runs = 20;

glm::dvec3 somewhere(Random& random) { return {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}; }

/// So many in a cube, of a size that fills it alike.
std::shared_ptr<const Geometry> scattered(std::size_t count, bool triangles) {
  GeometryBuilder builder;
  const double size = 0.5 / std::cbrt(static_cast<double>(count));
  for (std::size_t i = 0; i < count; ++i) {
    Random random(1, i);
    const glm::dvec3 at = somewhere(random);
    Mesh mesh{{}, {}, {{0, 1, 2}}};
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(at + 2 * size * somewhere(random));
    if (triangles)
      builder.add(mesh);
    else
      builder.add(QuadricShape{}, 0, Affine::translate(at) * Affine::scale(glm::dvec3(size)));
  }
  return builder.build();
}

double nanoseconds(Tracer& tracer, const std::vector<Ray>& rays, RayClass ray_class) {
  std::vector<Hit> hits(rays.size());
  double least = infinity;
  for (int run = 0; run < runs; ++run) {
    const double start = processor_seconds();
    closest(tracer, rays, hits, ray_class);
    least = std::min(least, processor_seconds() - start);
  }
  return 1e9 * least / static_cast<double>(rays.size());
}

}  // namespace

int main() {
  for (const bool triangles : {false, true})
    for (const char* name : {"embree", "bvh", "none"})
      for (const std::size_t count : {1, 2, 4, 8, 16, 32, 64}) {
        const auto geometry = scattered(count, triangles);
        const bool none = std::strcmp(name, "none") == 0;
        const auto tracer =
            make_tracer(none ? "bvh" : name, geometry, {.threads = 1, .build = none ? Build::none : Build::thorough});
        Camera camera;
        camera.size = {256, 256};
        const std::vector<Ray> primary = primary_rays(framing_camera(geometry->bounds, camera));
        const std::vector<Ray> random = random_rays(geometry->bounds, primary.size());
        std::printf("%-6s %3zu %-9s %6.1f primary %6.1f random\n", name, count, triangles ? "triangles" : "balls",
                    nanoseconds(*tracer, primary, RayClass::primary), nanoseconds(*tracer, random, RayClass::bounce));
      }
}
