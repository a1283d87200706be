#include "accel/tracer.h"

#include <array>

namespace rayengine {
namespace {

constexpr std::array<std::string_view, 4> precision_names{"half", "fast", "robust", "certified"};

}  // namespace

std::string_view to_string(Precision precision) { return precision_names[static_cast<std::size_t>(precision)]; }

std::optional<Precision> parse_precision(std::string_view name) {
  for (std::size_t i = 0; i < precision_names.size(); ++i)
    if (precision_names[i] == name) return static_cast<Precision>(i);
  return std::nullopt;
}

void check_lengths(std::size_t rays, std::size_t answers) {
  if (rays != answers)
    throw Error("there are " + std::to_string(rays) + " rays and room for " + std::to_string(answers) + " answers");
}

}  // namespace rayengine
