#pragma once

#include <cstddef>

#include "accel/geometry.h"
#include "cpu/reference/formulas.h"
#include "cpu/reference/root.h"

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
/// A rim belongs to both the side and the cap. Of a capped quadric those crossings count where the line passes between
/// the inside and the outside: at a rim, the side's where it enters both or leaves both the form and the slab between
/// the caps, and none where it enters one and leaves the other, which is to touch the solid. The cap's counts there
/// only where the line touches the side from inside, and so does not cross it.
Crossings cross_quadric(const LocalRay& ray, const Geometry& geometry, const Quadric& quadric);

/// t of a crossing without rounding; `line` is in the space that the quadric is placed in.
Root exact_t(const Line<Exact>& line, const Geometry& geometry, const Quadric& quadric, const Crossing& crossing);

/// The outward normal in object space at a crossing; of any length but zero.
Vector<quad> normal(const LocalRay& ray, const Geometry& geometry, const Quadric& quadric, const Crossing& crossing);

}  // namespace rayengine::reference
