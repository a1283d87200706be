#include "engine/measure/measure_device.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "accel/random.h"
#include "accel/stopwatch.h"
#include "engine/measure/rays.h"
#include "engine/measure/tessellate.h"
#include "engine/plan/coarsen/coarsen.h"
#include "engine/plan/recognise/recognise.h"
#include "engine/query.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

constexpr int runs = 5;
constexpr int doublings = 10;      // between few primitives and many
constexpr int picture_side = 256;  // of the rays

/// As fast as it went once: what else the machine does only slows.
double best_seconds(const std::function<void()>& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int run = 0; run < runs; ++run) {
    const Stopwatch watch;
    work();
    best = std::min(best, watch.seconds());
  }
  return best;
}

/// So many balls in a cube, of a size that lets a few rays in a hundred through.
std::shared_ptr<const Geometry> balls(std::size_t count) {
  GeometryBuilder builder;
  const double radius = 0.5 / std::cbrt(static_cast<double>(count));
  for (std::size_t i = 0; i < count; ++i) {
    Random random(1, i);
    const glm::dvec3 at(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    builder.add(QuadricShape{}, 0, Affine::translate(at) * Affine::scale(glm::dvec3(radius)));
  }
  return builder.build();
}

/// One crumpled ball of so many triangles, which are as uneven as those of scans: a round one would flatter quick
/// builds.
std::shared_ptr<const Geometry> ball_mesh(int subdivisions) {
  Mesh ball = subdivided_sphere(subdivisions);
  for (glm::dvec3& p : ball.positions)
    p *= 1 + 0.3 * std::sin(11 * p.x) * std::cos(13 * p.y) + 0.1 * std::sin(41 * p.z) * std::cos(37 * p.x);
  GeometryBuilder builder;
  builder.add(ball);
  return builder.build();
}

std::vector<Ray> coherent_rays(const Geometry& geometry) {
  Camera camera;
  camera.size = {picture_side, picture_side};
  return primary_rays(framing_camera(geometry.bounds, camera));
}

struct Sample {
  double primitives, build, bytes, coherent, scattered;
};

Sample measure(const std::shared_ptr<const Geometry>& geometry, const TracerCost& of, int threads, Limits& limits) {
  const auto tracer =
      make_tracer(of.tracer, geometry, {.precision = of.precision, .threads = threads, .build = of.build});
  limits = tracer->limits();
  const std::vector<Ray> near = coherent_rays(*geometry), far = random_rays(geometry->bounds, near.size());
  std::vector<Hit> hits(near.size());
  const auto per_ray = [&](const std::vector<Ray>& rays, RayClass ray_class) {
    return best_seconds([&] { closest(*tracer, rays, hits, ray_class); }) / static_cast<double>(rays.size());
  };
  return {static_cast<double>(geometry->primitive_count), tracer->build_seconds(), static_cast<double>(tracer->bytes()),
          per_ray(near, RayClass::primary), per_ray(far, RayClass::bounce)};
}

/// A straight line in the logarithm of their number.
PrimitiveCost fit(const Sample& few, const Sample& many) {
  const double between = std::log2(many.primitives / few.primitives), below = std::log2(few.primitives);
  PrimitiveCost cost;
  cost.build = many.build / many.primitives;
  cost.bytes = many.bytes / many.primitives;
  const auto line = [&](double(&c)[2], double low, double high) {
    c[1] = std::max((high - low) / between, 0.0);
    c[0] = std::max(low - c[1] * below, 0.0);
  };
  line(cost.coherent, few.coherent, many.coherent);
  line(cost.scattered, few.scattered, many.scattered);
  return cost;
}

TracerCost measure(const std::string& name, Precision precision, Build build, int threads) {
  TracerCost cost{.tracer = name, .precision = precision, .build = build};
  Limits limits;
  const auto sample = [&](const std::shared_ptr<const Geometry>& geometry) {
    return measure(geometry, cost, threads, limits);
  };
  constexpr int few_subdivisions = 1, many_subdivisions = few_subdivisions + doublings / 2;
  cost.quadric = fit(sample(balls(32)), sample(balls(std::size_t{32} << doublings)));
  cost.triangle = fit(sample(ball_mesh(few_subdivisions)), sample(ball_mesh(many_subdivisions)));
  cost.triangle_roundoff = limits.triangle_roundoff;
  cost.quadric_roundoff = limits.quadric_roundoff;
  return cost;
}

/// Tubes without ends, in no whole piece.
Mesh open_tubes() {
  Mesh all;
  for (int i = 0; i < 64; ++i) {
    GeometryBuilder builder;
    builder.add(QuadricShape{QuadricType::cylinder}, 0, Affine::translate({3 * i, 0, 0}));
    const Mesh tube = mesh_of(*tessellate(*builder.build(), 5)->geometry, 0);
    const auto base = static_cast<std::uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), tube.positions.begin(), tube.positions.end());
    for (const glm::uvec3& t : tube.triangles) all.triangles.push_back(t + base);
  }
  return all;
}

/// A triangle.
double seconds_each(const Mesh& mesh, const std::function<void()>& work) {
  return best_seconds(work) / static_cast<double>(mesh.triangles.size());
}

}  // namespace

DeviceMeasurements measure_device(int threads) {
  DeviceMeasurements device;
  const auto add = [&](const char* name, Precision precision, Build build = Build::thorough) {
    device.tracers.push_back(measure(name, precision, build, threads));
  };
  add("embree", Precision::fast);
  add("embree", Precision::robust);
  add("embree", Precision::robust, Build::quick);
  add("bvh", Precision::robust);
  add("bvh", Precision::certified);
  const Mesh ball = subdivided_sphere(7), tubes = open_tubes();
  device.recognise_whole = seconds_each(ball, [&] { recognise(ball, 0.01, Pieces::whole); });
  device.recognise_parts = seconds_each(tubes, [&] { recognise(tubes, 0.01, Pieces::parts); });
  constexpr double sag = 0.025;  // of a ball of radius 1: leaves a sixth of its triangles
  GeometryBuilder builder;
  builder.add(ball);
  const auto geometry = builder.build();
  device.simplify = seconds_each(ball, [&] { coarsen(*geometry, 0, sag); });
  return device;
}

}  // namespace rayengine
