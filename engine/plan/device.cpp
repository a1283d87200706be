#include "engine/plan/device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

namespace rayengine {
namespace {

constexpr std::array<std::string_view, 3> build_names{"thorough", "quick", "none"};
constexpr const char* heading = "rayengine-device-3";

std::vector<double*> numbers(TracerCost& c) {
  std::vector<double*> all{&c.start, &c.triangle_roundoff, &c.quadric_roundoff};
  for (PrimitiveCost* p : {&c.triangle, &c.quadric, &c.instance}) {
    all.insert(all.end(), {&p->build, &p->bytes});
    for (auto* three : {&p->counts, &p->coherent, &p->scattered})
      for (double& number : *three) all.push_back(&number);
  }
  return all;
}

/// What the time of a ray grows with.
double growth(Build build, double primitives) {
  return build == Build::none ? primitives : std::log2(std::max(primitives, 1.0));
}

[[noreturn]] void refuse() {
  throw Error("the measurements of this machine cannot be read: measure again, with rayengine plan --measure");
}

double read_number(std::istream& text) {
  double number = -1;
  if (!(text >> number) || !(number >= 0) || !std::isfinite(number)) refuse();
  return number;
}

TracerCost read_tracer(std::istream& text, const std::string& name) {
  TracerCost cost;
  std::string precision, build;
  text >> precision >> build >> cost.treelet;
  cost.tracer = name;
  const auto parsed = parse_precision(precision);
  const auto found = std::ranges::find(build_names, build);
  if (!text || !parsed || found == build_names.end()) refuse();
  cost.precision = *parsed;
  cost.build = static_cast<Build>(found - build_names.begin());
  for (double* number : numbers(cost)) *number = read_number(text);
  return cost;
}

}  // namespace

std::string_view to_string(Build build) { return build_names[static_cast<std::size_t>(build)]; }

double per_ray(const PrimitiveCost& cost, Build build, bool coherent, double primitives) {
  const auto& seconds = coherent ? cost.coherent : cost.scattered;
  const auto size = [&](std::size_t i) { return growth(build, cost.counts[i]); };
  const double here = std::max(growth(build, primitives), size(0));
  const std::size_t i = here < size(1) ? 0 : 1;
  const double between = size(i + 1) - size(i);
  return between > 0 ? seconds[i] + (seconds[i + 1] - seconds[i]) * (here - size(i)) / between : seconds[i];
}

std::string to_text(const DeviceMeasurements& device) {
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << heading << '\n' << device.recognise_whole << ' ' << device.recognise_parts << ' ' << device.simplify << '\n';
  for (TracerCost cost : device.tracers) {
    text << cost.tracer << ' ' << to_string(cost.precision) << ' ' << to_string(cost.build) << ' ' << cost.treelet;
    for (const double* number : numbers(cost)) text << ' ' << *number;
    text << '\n';
  }
  return text.str();
}

DeviceMeasurements device_from_text(const std::string& source) {
  std::istringstream text(source);
  std::string word;
  text >> word;
  if (word != heading) refuse();
  DeviceMeasurements device;
  device.recognise_whole = read_number(text);
  device.recognise_parts = read_number(text);
  device.simplify = read_number(text);
  while (text >> word) device.tracers.push_back(read_tracer(text, word));
  if (device.tracers.empty()) refuse();
  return device;
}

}  // namespace rayengine
