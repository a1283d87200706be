#include "engine/measure/bench.h"

#include <algorithm>
#include <optional>

#include "cpu/reference_tracer.h"
#include "engine/batched.h"
#include "engine/measure/race.h"
#include "engine/measure/rays.h"
#include "engine/tracers.h"

namespace rayengine {
namespace {

constexpr std::size_t sample_rays = 2048;  // checked against the oracle

/// At most `most` rays: whole runs of neighbours, spread evenly, so that what is coherent stays so.
std::vector<Ray> thin(std::vector<Ray> rays, std::size_t most) {
  if (rays.size() <= most) return rays;
  const double keep = static_cast<double>(most) / static_cast<double>(rays.size());
  std::vector<Ray> kept;
  for (std::size_t first = 0; first < rays.size(); first += probe_rays) {
    const double wanted = keep * static_cast<double>(first + probe_rays);
    if (static_cast<double>(kept.size() + probe_rays) > wanted) continue;
    const std::size_t last = std::min(first + probe_rays, rays.size());
    kept.insert(kept.end(), rays.begin() + static_cast<std::ptrdiff_t>(first),
                rays.begin() + static_cast<std::ptrdiff_t>(last));
  }
  return kept;
}

std::vector<RaySet> ray_sets(const Scene& scene, const BenchOptions& options) {
  const auto tracer = make_tracer("auto", scene.geometry, {Precision::robust, options.threads});
  Camera camera = scene.camera;
  camera.size = options.size;
  std::vector<RaySet> sets{{"primary", RayClass::primary, false, primary_rays(camera)}};
  const std::vector<Ray>& primary = sets[0].rays;
  std::vector<Hit> hits(primary.size());
  closest(*tracer, primary, hits, RayClass::primary);
  std::vector<Ray> shadow = thin(shadow_rays(scene, primary, hits), primary.size());
  std::vector<Ray> bounce = bounce_rays(*scene.geometry, primary, hits);
  std::vector<Ray> random = random_rays(scene.geometry->bounds, primary.size());
  sets.push_back({"shadow", RayClass::shadow, true, std::move(shadow)});
  sets.push_back({"bounce", RayClass::bounce, false, std::move(bounce)});
  sets.push_back({"random", RayClass::bounce, false, std::move(random)});
  std::erase_if(sets, [](const RaySet& set) { return set.rays.empty(); });
  return sets;
}

bool known(const std::vector<Entry>& entries, const Contestant& contestant) {
  return std::ranges::any_of(entries, [&](const Entry& entry) {
    return entry.contestant->name() == contestant.name() && entry.contestant->precision() == contestant.precision();
  });
}

std::vector<Entry> make_entries(const Scene& scene, const BenchOptions& options, std::vector<std::string>& left_out) {
  std::vector<Entry> entries;
  for (const Precision precision : options.precisions)
    for (const std::string& name : options.tracers) try {
        auto contestant = make_contestant(name, scene.geometry, precision, options.threads);
        if (!contestant)
          left_out.push_back(name + " at precision " + std::string(to_string(precision)) + " cannot hold this scene");
        else if (!known(entries, *contestant))
          entries.push_back({std::move(contestant), 0, {}});
      } catch (const Error& error) {
        left_out.push_back(error.what());
      }
  if (entries.empty())
    throw Error("there is nothing to measure: " + (left_out.empty() ? "no tracer was named" : left_out.front()));
  return entries;
}

/// An any-hit answer as a nearest hit that can be compared: the oracle's own where both say the same.
Hit as_hit(std::uint32_t status, const Hit& exact, const Ray& ray) {
  if ((status & status_hit) == (exact.status & status_hit)) return exact;
  Hit hit;
  hit.status = status;
  if (hit.hit()) hit.t = ray.tmin;
  return hit;
}

/// Judges the answers of the last run on rays spread evenly over it.
Comparison check(const Contestant& contestant, const RaySet& set, std::size_t timed, Tracer& oracle,
                 const Geometry& geometry) {
  const std::size_t step = std::max<std::size_t>(timed / sample_rays, 1);
  std::vector<Ray> rays;
  std::vector<std::size_t> from;
  for (std::size_t i = 0; i < timed; i += step) rays.push_back(set.rays[i]), from.push_back(i);
  std::vector<Hit> hits(rays.size()), exact(rays.size());
  closest(oracle, rays, exact, set.ray_class);
  for (std::size_t i = 0; i < rays.size(); ++i)
    hits[i] = set.any ? as_hit(contestant.status(from[i]), exact[i], rays[i]) : contestant.hit(from[i]);
  return judge({geometry, contestant.limits(), rays, set.ray_class, hits, exact}, &oracle);
}

BenchRow to_row(Entry& entry, const RaySet& set) {
  std::ranges::sort(entry.rates);
  const Contestant& contestant = *entry.contestant;
  BenchRow row;
  row.tracer = contestant.name();
  row.precision = contestant.precision();
  row.ray_class = set.name;
  row.rays = entry.rays;
  row.mrays_per_s = quantile(entry.rates, 0.5);
  row.mrays_per_s_iqr = quantile(entry.rates, 0.75) - quantile(entry.rates, 0.25);
  row.build_seconds = contestant.build_seconds();
  row.bytes = contestant.bytes();
  return row;
}

/// Tells what share of `steps` equal steps is done.
class Steps {
 public:
  Steps(const BenchOptions& options, std::size_t steps) : options_(options), steps_(steps) {}
  void done() {
    if (options_.progress) options_.progress(static_cast<double>(++done_) / static_cast<double>(steps_));
  }

 private:
  const BenchOptions& options_;
  std::size_t steps_, done_ = 0;
};

}  // namespace

std::vector<BenchRow> bench(const Scene& scene, const BenchOptions& options, std::vector<std::string>& left_out) {
  std::vector<Entry> entries = make_entries(scene, options, left_out);
  const std::vector<RaySet> sets = ray_sets(scene, options);
  const auto reference = make_reference_tracer(scene.geometry);
  Batched oracle(*reference);
  Steps steps(options, sets.size() * entries.size() * (timed_runs + 2));
  std::vector<BenchRow> rows;
  for (const RaySet& set : sets) {
    for (Entry& entry : entries) warm_up(entry, set), steps.done();
    for (int run = 0; run < timed_runs; ++run)
      for (Entry& entry : entries) time_run(entry, set), steps.done();
    for (Entry& entry : entries) {
      rows.push_back(to_row(entry, set));
      rows.back().errors = check(*entry.contestant, set, entry.rays, oracle, *scene.geometry);
      steps.done();
    }
  }
  return rows;
}

}  // namespace rayengine
