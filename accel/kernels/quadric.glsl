// Ray against quadric, in the quadric's object space. Source of the method: Haines, Guenther, Akenine-Moeller, "Precision
// Improvements for Ray/Sphere Intersection" (Ray Tracing Gems, ch. 7), taken from spheres to all quadrics.
// No dot(), no normalize(): the order of operations is part of the result.

// Moves the ray's origin to where the ray passes the object's centre, so that the coefficients are formed from small
// numbers: p = o + s d. The second step corrects the rounding of the first.
KERNEL void approach(VEC3 o, VEC3 d, OUT(VEC3) p, OUT(REAL) s) {
  REAL per_dd = 1 / ((d.x * d.x + d.y * d.y) + d.z * d.z);  // any s will do: its own rounding is in p as well
  REAL s1 = -((o.x * d.x + o.y * d.y) + o.z * d.z) * per_dd;
  p = VEC3(o.x + s1 * d.x, o.y + s1 * d.y, o.z + s1 * d.z);
  REAL s2 = -((p.x * d.x + p.y * d.y) + p.z * d.z) * per_dd;
  p = VEC3(p.x + s2 * d.x, p.y + s2 * d.y, p.z + s2 * d.z);
  s = s1 + s2;
}

// Coefficients of a r^2 + 2 b r + c = 0 along p + r d for the forms A x^2 + E y^2 + H z^2 + 2 I z + J: all unit primitives.
KERNEL void diagonal_coefficients(REAL A, REAL E, REAL H, REAL I, REAL J, VEC3 p, VEC3 d, OUT(REAL) a, OUT(REAL) b, OUT(REAL) c) {
  a = (A * d.x * d.x + E * d.y * d.y) + H * d.z * d.z;
  b = ((A * p.x * d.x + E * p.y * d.y) + H * p.z * d.z) + I * d.z;
  c = (((A * p.x * p.x + E * p.y * p.y) + H * p.z * p.z) + 2 * I * p.z) + J;
}

// The same for all ten coefficients, by Q applied to the direction and to the point.
KERNEL void general_coefficients(REAL A, REAL B, REAL C, REAL D, REAL E, REAL F, REAL G, REAL H, REAL I, REAL J, VEC3 p, VEC3 d,
                                 OUT(REAL) a, OUT(REAL) b, OUT(REAL) c) {
  REAL qx = (A * d.x + B * d.y) + C * d.z;
  REAL qy = (B * d.x + E * d.y) + F * d.z;
  REAL qz = (C * d.x + F * d.y) + H * d.z;
  REAL qw = (D * d.x + G * d.y) + I * d.z;
  a = (qx * d.x + qy * d.y) + qz * d.z;
  b = ((qx * p.x + qy * p.y) + qz * p.z) + qw;
  REAL gx = ((A * p.x + B * p.y) + C * p.z) + D;
  REAL gy = ((B * p.x + E * p.y) + F * p.z) + G;
  REAL gz = ((C * p.x + F * p.y) + H * p.z) + I;
  REAL gw = ((D * p.x + G * p.y) + I * p.z) + J;
  c = ((gx * p.x + gy * p.y) + gz * p.z) + gw;
}

// Above zero where there are two roots. A double root is none: tangent rays miss. NaN is not above zero.
KERNEL REAL discriminant(REAL a, REAL b, REAL c) { return b * b - a * c; }

// Roots of a r^2 + 2 b r + c = 0 in order, each from the expression that does not cancel; REAL_MAX where there is none.
KERNEL void roots(REAL a, REAL b, REAL c, OUT(REAL) near, OUT(REAL) far) {
  REAL under_root = discriminant(a, b, c);
  BOOL real = under_root > 0;
  REAL h = root(pick(real, under_root, a - a));
  REAL q = -(b + pick(b < 0, -h, h));
  REAL none = REAL_MAX;
  REAL r0 = pick(both(real, a != 0), q / a, none);
  REAL r1 = pick(real, c / q, none);
  near = smaller(r0, r1);
  far = larger(r0, r1);
}

