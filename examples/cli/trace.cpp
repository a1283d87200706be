#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <glm/geometric.hpp>
#include <iostream>

#include "accel/stopwatch.h"
#include "accel/surface.h"
#include "engine/load/atomic_file.h"
#include "engine/load/npy.h"
#include "engine/query.h"
#include "engine/tracers.h"
#include "examples/cli/cli.h"
#include "examples/cli/planning.h"
#include "examples/cli/progress.h"
#include "examples/cli/report.h"
#include "examples/cli/threads.h"

namespace rayengine::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  Common common;
  fs::path scene, rays, output, stats;
  std::string query = "closest";
  std::string tracer = "auto";
  std::optional<Precision> precision;
  PlanningOptions planning{.unit = Tolerance::Unit::scene};
};

fs::path offsets_file(fs::path output) { return output.replace_extension(".offsets.npy"); }

void check(const Options& o) {
  check_output(o.output);
  if (o.query == "all") check_output(offsets_file(o.output));
  if (!o.stats.empty()) check_output(o.stats);
}

/// Only single precision loses anything of what the files hold; the caller should know where it is used.
void say_rounding(const Options& o, const Geometry& geometry, const Tracer& tracer) {
  const Limits limits = tracer.limits();
  std::string what;
  if (limits.triangle_roundoff > 1e-12 && !geometry.triangles.empty()) what = "triangles";
  if (limits.quadric_roundoff > 1e-12 && !geometry.quadrics.empty())
    what += what.empty() ? "quadrics" : " and quadrics";
  if (!what.empty())
    note(o.common, fmt::format("the tracer '{}' at precision {} rounds rays to single precision to test {}",
                               tracer.name(), to_string(tracer.precision()), what));
}

/// `robust` decides what is hit; where it is hit is then worked out in double.
void refine_all(const Geometry& geometry, const Tracer& tracer, std::span<const Ray> rays,
                std::span<const std::uint64_t> offsets, std::span<Hit> hits) {
  if (tracer.precision() != Precision::robust) return;
  tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t ray) {
    const std::size_t first = offsets.empty() ? ray : offsets[ray], last = offsets.empty() ? ray + 1 : offsets[ray + 1];
    for (Hit& hit : hits.subspan(first, last - first))
      if (hit.hit()) hit = refine(geometry, rays[ray], hit);
  });
}

/// An any-hit query tells only whether: t is -inf on a hit, as Embree has it, and nothing is named.
HitLists any_hits(Tracer& tracer, std::span<const Ray> rays, const RaysDone& done) {
  std::vector<std::uint32_t> status(rays.size());
  any(tracer, rays, status, RayClass::bounce, done);
  HitLists lists{{}, std::vector<Hit>(rays.size())};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    lists.hits[i].status = status[i];
    if (status[i] & status_hit) lists.hits[i].t = -infinity;
  }
  return lists;
}

HitLists ask(const Options& o, Tracer& tracer, std::span<const Ray> rays) {
  Progress progress("trace", !o.common.quiet());
  std::atomic<std::size_t> done = 0;
  const RaysDone count = [&](std::size_t n) {
    progress.update(static_cast<double>(done += n) / static_cast<double>(rays.size()));
  };
  if (o.query == "all") return all(tracer, rays, count);
  if (o.query == "any") return any_hits(tracer, rays, count);
  HitLists lists{{}, std::vector<Hit>(rays.size())};
  closest(tracer, rays, lists.hits, RayClass::bounce, count);
  return lists;
}

struct Figures {
  double load = 0, trace = 0;
  std::size_t rays = 0, hits = 0, invalid = 0;

  double rate() const { return static_cast<double>(rays) / trace / 1e6; }
};

Json to_json(const Options& o, const Geometry& geometry, const MadeTracer& made, const Figures& figures,
             const Json& plan) {
  const Tracer& tracer = *made.tracer;
  return {{"scene", o.scene.string()},
          {"tracer", tracer.name()},
          {"precision", to_string(tracer.precision())},
          {"query", o.query},
          {"rays", figures.rays},
          {"hits", figures.hits},
          {"invalid_rays", figures.invalid},
          {"resolved_rays", tracer.resolved_rays()},
          {"mrays_per_s", figures.rate()},
          {"load_s", figures.load},
          {"build_s", tracer.build_seconds()},
          {"trace_s", figures.trace},
          {"bytes", tracer.bytes()},
          {"geometry_bytes", geometry.bytes()},
          {"peak_bytes", peak_memory()},
          {"plan", plan},
          {"shares", device_shares(tracer, made.said)},
          {"scheduler", scheduler_json(tracer)},
          {"device", device(thread_count(o.common.threads))}};
}

