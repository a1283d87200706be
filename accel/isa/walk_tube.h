// Part of walk_lanes.h: what a group of neighbouring rays may meet, found once for all of them.
//
// A tube is all points origin + s * direction with origins and reciprocal directions in the intervals that the group
// spans, a little widened, so that it meets all boxes that its rays do in their own arithmetic. The rays then need to
// be tested against those few leaves alone, with the results that they would have had alone. Source of the idea:
// Boulos, Wald, Shirley, "Geometric and Arithmetic Culling Methods for Entire Ray Packets" (2006).

constexpr float tube_margin = 0x1p-19f;

struct Tube {
  lanes near_origin[3], far_origin[3];  ///< the ends of the origins' interval that are nearest to either plane
  lanes least_inverse[3], greatest_inverse[3], length;
  unsigned near_side[3];
};

struct Interval {
  float lower, upper;
};

static inline Interval interval(const float* values) {
  static_assert(group == 16);
  alignas(32) float lower[8], upper[8];
  store(lower, smaller(load(values), load(values + 8)));
  store(upper, larger(load(values), load(values + 8)));
  Interval all{lower[0], upper[0]};
  for (int i = 1; i < 8; ++i) {
    all.lower = lesser(all.lower, lower[i]);
    all.upper = greater(all.upper, upper[i]);
  }
  return all;
}

/// Gives places without a ray the numbers of one that has; false when there is none.
static inline bool fill_dead_places(LocalRays& rays) {
  int model = 0;
  while (model < group && !rays.alive[model]) ++model;
  if (model == group) return false;
  for (int k = 0; k < group; ++k) {
    if (rays.alive[k]) continue;
    for (int axis = 0; axis < 3; ++axis) {
      rays.origin[axis][k] = rays.origin[axis][model];
      rays.inverse[axis][k] = rays.inverse[axis][model];
    }
    rays.slack[k] = rays.slack[model], rays.length[k] = rays.length[model];
  }
  return true;
}

/// Whether all rays, dead ones included, run towards the same octant.
static inline bool keep_together(const LocalRays& rays) {
  bool together = true;
  for (int axis = 0; axis < 3; ++axis) {
    const float* inverse = rays.inverse[axis];
    const unsigned ascending = not_above(all(0), load(inverse)) + not_above(all(0), load(inverse + 8));
    together &= ascending == 0 || ascending == 2 * 0xFF;
  }
  return together;
}

/// False when the rays part too much to share a tube.
static inline bool enclose(LocalRays& rays, Tube& tube) {
  if (!keep_together(rays) || !fill_dead_places(rays)) return false;
  const float margin = interval(rays.slack).upper + tube_margin;
  for (int axis = 0; axis < 3; ++axis) {
    const Interval origin = interval(rays.origin[axis]), inverse = interval(rays.inverse[axis]);
    const bool ascending = inverse.lower > 0;
    tube.near_origin[axis] = all(ascending ? origin.upper + margin : origin.lower - margin);
    tube.far_origin[axis] = all(ascending ? origin.lower - margin : origin.upper + margin);
    tube.least_inverse[axis] = all(inverse.lower);
    tube.greatest_inverse[axis] = all(inverse.upper);
    tube.near_side[axis] = !ascending;
  }
  tube.length = all(interval(rays.length).upper * (1 + tube_margin));
  return true;
}

/// A bit for each lane that the tube meets, and where it does at the earliest.
static inline unsigned meet(const WideNode& node, const Tube& tube, lanes& enter) {
  const lanes zero = all(0), one = all(1);
  enter = zero;
  lanes leave = tube.length;
  for (int axis = 0; axis < 3; ++axis) {
    const lanes near = multiply_subtract(load(node.planes[axis][tube.near_side[axis]]), one, tube.near_origin[axis]);
    const lanes far = multiply_subtract(load(node.planes[axis][1 - tube.near_side[axis]]), one, tube.far_origin[axis]);
    enter = larger(smaller(multiply_subtract(near, tube.least_inverse[axis], zero),
                           multiply_subtract(near, tube.greatest_inverse[axis], zero)),
                   enter);
    leave = smaller(larger(multiply_subtract(far, tube.least_inverse[axis], zero),
                           multiply_subtract(far, tube.greatest_inverse[axis], zero)),
                    leave);
  }
  return not_above(enter, leave);
}

/// The rays of a tube that meet a box, a bit each, and where.
static inline unsigned meet_box(const WideNode& node, std::uint32_t lane, const LocalRays& rays, const Tube& tube,
                                float* entries) {
  unsigned met = 0;
  for (int first = 0; first < group; first += 8) {
    lanes enter = all(0), leave = load(rays.length + first);
    for (int axis = 0; axis < 3; ++axis) {
      const lanes near = all(node.planes[axis][tube.near_side[axis]][lane]);
      const lanes far = all(node.planes[axis][1 - tube.near_side[axis]][lane]);
      const lanes inverse = load(rays.inverse[axis] + first);
      enter = larger(multiply_subtract(near, inverse, load(rays.near_origin[axis] + first)), enter);
      leave = smaller(multiply_subtract(far, inverse, load(rays.far_origin[axis] + first)), leave);
    }
    store(entries + first, enter);
    met |= not_above(enter, leave) << first;
  }
  return met;
}
