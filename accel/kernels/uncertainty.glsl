// How far rounding can have moved what quadric.glsl and triangle.glsl compute: running error analysis, derived line by
// line in docs/accuracy.md. ROUNDINGS(n) is n units of round-off; a division or a root counts as six, since OpenGL allows
// them 2.5 and 3 units in the last place. Bounds hold while nothing overflows, and what underflows is far below them.

// The quadric's object space: `o_size` and `d_size` bound, component by component, the origin and the direction with all
// terms of the map to object space taken positive. How far a point of the shifted ray, at r = 0, is off:
KERNEL REAL approach_error(REAL o_size, REAL d_size, REAL shift) {
  return ROUNDINGS(14) * (o_size + magnitude(shift) * d_size);
}

// Of a, b and c. `squares`, `linear` and `constant` are the sums of the magnitudes of Q's entries: of its 3x3 part, of D, G
// and I, and J. `p_size` bounds the components of p.
KERNEL void coefficient_errors(REAL squares, REAL linear, REAL constant, REAL d_size, REAL p_size, REAL p_error,
                               OUT(REAL) ea, OUT(REAL) eb, OUT(REAL) ec) {
  ea = ROUNDINGS(24) * squares * d_size * d_size;
  eb = d_size * (squares * (ROUNDINGS(20) * p_size + 2 * p_error) + ROUNDINGS(14) * linear);
  ec = squares * (ROUNDINGS(12) * p_size * p_size + 3 * p_size * p_error + 2 * p_error * p_error) +
       linear * (3 * p_error + ROUNDINGS(12) * p_size) + ROUNDINGS(4) * constant;
}

// What rounding alone, with exact coefficients, may change in the discriminant.
KERNEL REAL discriminant_rounding(REAL a, REAL b, REAL c) { return ROUNDINGS(4) * (b * b + magnitude(a * c)); }

// Of the discriminant, all told.
KERNEL REAL discriminant_error(REAL a, REAL b, REAL c, REAL ea, REAL eb, REAL ec) {
  return 2 * magnitude(b) * eb + eb * eb + magnitude(a) * ec + magnitude(c) * ea + ea * ec + discriminant_rounding(a, b, c);
}

// Of a root r, where `under_root` is more than four times its own error. The form is off by e at r, and its slope there is
// twice the root h of the discriminant; REAL_MAX where the slope may vanish before that.
KERNEL REAL root_error(REAL r, REAL a, REAL b, REAL c, REAL ea, REAL eb, REAL ec) {
  REAL under_root = discriminant(a, b, c);
  REAL e = (ea * magnitude(r) + 2 * eb) * magnitude(r) + ec;
  REAL per_h = 1 / root(pick(under_root > 0, under_root, a - a));  // as in roots(), so that it is taken once
  REAL along = per_h * (e + discriminant_rounding(a, b, c) * per_h * magnitude(r)) + ROUNDINGS(20) * magnitude(r);
  return pick(4 * magnitude(a) * e < under_root, along, REAL_MAX);
}

// Of t, for a root r of a ray that was shifted.
KERNEL REAL shifted_error(REAL shift, REAL r, REAL r_error) {
  return r_error + ROUNDINGS(6) * (magnitude(shift) + magnitude(r));
}

// Of (o x d)^2 - d^2, which tells whether a ray passes a ball or a cylinder of radius 1 by.
KERNEL REAL distance_error(REAL o_size, REAL d_size) { return ROUNDINGS(512) * (1 + o_size) * d_size * d_size; }

// Of the root of a plane across z; REAL_MAX where the ray may run in parallel.
KERNEL REAL plane_error(REAL r, REAL dz, REAL height, REAL d_size, REAL p_error) {
  REAL ed = ROUNDINGS(6) * d_size;
  REAL e = 2 * (p_error + magnitude(r) * ed + ROUNDINGS(2) * magnitude(height)) / magnitude(dz) + ROUNDINGS(8) * magnitude(r);
  return pick(magnitude(dz) > 2 * ed, e, REAL_MAX);
}

// Of a coordinate at p + r d, with r itself off by `r_error`.
KERNEL REAL coordinate_error(REAL r, REAL r_error, REAL d_size, REAL p_size, REAL p_error) {
  return p_error + ROUNDINGS(12) * (p_size + magnitude(r) * d_size) + d_size * r_error;
}

// Of A x^2 + E y^2 + constant, |A|, |E| <= 1 and `size` >= |x| + |y|, with both coordinates off by `error`.
KERNEL REAL rim_error(REAL size, REAL error, REAL constant) {
  return 3 * size * error + 2 * error * error + ROUNDINGS(8) * (size * size + magnitude(constant));
}

// Of a sheared corner of a triangle, whose corners are within `reach` of the ray's origin on every axis; the origin may be
// off by `o_error` and a slope of the direction by `slope_error`.
KERNEL REAL corner_error(REAL reach, REAL o_error, REAL slope_error) {
  return (ROUNDINGS(14) + slope_error) * reach + 2 * o_error;
}

// Of the edge functions, when sheared corners are off by `corner` and no more than `size` from the ray on either axis.
KERNEL REAL edge_error(REAL size, REAL corner) {
  return 5 * size * corner + 3 * corner * corner + ROUNDINGS(4) * size * size;
}

// Of t, where all edge functions have one sign and are larger than their error `e`: t is a mean of the corners' depths
// weighted by them. `nearly` is what holds for any weights: rounding, and what the ray brings along.
KERNEL REAL crossing_error(VEC3 w, VEC3 depth, REAL e, REAL per_length, REAL nearly) {
  REAL range = larger(larger(depth.x, depth.y), depth.z) - smaller(smaller(depth.x, depth.y), depth.z);
  REAL per_sum = magnitude(1 / ((w.x + w.y) + w.z));  // the compiler has it already
  return pick(8 * e * per_sum < 1, nearly + 8 * e * range * per_length * per_sum, REAL_MAX);
}

// The part of crossing_error that is the same for all triangles; `length` is the ray's component on its largest axis.
KERNEL REAL depth_error(REAL reach, REAL length, REAL o_error, REAL d_error) {
  REAL per_length = 1 / magnitude(length);
  return ((ROUNDINGS(32) + 2 * d_error * per_length) * reach + 2 * o_error) * per_length;
}
