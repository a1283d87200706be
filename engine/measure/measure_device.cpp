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

constexpr int runs = 5, fewest_runs = 2;
constexpr double enough = 0.5;     // seconds
constexpr int picture_side = 256;  // of the rays

/// As fast as it went once: what else the machine does only slows. The first run may be one of cold caches.
double best_seconds(const std::function<void()>& work) {
  double best = std::numeric_limits<double>::infinity();
  const Stopwatch all;
  for (int run = 0; run < runs && (run < fewest_runs || all.seconds() < enough); ++run) {
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

/// One crumpled ball of 8 triangles, cut in four so many times, which are as uneven as those of scans: a round one
/// would flatter quick builds.
std::shared_ptr<const Geometry> ball_mesh(std::size_t subdivisions) {
  Mesh ball = subdivided_sphere(static_cast<int>(subdivisions));
  for (glm::dvec3& p : ball.positions)
    p *= 1 + 0.3 * std::sin(11 * p.x) * std::cos(13 * p.y) + 0.1 * std::sin(41 * p.z) * std::cos(37 * p.x);
  GeometryBuilder builder;
  builder.add(ball);
  return builder.build();
}

/// So many instances of a ball of 32 triangles, where the balls would be.
std::shared_ptr<const Geometry> instances(std::size_t count) {
  GeometryBuilder group, builder;
  group.add(subdivided_sphere(1));
  const std::shared_ptr<const Geometry> ball = group.build(), places = balls(count);
  for (const Quadric& q : places->quadrics) builder.add(ball, object_to_world(q.to_object));
  return builder.build();
}

/// Seen from outside, filling a third of it, and lit from beside the eye.
Scene picture_of(const std::shared_ptr<const Geometry>& geometry) {
  constexpr double wider = 1.3;
  Scene scene;
  scene.geometry = geometry;
  scene.camera.size = {picture_side, picture_side};
  scene.camera = framing_camera(geometry->bounds, scene.camera);
  scene.camera.fov *= wider;
  scene.lights = {{.position = scene.camera.from + glm::dvec3(geometry->bounds.extent())}};
  return scene;
}

/// By the threads and the GPU of `where`.
TracerOptions options_of(const TracerCost& cost, const TracerOptions& where) {
  return {.precision = cost.precision,
          .threads = where.threads,
          .gpu = where.gpu,
          .build = cost.build,
          .treelet = cost.treelet};
}

struct Sample {
  double primitives = 0, build = 0, bytes = 0, coherent = 0, scattered = 0;
};

/// Seconds a ray that a picture is expected to ask for, see expected_rays(): what hits nothing asks for no light.
double of_picture(Tracer& tracer, const Scene& scene) {
  const std::vector<Ray> primary = primary_rays(scene.camera);
  std::vector<Hit> hits(primary.size());
  const double to_see = best_seconds([&] { closest(tracer, primary, hits, RayClass::primary); });
  const std::vector<Ray> shadow = shadow_rays(scene, primary, hits);
  std::vector<std::uint32_t> status(shadow.size());
  const double to_light = best_seconds([&] { any(tracer, shadow, status, RayClass::shadow); });
  return (to_see + to_light) / expected_rays(scene, 1);
}

double of_chords(Tracer& tracer, const Box& bounds) {
  const std::vector<Ray> rays = random_rays(bounds, picture_side * picture_side);
  std::vector<Hit> hits(rays.size());
  return best_seconds([&] { closest(tracer, rays, hits, RayClass::bounce); }) / static_cast<double>(rays.size());
}

Sample measure(const std::shared_ptr<const Geometry>& geometry, const TracerCost& of, const TracerOptions& where,
               Limits& limits) {
  const auto tracer = make_tracer(of.tracer, geometry, options_of(of, where));
  limits = tracer->limits();
  const std::size_t primitives = geometry->instances.empty() ? geometry->primitive_count : geometry->instances.size();
  return {.primitives = static_cast<double>(primitives),
          .build = tracer->build_seconds(),
          .bytes = static_cast<double>(tracer->bytes()),
          .coherent = of_picture(*tracer, picture_of(geometry)),
          .scattered = of_chords(*tracer, geometry->bounds)};
}

PrimitiveCost cost_of(const std::array<Sample, 3>& samples) {
  const Sample& many = samples.back();
  PrimitiveCost cost{.build = many.build / many.primitives, .bytes = many.bytes / many.primitives};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    cost.counts[i] = samples[i].primitives;
    const std::size_t fewer = i > 0 ? i - 1 : 0;  // more of them are no faster, whatever a busy machine says
    cost.coherent[i] = std::max(samples[i].coherent, cost.coherent[fewer]);
    cost.scattered[i] = std::max(samples[i].scattered, cost.scattered[fewer]);
  }
  return cost;
}

void measure(TracerCost& cost, const TracerOptions& where) {
  Limits limits;
  const auto among = [&](const auto& make, std::array<std::size_t, 3> sizes) {
    std::array<Sample, 3> samples{};
    for (std::size_t i = 0; i < sizes.size(); ++i) samples[i] = measure(make(sizes[i]), cost, where, limits);
    return cost_of(samples);
  };
  // Without a structure there can only be few.
  const bool few = cost.build == Build::none;
  cost.quadric = few ? among(balls, {1, 8, 32}) : among(balls, {8, 1 << 8, 1 << 13});
  cost.triangle = few ? among(ball_mesh, {0, 1, 2}) : among(ball_mesh, {0, 2, 5});
  if (!few) cost.instance = among(instances, {8, 1 << 8, 1 << 13});
  cost.triangle_roundoff = limits.triangle_roundoff;
  cost.quadric_roundoff = limits.quadric_roundoff;
}

/// Than what was built with more care: where there is little to build either way, less is luck.
void be_no_faster(TracerCost& quick, const TracerCost& thorough) {
  const auto raise = [](PrimitiveCost& cost, const PrimitiveCost& least) {
    for (std::size_t i = 0; i < cost.counts.size(); ++i) {
      cost.coherent[i] = std::max(cost.coherent[i], least.coherent[i]);
      cost.scattered[i] = std::max(cost.scattered[i], least.scattered[i]);
    }
  };
  raise(quick.triangle, thorough.triangle);
  raise(quick.quadric, thorough.quadric);
  raise(quick.instance, thorough.instance);
}

/// Before it builds anything: contexts and kernels of the GPU.
double seconds_to_start(const TracerCost& of, const TracerOptions& where) {
  const std::shared_ptr<const Geometry> one = ball_mesh(0);
  const Stopwatch watch;
  make_tracer(of.tracer, one, options_of(of, where));
  return watch.seconds();
}

/// Those that need a GPU, or a renderer in software that takes its part; none where there is neither. Whoever is first
/// starts the driver.
std::vector<TracerCost> tracers_of_gpu(const TracerOptions& where) {
  std::vector<TracerCost> costs{{.tracer = "grid"}};
  for (const std::uint32_t treelet : {16, 64, 512}) costs.push_back({.tracer = "stream", .treelet = treelet});
  try {
    const double start = seconds_to_start(costs.front(), where);
    for (TracerCost& cost : costs) {
      cost.start = start;
      measure(cost, where);
    }
  } catch (const Error&) {
    return {};
  }
  return costs;
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

DeviceMeasurements measure_device(const TracerOptions& where) {
  DeviceMeasurements device;
  const auto add = [&](const char* name, Precision precision, Build build = Build::thorough) {
    measure(device.tracers.emplace_back(TracerCost{.tracer = name, .precision = precision, .build = build}), where);
  };
  add("embree", Precision::fast);
  add("embree", Precision::robust);
  add("embree", Precision::robust, Build::quick);
  be_no_faster(device.tracers[2], device.tracers[1]);
  add("bvh", Precision::robust);
  add("bvh", Precision::robust, Build::none);
  add("bvh", Precision::certified);
  for (TracerCost& cost : tracers_of_gpu(where)) device.tracers.push_back(std::move(cost));
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
