// A host application: builds a scene in code, asks the three ray queries, prints the answers.
#include <rayengine/rayengine.h>

#include <cstdio>
#include <vector>

using namespace rayengine;

int main() try {
  GeometryBuilder builder;
  builder.add(QuadricShape{.type = QuadricType::sphere});
  builder.add(QuadricShape{.type = QuadricType::cylinder, .capped = true}, 0, Affine::translate({3, 0, 0}));
  builder.add(Mesh{.positions = {{-4, -1, 0}, {-2, -1, 0}, {-3, 1, 0}}, .normals = {}, .triangles = {{0, 1, 2}}});
  const auto tracer = make_tracer("auto", builder.build());

  std::vector<Ray> rays;  // straight down from z = 5: onto the sphere, the cylinder, the triangle, and past them all
  for (const double x : {0., 3., -3., 9.}) rays.push_back({.origin = {x, 0, 5}, .direction = {0, 0, -1}});

  std::vector<Hit> hits(rays.size());
  tracer->closest(rays, hits, RayClass::primary);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].hit())
      std::printf("ray %zu: object %u, primitive %u, t = %.6g\n", i, hits[i].object, hits[i].primitive, hits[i].t);
    else
      std::printf("ray %zu: nothing\n", i);
  }

  std::vector<std::uint32_t> status(rays.size());
  tracer->any(rays, status, RayClass::shadow);
  for (std::size_t i = 0; i < rays.size(); ++i)
    std::printf("ray %zu: %s\n", i, status[i] & status_hit ? "blocked" : "free");

  const HitLists all = tracer->all(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    std::printf("ray %zu: all t =", i);
    for (std::uint64_t k = all.offsets[i]; k < all.offsets[i + 1]; ++k) std::printf(" %.6g", all.hits[k].t);
    std::printf("\n");
  }
} catch (const Error& error) {
  std::fprintf(stderr, "embed: %s\n", error.what());
  return 1;
}
