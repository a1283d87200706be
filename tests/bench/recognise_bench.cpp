// What recognise() makes of meshes, and in what time, beside Embree's BVH over the same triangles. Quadrics of a scene
// are tessellated first, 512 triangles a sphere. Usage: recognise_bench SCENE...

#include <cstdio>
#include <glm/geometric.hpp>
#include <map>
#include <string>

#include "accel/stopwatch.h"
#include "engine/load/load.h"
#include "engine/measure/tessellate.h"
#include "engine/plan/recognise/recognise.h"
#include "engine/tracers.h"

namespace {

using namespace rayengine;

Mesh one_mesh(const Geometry& scene) {
  constexpr int level = 3;
  const auto tessellation = tessellate(scene, level);
  const Geometry& geometry = tessellation ? *tessellation->geometry : scene;
  Mesh mesh;
  for (std::uint32_t i = 0; i < geometry.vertices.size(); ++i) mesh.positions.push_back(geometry.vertex(i));
  mesh.triangles = geometry.triangles;
  return mesh;
}

double embree_seconds(const Mesh& mesh) {
  GeometryBuilder builder;
  builder.add(mesh);
  return make_tracer("embree", builder.build())->build_seconds();
}

std::string name(const QuadricShape& shape) {
  const bool inward = shape.matrix && (*shape.matrix)[0] < 0;
  return (shape.capped ? "capped " : inward ? "inward " : "") + std::string(to_string(shape.type));
}

void report(const Mesh& mesh, double share, double tolerance) {
  const Stopwatch clock;
  const double before = processor_seconds();
  const Recognition found = recognise(mesh, tolerance);
  const double wall = clock.seconds(), processor = processor_seconds() - before;
  std::map<std::string, std::size_t> kinds;
  double worst = 0;
  for (const RecognisedQuadric& q : found.quadrics) ++kinds[name(q.shape)], worst = std::max(worst, q.residual);
  std::printf(
      "  %6g %%: %zu quadrics for %zu triangles, %zu stay; residual at most %.2g %%; %.3f s (processor %.3f s):",
      100 * share, found.quadrics.size(), mesh.triangles.size() - found.rest.size(), found.rest.size(),
      100 * share * worst / tolerance, wall, processor);
  for (const auto& [kind, count] : kinds) std::printf(" %zu %s", count, kind.c_str());
  std::puts("");
}

void run(const std::string& file) {
  const Scene scene = load_scene(file);
  const Mesh mesh = one_mesh(*scene.geometry);
  const double before = processor_seconds();
  const double embree = embree_seconds(mesh), processor = processor_seconds() - before;
  std::printf("%s: %zu triangles; Embree %.3f s (processor %.3f s)\n", file.c_str(), mesh.triangles.size(), embree,
              processor);
  const double diagonal = glm::length(scene.geometry->bounds.size());
  for (const double share : {1e-4, 1e-3, 1e-2}) report(mesh, share, share * diagonal);
}

}  // namespace

int main(int count, char** files) {
  try {
    for (int i = 1; i < count; ++i) run(files[i]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
