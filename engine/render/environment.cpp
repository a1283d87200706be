#include "engine/render/environment.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "accel/tracer.h"

namespace rayengine {
namespace {

/// The channels named R, G and B; the first, thrice, of an image that has only grey.
glm::ivec3 color_channels(const Image& image) {
  glm::ivec3 found{0};
  for (int i = 0; i < 3; ++i) {
    const std::string name(1, "RGB"[i]);
    const auto it = std::find(image.channels.begin(), image.channels.end(), name);
    if (it != image.channels.end()) found[i] = static_cast<int>(it - image.channels.begin());
  }
  return found;
}

}  // namespace

Environment::Environment(const Background& background) : color_(background.color), image_(background.image) {
  if (!image_) return;
  if (image_->width < 1 || image_->height < 1 || image_->channels.empty())
    throw Error("the background image is empty: give one with pixels and colour channels");
  channel_ = color_channels(*image_);
}

glm::vec3 Environment::pixel(int x, int y) const {
  const float* p = image_->pixel(x, y);
  return {p[channel_.x], p[channel_.y], p[channel_.z]};
}

glm::vec3 Environment::lookup(const glm::dvec3& d) const {
  const double longitude = std::atan2(d.y, d.x), latitude = std::atan2(d.z, std::hypot(d.x, d.y));
  const int w = image_->width, h = image_->height;
  const double x = (0.5 - longitude * (0.5 * std::numbers::inv_pi)) * w - 0.5;
  const double y = (0.5 - latitude * std::numbers::inv_pi) * h - 0.5;
  const double left = std::floor(x), top = std::floor(y);
  const auto fx = static_cast<float>(x - left), fy = static_cast<float>(y - top);
  // Columns meet behind the viewer; rows end at the poles.
  const int x0 = (static_cast<int>(left) + w) % w, x1 = (x0 + 1) % w;
  const int y0 = std::max(static_cast<int>(top), 0), y1 = std::min(static_cast<int>(top) + 1, h - 1);
  return glm::mix(glm::mix(pixel(x0, y0), pixel(x1, y0), fx), glm::mix(pixel(x0, y1), pixel(x1, y1), fx), fy);
}

}  // namespace rayengine
