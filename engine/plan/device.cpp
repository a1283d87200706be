#include "engine/plan/device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

namespace rayengine {
namespace {

constexpr std::array build_names{"thorough", "quick"};
constexpr const char* heading = "rayengine-device-2";

std::array<double*, 14> numbers(TracerCost& c) {
  return {&c.triangle_roundoff,    &c.quadric_roundoff,     &c.triangle.build,        &c.triangle.bytes,
          &c.triangle.coherent[0], &c.triangle.coherent[1], &c.triangle.scattered[0], &c.triangle.scattered[1],
          &c.quadric.build,        &c.quadric.bytes,        &c.quadric.coherent[0],   &c.quadric.coherent[1],
          &c.quadric.scattered[0], &c.quadric.scattered[1]};
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
  text >> precision >> build;
  cost.tracer = name;
  const auto parsed = parse_precision(precision);
  if (!parsed || std::ranges::find(build_names, build) == build_names.end()) refuse();
  cost.precision = *parsed;
  cost.build = build == build_names[0] ? Build::thorough : Build::quick;
  for (double* number : numbers(cost)) *number = read_number(text);
  return cost;
}

}  // namespace

std::string_view to_string(Build build) { return build_names[build == Build::quick]; }

std::string to_text(const DeviceMeasurements& device) {
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << heading << '\n' << device.recognise_whole << ' ' << device.recognise_parts << ' ' << device.simplify << '\n';
  for (TracerCost cost : device.tracers) {
    text << cost.tracer << ' ' << to_string(cost.precision) << ' ' << to_string(cost.build);
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
