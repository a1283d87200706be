#include "examples/cli/report.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "accel/isa/isa.h"
#include "engine/hybrid/hybrid_tracer.h"
#include "engine/load/atomic_file.h"
#include "engine/tracers.h"

namespace rayengine::cli {
namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

/// The list of tracers begins its summaries with it.
std::string device_of(const Tracer& tracer) {
  for (const TracerInfo& info : tracer_list())
    if (info.name == tracer.name()) return std::string(info.summary.substr(0, info.summary.find(':')));
  return "unknown";
}

}  // namespace

void write_text(const std::filesystem::path& file, const std::string& text) {
  AtomicFile out(file);
  out.write(text);
  out.commit();
}

void write_json(const std::filesystem::path& file, const Json& json) { write_text(file, json.dump(2) + '\n'); }

Json device(int threads) {
  return {{"processor", processor()},
          {"threads", threads},
          {"isa", to_string(best_isa())},
          {"embree", RTC_VERSION_STRING},
          {"rayengine", RAYENGINE_VERSION}};
}

Json device_shares(const Tracer& tracer, const std::string& said) {
  if (const auto* hybrid = dynamic_cast<const Hybrid*>(&tracer)) {
    const HybridReport report = hybrid->report();
    const double all = static_cast<double>(std::max<std::uint64_t>(report.cpu_rays + report.gpu_rays, 1));
    return Json::array(
        {{{"device", "CPU"}, {"share", static_cast<double>(report.cpu_rays) / all}, {"why", report.why}},
         {{"device", "GPU"}, {"share", static_cast<double>(report.gpu_rays) / all}, {"why", report.why}}});
  }
  const std::string where = device_of(tracer);
  const std::string why = fmt::format("the tracer '{}' answers every ray on the {}", tracer.name(), where);
  return Json::array({{{"device", where}, {"share", 1.0}, {"why", said.empty() ? why : said}}});
}

Json scheduler_json(const Tracer& tracer) {
  const auto* hybrid = dynamic_cast<const Hybrid*>(&tracer);
  if (!hybrid) return nullptr;
  const HybridReport report = hybrid->report();
  Json classes = Json::array();
  for (const HybridClassReport& c : report.classes)
    classes.push_back({{"class", c.kind},
                       {"cpu_rays", c.cpu_rays},
                       {"gpu_rays", c.gpu_rays},
                       {"mrays_per_s_alone", 1e-6 * c.rate_alone},
                       {"mrays_per_s_achieved", 1e-6 * c.achieved},
                       {"mrays_per_s_bound", 1e-6 * c.bound},
                       {"gpu_latency_s", c.gpu_latency},
                       {"gpu_s_per_ray", c.gpu_per_ray},
                       {"break_even_rays", c.break_even}});
  return {{"why", report.why},
          {"gpu_pays", report.gpu_pays},
          {"gain", report.gain},
          {"walk_share", report.walk_share},
          {"traced_twice", report.traced_twice},
          {"scheduling_share", report.scheduling_share},
          {"classes", classes}};
}

std::string scheduler_text(const Tracer& tracer) {
  const auto* hybrid = dynamic_cast<const Hybrid*>(&tracer);
  if (!hybrid) return {};
  const HybridReport report = hybrid->report();
  std::string text = fmt::format("{}: CPU {} rays, GPU {}, {} of them traced by both; scheduling {:.2g} % of tracing",
                                 report.why, count_text(report.cpu_rays), count_text(report.gpu_rays),
                                 count_text(report.traced_twice), 100 * report.scheduling_share);
  if (report.decided)
    text += fmt::format("\n  with the GPU {:.3g} times the rate without; a ray sent costs {:.3g} of one traced",
                        report.gain, report.walk_share);
  for (const HybridClassReport& c : report.classes) {
    text += fmt::format("\n  {}: {:.3g} Mrays/s without the GPU", c.kind, 1e-6 * c.rate_alone);
    if (c.bound == 0) continue;
    text += fmt::format(", {:.3g} now, {:.3g} at most; the GPU takes {:.3g} ms + {:.3g} ns a ray, so a batch pays {}",
                        1e-6 * c.achieved, 1e-6 * c.bound, 1e3 * c.gpu_latency, 1e9 * c.gpu_per_ray,
                        std::isfinite(c.break_even) ? fmt::format("from {:.0f} rays", c.break_even) : "never");
  }
  return text;
}

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::string bytes_text(double bytes) {
  for (const char* unit : {"bytes", "kB", "MB", "GB"}) {
    if (bytes < 1000) return fmt::format("{:.3g} {}", bytes, unit);
    bytes /= 1000;
  }
  return fmt::format("{:.3g} TB", bytes);
}

std::string seconds_text(double value) {
  return value < 1 ? fmt::format("{:.3g} ms", 1e3 * value) : fmt::format("{:.3g} s", value);
}

std::string count_text(std::uint64_t n) {
  const std::string digits = std::to_string(n);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

}  // namespace rayengine::cli
