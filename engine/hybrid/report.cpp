#include "engine/hybrid/report.h"

#include "engine/schedule/split.h"

namespace rayengine {
namespace {

std::string name_of(WorkKind kind) {
  const char* names[] = {"primary", "shadow", "bounce"};
  return std::string(names[static_cast<std::size_t>(kind.ray_class)]) + (kind.any ? " any" : "");
}

HybridClassReport report_on(const KindCounts& counts, const CostModel& gpu, WorkKind kind, std::size_t threads,
                            const HybridReport& all) {
  HybridClassReport report{name_of(kind), counts.by_crew, counts.by_gpu};
  const double full = counts.alone(), processors = static_cast<double>(threads);
  if (full == 0) return report;
  report.rate_alone = processors / full;
  report.gpu_latency = gpu.latency(), report.gpu_per_ray = gpu.per_ray();
  report.achieved = report.rate_alone * (all.gpu_pays ? all.gain : 1);
  if (!gpu.known()) return report;
  const RayCosts costs{all.walk_share * full, full, gpu.per_ray(), processors};
  report.bound = best_split(costs).total();
  report.break_even = break_even(costs, gpu.latency());
  return report;
}

std::string reason(const RayPool& pool, const HybridReport& report) {
  if (pool.gpu_lost()) return "the GPU failed, and the processor went on alone";
  if (!report.decided) return "there was too little work to tell whether the GPU pays";
  if (report.gpu_pays) return "the GPU pays";
  return "the GPU costs the processor more than it brings";
}

}  // namespace

HybridReport report_on(const RayPool& pool, std::size_t threads, std::uint64_t alone_rays) {
  const PoolCounts counts = pool.counts();
  const GpuTrial trial = pool.trial();
  HybridReport report{.cpu_rays = alone_rays, .traced_twice = counts.twice};
  if (counts.crew_seconds > 0) report.scheduling_share = counts.scheduling_seconds / counts.crew_seconds;
  report.decided = trial.decided(), report.gpu_pays = trial.pays(), report.walk_share = trial.walk_share();
  report.gain = trial.gain();
  for (std::size_t i = 0; i < WorkKind::count; ++i) {
    const WorkKind kind{i % 2 == 1, static_cast<RayClass>(i / 2)};
    report.cpu_rays += counts.kinds[i].by_crew, report.gpu_rays += counts.kinds[i].by_gpu;
    if (counts.kinds[i].by_crew + counts.kinds[i].by_gpu > 0)
      report.classes.push_back(report_on(counts.kinds[i], pool.gpu_model(kind), kind, threads, report));
  }
  report.why = reason(pool, report);
  return report;
}

}  // namespace rayengine
