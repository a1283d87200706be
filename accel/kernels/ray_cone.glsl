// The infinite cone that encloses a set of rays, by apex, axis, and the cosine and sine of half its opening angle. Source of
// extension and translation: Szecsi, "The Hierarchical Ray Engine" (WSCG 2006), section 4. Directions have unit length.
//
// A cone holds no rays when its cosine is above 1, and everything when it is negative: openings beyond 83 degrees either way
// have no use. The least opening is not 0, since parallel rays that set out side by side have no apex.
// Every test is written so that NaN counts as "may be met".
#define LEAST_TANGENT (1.0f / 512)
#define LARGEST_TANGENT 8
#define TOO_FAR 1e15f  // for squares in single precision
#define CONE_SLACK (1.0f / 262144)  // 64 times the unit round-off of single precision

KERNEL REAL inner(VEC3 a, VEC3 b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }

KERNEL VEC3 combined(REAL s, VEC3 a, REAL t, VEC3 b) { return VEC3(s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z); }

KERNEL VEC3 unit_vector(VEC3 a) {
  REAL length = root(inner(a, a));
  return VEC3(a.x / length, a.y / length, a.z / length);
}

KERNEL VEC3 either_vector(BOOL condition, VEC3 yes, VEC3 no) {
  return VEC3(pick(condition, yes.x, no.x), pick(condition, yes.y, no.y), pick(condition, yes.z, no.z));
}

// The cosine and sine of an opening by its tangent, within the limits above.
KERNEL void cone_opened(REAL tangent, OUT(REAL) cosine, OUT(REAL) sine) {
  REAL least = LEAST_TANGENT;
  REAL everything = -1;
  REAL wide = larger(least, tangent);
  REAL root_of = root(1 + wide * wide);
  cosine = pick(wide <= LARGEST_TANGENT, 1 / root_of, everything);
  sine = wide / root_of;
}

// Opens the cone until it holds the direction r, too: the new axis lies midway between r and the generator e opposite to it.
KERNEL void cone_extended(VEC3 axis, REAL cosine, REAL sine, VEC3 r, OUT(VEC3) new_axis, OUT(REAL) new_cosine, OUT(REAL) new_sine) {
  REAL one = 1;
  REAL along = inner(axis, r);
  VEC3 q = unit_vector(combined(along, axis, -one, r));
  VEC3 e = combined(cosine, axis, sine, q);
  VEC3 x = unit_vector(combined(one, e, one, r));
  VEC3 across = combined(one, e, -one, r);  // twice the new sine long
  BOOL outside = both(along < cosine, cosine >= 0);
  new_axis = either_vector(outside, x, axis);
  new_sine = pick(outside, root(inner(across, across)) / 2, sine);
  new_cosine = pick(outside, inner(x, r), cosine);
  BOOL narrow = both(new_cosine * LARGEST_TANGENT >= new_sine, inner(new_axis, axis) > 0);  // midway is not behind
  new_cosine = pick(narrow, new_cosine, -one);
}

// Moves the apex back along the generator e until the cone holds the point p, which then lies on the generator n nearest to
// it; or to p, when that sees the whole cone before it (where the paper's step would put p behind the apex).
KERNEL VEC3 cone_translated(VEC3 apex, VEC3 axis, REAL cosine, REAL sine, VEC3 p) {
  REAL one = 1;
  VEC3 c = combined(one, p, -one, apex);
  REAL along = inner(axis, c);
  REAL reach = root(inner(c, c)) * cosine;
  VEC3 q = unit_vector(combined(along, axis, -one, c));
  VEC3 e = combined(cosine, axis, sine, q);
  VEC3 n = combined(cosine, axis, -sine, q);
  VEC3 g = combined(one, c, -inner(n, c), n);
  REAL t = -inner(g, g) / inner(e, g);  // e and g point away from each other
  VEC3 moved = combined(one, apex, -t, e);
  return either_vector(along >= reach, apex, either_vector(-along >= reach, p, moved));
}

// What follows settles a cone in the face of rounding: how far rays stick out of its opening, and how far its apex must stand
// back, are measured afresh over all rays, for the axis, apex and opening as they were stored, so that nothing accumulates;
// and widened by more than the measuring itself can be off. With u = 2^-24: a component along the axis is off by less than
// 4 u of the vector's length, one across it by less than 8 u, lengths and quotients add 4 u. 32 u covers a direction, twice
// that all the rest.
KERNEL void across_and_along(VEC3 axis, VEC3 a, OUT(REAL) across, OUT(REAL) along) {
  REAL one = 1;
  along = inner(axis, a);
  VEC3 beside = combined(one, a, -along, axis);
  across = root(inner(beside, beside));
}

// The tangent of the angle between a direction and the axis; REAL_MAX from 90 degrees on.
KERNEL REAL cone_tangent(VEC3 axis, VEC3 r) {
  REAL across; REAL along;
  across_and_along(axis, r, across, along);
  return pick(along > 0, (across / along) * (1 + CONE_SLACK) + CONE_SLACK, REAL_MAX);
}

// How far back along the axis the apex of a cone of at least this opening must move to hold p; negative when it may come
// forward.
KERNEL REAL cone_setback(VEC3 apex, VEC3 axis, REAL tangent, VEC3 p) {
  REAL one = 1;
  REAL across; REAL along;
  VEC3 c = combined(one, p, -one, apex);
  across_and_along(axis, c, across, along);
  REAL slack = CONE_SLACK * (across + magnitude(along));
  REAL setback = (across + slack) / tangent - (along - slack);
  return pick(setback <= TOO_FAR, setback, REAL_MAX);
}

// The cone with the opening and the setback that were measured; what held everything still does.
KERNEL void cone_settled(VEC3 apex, VEC3 axis, REAL cosine, REAL widest, REAL setback, OUT(VEC3) new_apex, OUT(REAL) new_cosine, OUT(REAL) new_sine) {
  REAL one = 1;
  REAL opened;
  cone_opened(widest, opened, new_sine);
  REAL size = (magnitude(apex.x) + magnitude(apex.y)) + (magnitude(apex.z) + magnitude(setback));
  new_apex = combined(one, apex, -(setback + CONE_SLACK * size * opened / new_sine), axis);
  new_cosine = pick(both(cosine >= 0, size <= TOO_FAR), opened, -one);
}

// Whether no ray of the cone meets the sphere. The paper's condition to keep a sphere is
//   phi > acos((v - a) . x / |v - a|) - asin(rho / |v - a|), or that the apex lies inside;
// here it is written without inverse functions, whose errors GLSL does not bound: with h along and p across the axis, the
// sine of that difference times |v - a| is p cos(phi) - h sin(phi), and its cosine h cos(phi) + p sin(phi).
KERNEL BOOL cone_passes(VEC3 apex, VEC3 axis, REAL cosine, REAL sine, VEC3 center, REAL radius) {
  REAL one = 1;
  REAL p; REAL h;
  VEC3 w = combined(one, center, -one, apex);
  across_and_along(axis, w, p, h);
  REAL slack = CONE_SLACK * (p + magnitude(h));
  BOOL beside = p * cosine - h * sine > radius + slack;
  BOOL behind = both(h * cosine + p * sine < -slack, root(p * p + h * h) > radius + slack);
  return either(cosine > 1, both(cosine >= 0, either(beside, behind)));
}

#undef LEAST_TANGENT
#undef LARGEST_TANGENT
#undef TOO_FAR
#undef CONE_SLACK
