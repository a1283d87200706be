#include "engine/measure/szecsi.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/render/cast.h"

namespace rayengine {
namespace {

using Method = GlassOptions::Method;

constexpr float glass_index = 1.5f;
constexpr int turns = 3;
/// Passes of the ray engine that are made for each generation: more are timed by a share of them.
constexpr std::size_t most_passes = 250;

struct Setup {
  std::size_t triangles;
  int size;
};
constexpr std::array setups{Setup{10, 256},   Setup{30, 256},   Setup{100, 256},  Setup{300, 256},
                            Setup{1000, 256}, Setup{3000, 256}, Setup{5000, 256}, Setup{10000, 256},
                            Setup{100, 512},  Setup{1000, 512}, Setup{5000, 512}};

/// Of the bodies, of which the first fills the view and the others stand behind it.
constexpr std::array<glm::dvec3, 5> places{{{0, 0, 0}, {.4, 2.3, .3}, {-1.1, 3, 1}, {1.2, 3, -1}, {-.9, 3, -1}}};

/// A ball with waves on it.
glm::dvec3 surface_point(double polar, double around) {
  const double radius = 1 + 0.2 * std::sin(3 * polar) * std::sin(4 * around);
  return radius * glm::dvec3(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), std::cos(polar));
}

/// Vertices on `bands` circles of `sides` and at two poles, which make 2 bands sides triangles.
Mesh body(std::uint32_t bands, std::uint32_t sides) {
  Mesh mesh;
  const std::uint32_t last = bands * sides + 1;
  mesh.positions.push_back(surface_point(0, 0));
  for (std::uint32_t i = 1; i <= bands; ++i)
    for (std::uint32_t k = 0; k < sides; ++k)
      mesh.positions.push_back(surface_point(std::numbers::pi * i / (bands + 1), 2 * std::numbers::pi * k / sides));
  mesh.positions.push_back(surface_point(std::numbers::pi, 0));
  const auto vertex = [&](std::uint32_t i, std::uint32_t k) {
    return i == 0 ? 0 : i > bands ? last : 1 + (i - 1) * sides + k % sides;
  };
  for (std::uint32_t i = 0; i <= bands; ++i)
    for (std::uint32_t k = 0; k < sides; ++k) {
      if (i > 0) mesh.triangles.push_back({vertex(i, k), vertex(i + 1, k), vertex(i, k + 1)});
      if (i < bands) mesh.triangles.push_back({vertex(i, k + 1), vertex(i + 1, k), vertex(i + 1, k + 1)});
    }
  return mesh;
}

/// At each vertex the mean of its triangles' normals, by area.
void smooth(Mesh& mesh) {
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0));
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
    for (int corner = 0; corner < 3; ++corner) sums[t[corner]] += glm::cross(b - a, c - a);
  }
  for (const glm::dvec3& sum : sums) mesh.normals.emplace_back(glm::normalize(sum));
}

/// A hall of arches: what glass distorts shows best before straight edges.
CastEnvironment environment() {
  CastEnvironment e{512, 256, {}};
  for (int y = 0; y < e.height; ++y)
    for (int x = 0; x < e.width; ++x) {
      const bool window = x % 32 > 7 && y > 64 && y < 144 && y % 40 > 4;
      const float up = 1 - static_cast<float>(y) / 255;
      e.colors.push_back(window ? glm::vec3(.9f, .95f, 1) * (.4f + .8f * up)
                                : glm::vec3(.42f, .24f, .12f) * (.3f + up));
    }
  return e;
}

double seconds(const CastSeconds& time, bool software) { return software ? time.processor : time.elapsed; }

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

void measure(const Setup& setup, int gpu, SzecsiResult& result) {
  const Scene scene = glass_bodies(setup.triangles, setup.size);
  const CastView view = cast_view(scene.camera);
  const int stride = static_cast<int>((setup.triangles + most_passes - 1) / most_passes);
  GlassCaster plain(scene.geometry, {&glass_index, 1}, environment(),
                    {.method = Method::ray_engine, .stride = stride, .device = gpu});
  GlassCaster hierarchical(scene.geometry, {&glass_index, 1}, environment(), {.device = gpu});
  result.device = plain.gpu().renderer;
  result.software = plain.gpu().software;
  std::vector<double> plainly, by_cones;
  for (int turn = 0; turn <= turns; ++turn) {  // the first warms up
    const double p = seconds(plain.time(view), result.software), h = seconds(hierarchical.time(view), result.software);
    if (turn > 0) plainly.push_back(p), by_cones.push_back(h);
  }
  const std::size_t triangles = scene.geometry->triangles.size();
  result.rows.push_back({triangles, setup.size, Method::ray_engine, 1 / median(plainly), stride});
  result.rows.push_back({triangles, setup.size, Method::hierarchical, 1 / median(by_cones), 1});
}

}  // namespace

Scene glass_bodies(std::size_t triangles, int size) {
  const std::size_t bodies = triangles < 100 ? 1 : triangles < 1000 ? 2 : places.size();
  const auto half = static_cast<std::uint32_t>(triangles / bodies / 2);
  auto bands = static_cast<std::uint32_t>(std::sqrt(half));
  while (bands > 1 && half % bands != 0) --bands;
  Mesh mesh = body(bands, half / bands);
  smooth(mesh);
  GeometryBuilder builder;
  for (std::size_t i = 0; i < bodies; ++i) builder.add(mesh, 0, Affine::translate(places[i]));
  Scene scene;
  scene.geometry = builder.build();
  scene.materials = {{.diffuse = 0, .transmit = 1, .ior = glass_index}};
  // No face of the first body, the coarsest included, is within 0.55 of its middle: more than a view of 12 degrees from
  // its axis to its corners holds at 2.4.
  scene.camera = {.from = {0, -2.4, 0}, .at = {0, 0, 0}, .fov = 17, .size = {size, size}};
  return scene;
}

SzecsiResult szecsi(const SzecsiOptions& options) {
  SzecsiResult result;
  for (const Setup& setup : setups) {
    measure(setup, options.gpu, result);
    if (options.progress) options.progress(static_cast<double>(result.rows.size()) / (2 * setups.size()));
  }
  return result;
}

std::vector<SzecsiCones> szecsi_cones(int gpu) {
  const Scene scene = glass_bodies(5000, 512);
  GlassCaster caster(scene.geometry, {&glass_index, 1}, environment(), {.device = gpu});
  std::vector<SzecsiCones> result;
  for (const int generation : {1, 2, 4, 8})
    result.push_back({generation, {32, 32}, caster.openings(cast_view(scene.camera), generation)});
  return result;
}

}  // namespace rayengine
