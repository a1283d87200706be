// Ray against box, conservatively: never false for a ray that meets the box, also when its direction has zeros of either
// sign and the origin lies in a face. Source: Ize, "Robust BVH Ray Traversal" (JCGT 2(2), 2013) for the widening.

// Clips [tmin, tmax] to the slab between lo and hi along one axis. A ray within the slab's planes keeps its interval.
KERNEL void slab(REAL lo, REAL hi, REAL o, REAL d, OUT(REAL) enter, OUT(REAL) leave) {
  REAL near = (pick(d < 0, hi, lo) - o) / d;
  REAL far = (pick(d < 0, lo, hi) - o) / d;
  BOOL parallel = d == 0;
  BOOL within = both(lo <= o, o <= hi);
  REAL all = REAL_MAX;
  enter = pick(parallel, pick(within, -all, all), near);
  leave = pick(parallel, pick(within, all, -all), far);
}

// Where the ray enters and leaves the box within [tmin, tmax]; it misses when enter > leave. `widening` is 1 + 4 u or more,
// u the unit round-off of REAL: it covers the rounding of both quotients.
KERNEL void box(VEC3 lower, VEC3 upper, VEC3 o, VEC3 d, REAL tmin, REAL tmax, REAL widening, OUT(REAL) enter, OUT(REAL) leave) {
  REAL ex; REAL lx;
  REAL ey; REAL ly;
  REAL ez; REAL lz;
  slab(lower.x, upper.x, o.x, d.x, ex, lx);
  slab(lower.y, upper.y, o.y, d.y, ey, ly);
  slab(lower.z, upper.z, o.z, d.z, ez, lz);
  enter = larger(larger(ex, ey), larger(ez, tmin));
  leave = smaller(smaller(lx, ly), lz);
  leave = smaller(leave * pick(leave > 0, widening, 2 - widening), tmax);
}
