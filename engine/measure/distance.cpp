#include <cmath>

#include "accel/kernels/kernels.h"
#include "cpu/reference_tracer.h"
#include "engine/measure/chart.h"
#include "engine/measure/every_tracer.h"
#include "engine/measure/stress/aim.h"
#include "engine/measure/stress/shapes.h"
#include "engine/query.h"

namespace rayengine {
namespace {

constexpr std::size_t rays_each = 10'000;

/// Rays from one distance, and the exact answers.
struct Step {
  double distance;
  std::vector<Ray> rays;
  std::vector<Hit> exact;
};

std::vector<Step> make_steps(Tracer& oracle) {
  std::vector<Step> steps;
  for (int halves = 2; halves <= 18; ++halves) {
    Step step{std::pow(10, .5 * halves), {}, std::vector<Hit>(rays_each)};
    step.rays = stability::at_disc(glm::dvec3(0), 1.2, step.distance, rays_each, 1);
    closest(oracle, step.rays, step.exact, RayClass::bounce);
    steps.push_back(std::move(step));
  }
  return steps;
}

template <class REAL>
kernels::Vec3<REAL> rounded(const glm::dvec3& v) {
  return {static_cast<REAL>(v.x), static_cast<REAL>(v.y), static_cast<REAL>(v.z)};
}

/// The quadratic of the unit sphere by our own kernels, either from the ray's origin, as textbooks have it, or from the
/// point closest to the centre.
template <class REAL, bool shifted>
Hit bare_quadratic(const Ray& ray) {
  const kernels::Vec3<REAL> o = rounded<REAL>(ray.origin), d = rounded<REAL>(ray.direction);
  kernels::Vec3<REAL> p = o;
  REAL shift = 0, a, b, c, near, far;
  if (shifted) kernels::approach(o, d, p, shift);
  kernels::diagonal_coefficients<REAL>(1, 1, 1, 0, -1, p, d, a, b, c);
  kernels::roots(a, b, c, near, far);
  if (near == std::numeric_limits<REAL>::max()) return {};
  return {.t = static_cast<double>(near + shift), .object = 0, .primitive = 0, .status = status_hit};
}

using Answer = Hit (*)(const Ray&);

struct Formula {
  const char* name;
  double roundoff;
  Answer answer;
};
constexpr Formula formulas[]{{"b^2-ac in float", 0x1p-24, bare_quadratic<float, false>},
                             {"b^2-ac in double", 0x1p-53, bare_quadratic<double, false>},
                             {"shifted in float", 0x1p-24, bare_quadratic<float, true>}};

DistanceRow row_of(const std::string& method, std::optional<Precision> precision, const Limits& limits,
                   const Geometry& geometry, const Step& step, std::span<const Hit> hits) {
  const Comparison c = judge({geometry, limits, step.rays, RayClass::bounce, hits, step.exact}, nullptr);
  return {method,
          precision,
          step.distance,
          static_cast<double>(c.wrong()) / static_cast<double>(c.rays),
          c.max_point_error,
          limits.quadric_roundoff};
}

}  // namespace

std::vector<DistanceRow> distance_sweep(const ChartOptions& options, std::vector<std::string>& left_out) {
  const auto geometry = stability::alone(QuadricShape{.type = QuadricType::sphere});
  const std::vector<Step> steps = make_steps(*make_reference_tracer(geometry));
  std::vector<DistanceRow> rows;
  std::vector<Hit> hits(rays_each);
  for (const Formula& formula : formulas)
    for (const Step& step : steps) {
      for (std::size_t i = 0; i < rays_each; ++i) hits[i] = formula.answer(step.rays[i]);
      const Limits limits{.triangle_roundoff = formula.roundoff, .quadric_roundoff = formula.roundoff};
      rows.push_back(row_of(formula.name, {}, limits, *geometry, step, hits));
    }
  for_every_tracer(left_out, [&](const std::string& name, Precision precision) {
    const auto tracer = make_tracer(name, geometry, {precision, options.threads, options.gpu, {}});
    for (const Step& step : steps) {
      hits.assign(rays_each, unanswered());
      closest(*tracer, step.rays, hits, RayClass::bounce);
      rows.push_back(row_of(name, precision, tracer->limits(), *geometry, step, hits));
    }
  });
  return rows;
}

}  // namespace rayengine
