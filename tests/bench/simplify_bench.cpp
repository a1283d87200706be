// What a coarser mesh saves: building and rendering a mesh that is so many pixels wide in a picture of 512x512, left as
// it is, simplified first, and simplified before (from the cache). Medians of five runs in turns. Usage: simplify_bench
// MESH|bumps PIXELS TOLERANCE [TRACER], the tolerance in pixels; bumps is a sphere of 1,000,000 triangles with bumps on
// it.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "accel/stopwatch.h"
#include "engine/load/load.h"
#include "engine/load/mesh_cache.h"
#include "engine/render/render.h"
#include "engine/tracers.h"

namespace {

using namespace rayengine;

constexpr int rounds = 5;
constexpr double fov = 30;  // degrees

Mesh bumps() {
  constexpr std::uint32_t rows = 500, columns = 1000;
  Mesh mesh;
  for (std::uint32_t i = 0; i <= rows; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      const double a = std::numbers::pi * i / rows, b = 2 * std::numbers::pi * j / columns;
      const glm::dvec3 p(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
      mesh.positions.push_back((1 + 0.1 * std::sin(7 * p.x) * std::sin(9 * p.y + 1) * std::sin(8 * p.z + 2)) * p);
      if (i == rows) continue;
      const std::uint32_t at = i * columns + j, next = i * columns + (j + 1) % columns;
      mesh.triangles.push_back({at, at + columns, next});
      mesh.triangles.push_back({next, at + columns, next + columns});
    }
  return mesh;
}

/// How a mesh is made ready.
using Preparation = Mesh (*)(const Mesh&, double tolerance);

struct Cost {
  double wall, processor, render;  // seconds
  std::size_t bytes;
};

Cost cost_of(const Mesh& mesh, Preparation prepare, double tolerance, const Camera& camera, const char* tracer_name) {
  const Stopwatch watch;
  const double processor = processor_seconds();
  Scene scene;
  scene.camera = camera;
  scene.lights = {headlight(camera)};
  GeometryBuilder builder;
  builder.add(prepare(mesh, tolerance));
  scene.geometry = builder.build();
  const auto tracer = make_tracer(tracer_name, scene.geometry);
  const double ready = watch.seconds();
  render(scene, *tracer);
  const double end = watch.seconds();
  return {end, processor_seconds() - processor, end - ready, scene.geometry->bytes() + tracer->bytes()};
}

double median(std::vector<Cost> costs, double Cost::*field) {
  std::ranges::sort(costs, {}, field);
  return costs[costs.size() / 2].*field;
}

Camera camera_for(const Box& box, double size, double pixels) {
  Camera camera{.fov = fov, .size = {512, 512}};
  camera.at = box.center();
  const double height = size * camera.size.y / pixels;
  camera.from = camera.at - glm::dvec3(0, height / 2 / std::tan(fov / 360 * std::numbers::pi), 0);
  return camera;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 4) return std::fprintf(stderr, "Usage: simplify_bench MESH|bumps PIXELS TOLERANCE [TRACER]\n"), 2;
  const std::string name = arguments[1];
  const double pixels = std::atof(arguments[2]);
  std::vector<std::string> notes;
  const Mesh mesh = name == "bumps" ? bumps() : load_mesh(name, notes);
  Box box;
  for (const glm::dvec3& p : mesh.positions) box.add(p);
  const double size = std::max({box.size().x, box.size().y, box.size().z});
  const Camera camera = camera_for(box, size, pixels);
  const double tolerance = std::atof(arguments[3]) * size / pixels;
  const std::array<std::pair<const char*, Preparation>, 3> ways{
      {{"as it is", [](const Mesh& m, double) { return m; }},
       {"simplified", [](const Mesh& m, double t) { return simplify(m, t).mesh; }},
       {"from the cache", [](const Mesh& m, double t) { return simplify_cached(m, t).mesh; }}}};
  const CoarserMesh simplified = simplify_cached(mesh, tolerance);
  std::array<std::vector<Cost>, 3> costs;
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < ways.size(); ++i)
      costs[i].push_back(cost_of(mesh, ways[i].second, tolerance, camera, count > 4 ? arguments[4] : "embree"));
  std::printf("%zu triangles, then %zu, at most %.3f pixels off\n", mesh.triangles.size(),
              simplified.mesh.triangles.size(), simplified.distance * pixels / size);
  std::printf("%-16s %10s %12s %10s %8s\n", "", "seconds", "processor s", "render s", "MB");
  for (std::size_t i = 0; i < ways.size(); ++i)
    std::printf("%-16s %10.3f %12.3f %10.3f %8.1f\n", ways[i].first, median(costs[i], &Cost::wall),
                median(costs[i], &Cost::processor), median(costs[i], &Cost::render), double(costs[i][0].bytes) / 1e6);
}
