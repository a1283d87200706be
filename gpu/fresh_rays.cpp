#include "gpu/fresh_rays.h"

#include <string>
#include <vector>

#include "accel/tracer.h"

namespace rayengine {
namespace {

/// Small vertices have 14 bits for each coordinate.
constexpr int widest = 1 << 14;
constexpr std::uint32_t fresh_role = 15;

void append(std::vector<glm::uvec4>& to, RayFormat format, std::uint32_t x, std::uint32_t y) {
  const std::uint32_t place = x | y << 14;
  switch (format) {
    case RayFormat::fat: to.insert(to.end(), {{x, y, 0, 0}, {}, {}, {}}); break;
    case RayFormat::packed: to.insert(to.end(), {{0, 0, 0, place | fresh_role << 28}, {}}); break;
    case RayFormat::hit: to.insert(to.end(), {{}, {}, {place, 0, 0, 0}}); break;
  }
}

}  // namespace

PointStream fresh_rays(RayFormat format, const CastView& view) {
  if (view.width > widest || view.height > widest)
    throw Error("the picture has " + std::to_string(view.width) + "x" + std::to_string(view.height) +
                " pixels, and rays can name " + std::to_string(widest) + " each way: use --tracer embree");
  PointStream stream(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height), format);
  std::vector<glm::uvec4> points;
  for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(view.height); ++y)
    for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(view.width); ++x) append(points, format, x, y);
  stream.fill(points);
  return stream;
}

}  // namespace rayengine
