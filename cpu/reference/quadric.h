#pragma once

#include <cstddef>

#include "accel/geometry.h"
#include "cpu/reference/formulas.h"

namespace rayengine::reference {

/// The places where a ray passes one quadric: two on its side and two on its caps at most.
class Crossings {
 public:
  void add(const Crossing& c) { items_[count_++] = c; }
  const Crossing* begin() const { return items_.data(); }
  const Crossing* end() const { return items_.data() + count_; }

 private:
  std::array<Crossing, 4> items_;
  std::size_t count_ = 0;
};

/// All crossings of the clipped surface and its caps, in no order. `ray` is in the quadric's object space. The side is
/// where a t^2 + 2 b t + c = 0 with b^2 > a c, whose sign is exact; clipping is closed, and as exact.
Crossings cross_quadric(const LocalRay& ray, const Geometry& geometry, const Quadric& quadric);

/// The outward normal in object space at a crossing; of any length but zero.
Vector<quad> normal(const LocalRay& ray, const Geometry& geometry, const Quadric& quadric, const Crossing& crossing);

}  // namespace rayengine::reference