// A ball, or else an infinite cylinder about z, of radius 1 needs no approach: by Lagrange's identity a quarter of the
// discriminant of dd t^2 + 2 od t + oo - 1 = 0 is dd - (o x d)^2, in which nothing cancels that grows with the distance.
KERNEL REAL round_discriminant(bool ball, VEC3 o, VEC3 d, OUT(REAL) dd) {
  REAL z = o.x * d.y - o.y * d.x, cross2 = z * z;
  dd = d.x * d.x + d.y * d.y;
  if (ball) {
    REAL x = o.y * d.z - o.z * d.y, y = o.z * d.x - o.x * d.z;
    cross2 = (x * x + y * y) + cross2;
    dd = dd + d.z * d.z;
  }
  return dd - cross2;
}

// Where o + t d meets it, in order; REAL_MAX where it does not. What rounding left out of the chord's middle is added.
KERNEL void round_roots(bool ball, VEC3 o, VEC3 d, REAL dd, REAL under_root, OUT(REAL) near, OUT(REAL) far) {
  REAL per_dd = 1 / dd, od = o.x * d.x + o.y * d.y;
  if (ball) od = od + o.z * d.z;
  REAL middle = -od * per_dd;
  REAL left = (o.x + middle * d.x) * d.x + (o.y + middle * d.y) * d.y;
  if (ball) left = left + (o.z + middle * d.z) * d.z;
  BOOL real = under_root > 0;
  REAL rest = -left * per_dd, half_chord = root(pick(real, under_root, dd - dd)) * per_dd, none = REAL_MAX;
  near = pick(real, middle + (rest - half_chord), none);
  far = pick(real, middle + (rest + half_chord), none);
}

// The plane z = at along p + r d; REAL_MAX when the ray runs in parallel.
KERNEL REAL plane_root(REAL at, VEC3 p, VEC3 d) {
  return pick(d.z != 0, (at - p.z) / d.z, REAL_MAX);
}

// The clips: a root r along p + r d as it is where it lies on the clipped surface, else REAL_MAX. Clips are closed.
KERNEL REAL clip_z(REAL r, VEC3 p, VEC3 d, REAL zmin, REAL zmax) {
  REAL z = p.z + r * d.z;
  return pick(both(z >= zmin, z <= zmax), r, REAL_MAX);
}

KERNEL REAL clip_box(REAL r, VEC3 p, VEC3 d, VEC3 lower, VEC3 upper) {
  REAL x = p.x + r * d.x;
  REAL y = p.y + r * d.y;
  BOOL within_x = both(x >= lower.x, x <= upper.x);
  BOOL within_y = both(y >= lower.y, y <= upper.y);
  return clip_z(pick(both(within_x, within_y), r, REAL_MAX), p, d, lower.z, upper.z);
}

// Above zero outside the unit circle about z.
KERNEL REAL disk_form(REAL r, VEC3 p, VEC3 d) {
  REAL x = p.x + r * d.x;
  REAL y = p.y + r * d.y;
  return (x * x + y * y) - 1;
}
KERNEL REAL clip_disk(REAL r, VEC3 p, VEC3 d) { return pick(disk_form(r, p, d) <= 0, r, REAL_MAX); }

// The form A x^2 + E y^2 + H z^2 + 2 I z + J where the ray passes the plane z = at, at r: above zero outside the cap.
KERNEL REAL cap_form(REAL A, REAL E, REAL H, REAL I, REAL J, REAL at, REAL r, VEC3 p, VEC3 d) {
  REAL x = p.x + r * d.x;
  REAL y = p.y + r * d.y;
  return (A * x * x + E * y * y) + ((H * at * at + 2 * I * at) + J);
}

// The cap in that plane.
KERNEL REAL cap(REAL A, REAL E, REAL H, REAL I, REAL J, REAL at, VEC3 p, VEC3 d) {
  REAL r = plane_root(at, p, d);
  return pick(cap_form(A, E, H, I, J, at, r, p, d) <= 0, r, REAL_MAX);
}