void write(const Options& o, const HitLists& lists) {
  if (o.query == "all") write_offsets(offsets_file(o.output), lists.offsets);
  write_hits(o.output, lists.hits);
}

/// Rays that cannot be asked are counted from the rays: lists of all hits have no place for them.
Figures count(std::span<const Ray> rays, std::span<const Hit> hits) {
  Figures figures;
  figures.rays = rays.size();
  figures.hits = static_cast<std::size_t>(std::ranges::count_if(hits, [](const Hit& hit) { return hit.hit(); }));
  figures.invalid =
      static_cast<std::size_t>(std::ranges::count_if(rays, [](const Ray& ray) { return !is_valid(ray); }));
  return figures;
}

/// Some of the rays that can be asked, spread evenly, with directions of unit length.
std::vector<Ray> sample(std::span<const Ray> rays, int count) {
  std::vector<Ray> some;
  const std::size_t step = std::max<std::size_t>(rays.size() / static_cast<std::size_t>(count), 1);
  for (std::size_t i = 0; i < rays.size(); i += step) {
    if (!is_valid(rays[i])) continue;
    const double length = glm::length(rays[i].direction);
    some.push_back({rays[i].origin, rays[i].tmin * length, rays[i].direction / length, rays[i].tmax * length});
  }
  return some;
}

int run(const Options& o) {
  check(o);
  const ThreadLimit limit(o.common.threads);
  const StartedThreads others(o.common.threads);
  const std::vector<Ray> rays = read_rays(o.rays);
  LoadedScene loaded = load(o.scene, o.common);
  const PlannedScene planned(o.planning, std::move(loaded.scene), static_cast<double>(rays.size()), false, o.common);
  const Geometry& geometry = *planned.scene().geometry;
  const MadeTracer made = planned.make_tracer(o.tracer, o.precision);
  const auto& tracer = made.tracer;
  say_rounding(o, geometry, *tracer);
  others.make_way();
  const Stopwatch watch;
  HitLists lists = ask(o, *tracer, rays);
  if (o.query != "any") refine_all(geometry, *tracer, rays, lists.offsets, lists.hits);
  const double seconds = watch.seconds();
  for (Hit& hit : lists.hits) hit.object = object_number(planned.scene().object_numbers, hit.object);
  Json plan = planned.json();
  if (o.planning.verify > 0) plan["verified"] = planned.verify(*tracer, sample(rays, o.planning.verify));
  write(o, lists);
  Figures figures = count(rays, lists.hits);
  figures.load = loaded.seconds, figures.trace = seconds;
  if (!o.stats.empty()) write_json(o.stats, to_json(o, geometry, made, figures, plan));
  if (!o.common.quiet())
    std::cerr << fmt::format("{}: {} rays, {} hits, {} invalid, {} ({:.3g} Mrays/s), tracer {}, precision {}\n",
                             o.output.string(), count_text(figures.rays), count_text(figures.hits),
                             count_text(figures.invalid), seconds_text(seconds), figures.rate(), tracer->name(),
                             to_string(tracer->precision()));
  return 0;
}

}  // namespace

void add_trace(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* sub = add_subcommand(
      app, "trace", "Trace rays from a NumPy file",
      "  rayengine trace bunny.ply --rays rays.npy -o hits.npy\n"
      "  rayengine trace scenes/glass.json --rays rays.npy -o hits.npy --query all --tracer reference\n\n"
      "RAYS.npy: float32 or float64, C order, shape (N, 8): ox oy oz tmin dx dy dz tmax; a hit has tmin < t <= tmax.\n"
      "HITS.npy: a structured array: t f8, object u4, primitive u4, u f4, v f4, nx ny nz f4, error f8, status u4.\n"
      "  On a miss t is inf and the ids are 0xFFFFFFFF. status: bit 0 hit, 1 invalid ray, 2 exact tie, 3 re-solved.\n"
      "  --query any: only status is told; t is -inf on a hit and inf on a miss, ids are 0xFFFFFFFF.\n"
      "  --query all: every hit, sorted by t; HITS.offsets.npy (u8, N+1) says where each ray's hits begin and end.",
      options->common);
  add_scene(sub, options->scene)->required();
  sub->add_option("--rays", options->rays, "Rays to trace")->type_name("RAYS.npy")->required();
  sub->add_option("-o,--output", options->output, "Hits to write")->type_name("HITS.npy")->required();
  sub->add_option("--query", options->query, "Nearest hit, whether anything is hit, or every hit")
      ->type_name("closest|any|all")
      ->check(CLI::IsMember({"closest", "any", "all"}));
  add_tracer(sub, options->tracer);
  add_precision(sub, options->precision);
  add_planning(sub, options->planning);
  sub->add_option("--stats", options->stats, "JSON file with times, rays and memory")->type_name("FILE");
  sub->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace rayengine::cli
