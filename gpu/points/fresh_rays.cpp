#include "gpu/points/fresh_rays.h"

#include <string>
#include <vector>

#include "accel/tracer.h"

namespace rayengine {
namespace {

/// Small vertices have 14 bits for each coordinate.
constexpr int widest = 1 << 14;
constexpr std::uint32_t fresh_role = 15;

/// Devices shade points in step that follow each other, and draw best what lies together.
constexpr std::uint32_t block = 4;

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
  const glm::uvec2 size(view.width, view.height);
  const std::uint32_t blocks_across = (size.x + block - 1) / block, blocks_down = (size.y + block - 1) / block;
  for (std::uint32_t b = 0; b < blocks_across * blocks_down; ++b)
    for (std::uint32_t i = 0; i < block * block; ++i) {
      const glm::uvec2 pixel(b % blocks_across * block + i % block, b / blocks_across * block + i / block);
      if (pixel.x < size.x && pixel.y < size.y) append(points, format, pixel.x, pixel.y);
    }
  stream.fill(points);
  return stream;
}

}  // namespace rayengine
