#include "examples/cli/report.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <fstream>

#include "accel/isa/isa.h"
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

void write_json(const std::filesystem::path& file, const Json& json) {
  AtomicFile out(file);
  out.write(json.dump(2) + '\n');
  out.commit();
}

Json device(int threads) {
  return {{"processor", processor()},
          {"threads", threads},
          {"isa", to_string(best_isa())},
          {"embree", RTC_VERSION_STRING},
          {"rayengine", RAYENGINE_VERSION}};
}

Json device_shares(const Tracer& tracer) {
  const std::string where = device_of(tracer);
  return Json::array({{{"device", where},
                       {"share", 1.0},
                       {"why", fmt::format("the tracer '{}' answers every ray on the {}", tracer.name(), where)}}});
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
