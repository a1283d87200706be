#include "engine/measure/chart.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "cpu/reference_tracer.h"
#include "engine/measure/every_tracer.h"
#include "engine/measure/race.h"
#include "engine/measure/rays.h"
#include "engine/measure/tessellate.h"
#include "engine/query.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

constexpr int chart_runs = 7;
constexpr std::size_t trial_rays = 512;
constexpr double longest_trial = 1, longest_run = 0.4;  // seconds
constexpr std::size_t chunk = 64;                       // neighbouring rays that stay together
constexpr glm::ivec2 largest_picture{256, 256};

struct Method {
  ChartRow row;
  Entry entry;
};

void add(std::vector<Method>& methods, std::unique_ptr<Contestant> contestant, int level) {
  Method method;
  method.row.method = contestant->name();
  method.row.precision = contestant->precision();
  method.row.level = level;
  method.row.build_seconds = contestant->build_seconds();
  method.row.bytes = contestant->bytes();
  method.entry.contestant = std::move(contestant);
  methods.push_back(std::move(method));
}

std::vector<Method> methods_for(const Scene& scene, const ChartOptions& options, std::vector<std::string>& left_out) {
  std::vector<Method> methods;
  for_every_tracer(left_out, [&](const std::string& name, Precision precision) {
    add(methods, make_contestant(make_tracer(name, scene.geometry, {precision, options.threads, options.gpu, {}})), 0);
  });
  for (int level = 1; level <= tessellation_levels; ++level)
    for (const Precision precision : {Precision::fast, Precision::robust}) {
      const std::string name = "embree-tess" + std::to_string(level);
      auto made = make_tessellated(name, scene.geometry, level, precision);
      if (made)
        add(methods, std::move(made), level);
      else
        left_out.push_back(name + " cannot hold this scene");
    }
  return methods;
}

/// Takes out who would keep all others waiting, and gives the rest as many rays as they can do in a short run.
void allot_rays(std::vector<Method>& methods, const RaySet& set, std::vector<std::string>& left_out) {
  const std::size_t count = std::min(trial_rays, set.rays.size());
  std::erase_if(methods, [&](Method& method) {
    Contestant& contestant = *method.entry.contestant;
    run_seconds(contestant, set, count);  // the first pays for what is made once
    const double seconds = std::max(run_seconds(contestant, set, count), 1e-9);
    const double affordable = longest_run / seconds * static_cast<double>(count);
    method.entry.rays = affordable < static_cast<double>(set.rays.size())
                            ? std::max(count, static_cast<std::size_t>(affordable))
                            : set.rays.size();
    const bool slow = seconds > longest_trial;
    if (slow)
      left_out.push_back(contestant.name() + " at " + std::string(to_string(contestant.precision())) +
                         " takes more than a second for 512 rays of this scene");
    return slow;
  });
}

/// What a light in the eye shows.
double brightness(const Hit& hit, const Ray& ray) {
  return hit.hit() ? std::abs(glm::dot(glm::dvec3(hit.normal), glm::normalize(ray.direction))) : 0;
}

void judge_last_run(Method& method, const RaySet& set, std::span<const Hit> exact, const Geometry& geometry) {
  const auto rays = std::span(set.rays).first(method.entry.rays);
  std::vector<Hit> hits;
  double squares = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hits.push_back(method.entry.contestant->hit(i));
    const double difference = brightness(hits[i], rays[i]) - brightness(exact[i], rays[i]);
    squares += difference * difference;
  }
  ChartRow& row = method.row;
  row.rays = rays.size();
  row.rmse = std::sqrt(squares / static_cast<double>(rays.size()));
  row.errors = judge({geometry, method.entry.contestant->limits(), rays, set.ray_class, hits, exact.first(rays.size())},
                     nullptr);
  std::ranges::sort(method.entry.rates);
  row.mrays_per_s = quantile(method.entry.rates, 0.5);
}

/// Errors of a method that never finds the right thing are as large as can be.
double typical_error(const ChartRow& row) {
  return row.errors.hits > 0 && row.wrong_share() < 0.5 ? row.errors.median_t_error : infinity;
}

void mark_front(std::vector<ChartRow>& rows) {
  for (ChartRow& row : rows)
    row.fastest_so_accurate = std::ranges::none_of(rows, [&](const ChartRow& other) {
      const bool as_good = other.mrays_per_s >= row.mrays_per_s && typical_error(other) <= typical_error(row);
      return as_good && (other.mrays_per_s > row.mrays_per_s || typical_error(other) < typical_error(row));
    });
}

/// Chunks in an order in which any first part is spread over the whole picture: every golden section of them.
std::vector<Ray> spread(const std::vector<Ray>& rays) {
  const std::size_t chunks = (rays.size() + chunk - 1) / chunk;
  auto stride = std::max<std::size_t>(static_cast<std::size_t>(0.618 * static_cast<double>(chunks)), 1);
  while (std::gcd(stride, chunks) != 1) ++stride;
  std::vector<Ray> result;
  result.reserve(rays.size());
  for (std::size_t i = 0, at = 0; i < chunks; ++i, at = (at + stride) % chunks)
    for (std::size_t k = chunk * at; k < std::min(chunk * (at + 1), rays.size()); ++k) result.push_back(rays[k]);
  return result;
}

RaySet camera_rays(const Scene& scene) {
  Camera camera = scene.camera;
  camera.size = glm::min(camera.size, largest_picture);
  return {"primary", RayClass::primary, false, spread(primary_rays(camera))};
}

}  // namespace

double ChartRow::wrong_share() const {
  return static_cast<double>(errors.wrong()) / static_cast<double>(std::max<std::uint64_t>(errors.rays, 1));
}

std::vector<ChartRow> chart(const Scene& scene, const ChartOptions& options, std::vector<std::string>& left_out) {
  const RaySet set = camera_rays(scene);
  std::vector<Hit> exact(set.rays.size());
  const auto reference = make_reference_tracer(scene.geometry);
  closest(*reference, set.rays, exact, set.ray_class);
  std::vector<Method> methods = methods_for(scene, options, left_out);
  allot_rays(methods, set, left_out);
  std::size_t done = 0;
  const auto step = [&] {
    if (options.progress)
      options.progress(static_cast<double>(++done) / static_cast<double>(methods.size() * (chart_runs + 1)));
  };
  for (Method& method : methods) run_seconds(*method.entry.contestant, set, method.entry.rays), step();
  for (int run = 0; run < chart_runs; ++run)
    for (Method& method : methods) time_run(method.entry, set), step();
  std::vector<ChartRow> rows;
  for (Method& method : methods) {
    judge_last_run(method, set, exact, *scene.geometry);
    rows.push_back(method.row);
  }
  mark_front(rows);
  return rows;
}

}  // namespace rayengine
