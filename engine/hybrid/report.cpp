#include "engine/hybrid/report.h"

#include "engine/schedule/split.h"

namespace rayengine {
namespace {

std::string name_of(WorkKind kind) {
  const char* names[] = {"primary", "shadow", "bounce"};
  return std::string(names[static_cast<std::size_t>(kind.ray_class)]) + (kind.any ? " any" : "");
}

HybridClassReport report_on(const RayPool& pool, WorkKind kind, std::size_t threads) {
  const GpuTrial trial = pool.trial(kind);
  const CostModel model = pool.gpu_model(kind);
  HybridClassReport report{.kind = name_of(kind), .decided = trial.decided(), .gpu_pays = trial.pays()};
  report.rate_alone = trial.rate_alone(), report.rate_crew = trial.rate_crew(), report.rate_gpu = trial.rate_gpu();
  report.gpu_latency = model.latency(), report.gpu_per_ray = model.per_ray(), report.walk_share = trial.walk_share();
  if (report.rate_alone == 0 || !model.known()) return report;
  const double full = static_cast<double>(threads) / report.rate_alone;
  const RayCosts costs{report.walk_share * full, full, model.per_ray(), static_cast<double>(threads)};
  report.bound = best_split(costs).total();
  report.break_even = break_even(costs, model.latency());
  return report;
}

std::string reason(const RayPool& pool, const std::vector<HybridClassReport>& classes) {
  if (pool.gpu_lost()) return "the GPU failed, and the processor went on alone";
  std::string pays, not_yet, not_at_all;
  for (const HybridClassReport& c : classes) {
    std::string& list = c.gpu_pays ? pays : c.decided ? not_at_all : not_yet;
    list += (list.empty() ? "" : ", ") + c.kind;
  }
  std::string text = pays.empty() ? "" : "the GPU pays for " + pays + " rays";
  if (!not_at_all.empty()) text += (text.empty() ? "" : "; ") + ("it costs more than it brings for " + not_at_all);
  if (!not_yet.empty()) text += (text.empty() ? "" : "; ") + ("too few rays to tell for " + not_yet);
  return text;
}

}  // namespace

HybridReport report_on(const RayPool& pool, std::size_t threads, std::uint64_t alone_rays) {
  const PoolCounts counts = pool.counts();
  HybridReport report{counts.by_crew + alone_rays, counts.by_gpu, counts.twice};
  if (counts.crew_seconds > 0) report.scheduling_share = counts.scheduling_seconds / counts.crew_seconds;
  for (std::size_t i = 0; i < WorkKind::count; ++i) {
    const WorkKind kind{i % 2 == 1, static_cast<RayClass>(i / 2)};
    if (pool.trial(kind).rate_alone() > 0) report.classes.push_back(report_on(pool, kind, threads));
  }
  report.why = reason(pool, report.classes);
  return report;
}

}  // namespace rayengine
