#include "engine/scene/camera_path.h"

#include <algorithm>
#include <array>

namespace rayengine {
namespace {

using Numbers = std::array<double, 10>;  ///< what moves of a camera

/// At a time.
struct Knot {
  double time;
  Numbers value;
};

Numbers numbers_of(const Camera& c) {
  return {c.from.x, c.from.y, c.from.z, c.at.x, c.at.y, c.at.z, c.up.x, c.up.y, c.up.z, c.fov};
}

Camera camera_of(const Numbers& n, const glm::ivec2& size) {
  return {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}, n[9], size};
}

/// combine(i) for each of the numbers.
template <class Combine>
Numbers each(const Combine& combine) {
  Numbers result;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = combine(i);
  return result;
}

Numbers velocity(const Knot& a, const Knot& b) {
  return each([&](std::size_t i) { return (b.value[i] - a.value[i]) / (b.time - a.time); });
}

/// At `b`, of the parabola through all three.
Numbers velocity(const Knot& a, const Knot& b, const Knot& c) {
  const Numbers before = velocity(a, b), after = velocity(b, c);
  const double weight = (b.time - a.time) / (c.time - a.time);
  return each([&](std::size_t i) { return before[i] + weight * (after[i] - before[i]); });
}

class Path {
 public:
  explicit Path(std::span<const CameraKey> keys) {
    for (const CameraKey& key : keys) knots_.push_back({key.time, numbers_of(key.camera)});
    loop_ = knots_.size() > 2 && knots_.front().value == knots_.back().value;
    for (std::size_t k = 0; k < knots_.size(); ++k) velocities_.push_back(velocity_at(k));
  }

  bool loop() const { return loop_; }

  Numbers at(double time) const {
    const auto next = std::ranges::upper_bound(knots_.begin() + 1, knots_.end() - 1, time, {}, &Knot::time);
    const auto k = static_cast<std::size_t>(next - knots_.begin()) - 1;
    const Knot &a = knots_[k], &b = knots_[k + 1];
    const double step = b.time - a.time, s = (time - a.time) / step, r = 1 - s;
    // Hermite's cubics: a value and a velocity at either end.
    return each([&](std::size_t i) {
      return r * r * ((1 + 2 * s) * a.value[i] + s * step * velocities_[k][i]) +
             s * s * ((1 + 2 * r) * b.value[i] - r * step * velocities_[k + 1][i]);
    });
  }

 private:
  Numbers velocity_at(std::size_t k) const {
    const std::size_t last = knots_.size() - 1;
    if (k > 0 && k < last) return velocity(knots_[k - 1], knots_[k], knots_[k + 1]);
    if (!loop_) return k == 0 ? velocity(knots_[0], knots_[1]) : velocity(knots_[last - 1], knots_[last]);
    const double round = knots_[last].time - knots_[0].time;
    return velocity({knots_[last - 1].time - round, knots_[last - 1].value}, knots_[0], knots_[1]);
  }

  std::vector<Knot> knots_;
  std::vector<Numbers> velocities_;
  bool loop_;
};

}  // namespace

std::vector<Camera> camera_path(std::span<const CameraKey> keys, int frames) {
  const Path path(keys);
  const double first = keys.front().time, last = keys.back().time;
  const int steps = std::max(path.loop() ? frames : frames - 1, 1);
  std::vector<Camera> cameras;
  for (int frame = 0; frame < frames; ++frame) {
    const double share = static_cast<double>(frame) / steps;
    cameras.push_back(camera_of(path.at((1 - share) * first + share * last), keys.front().camera.size));
  }
  return cameras;
}

}  // namespace rayengine
