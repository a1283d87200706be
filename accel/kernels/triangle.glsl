// Ray against triangle without gaps at shared edges. Source of the method: Woop, Benthin, Wald, "Watertight Ray/Triangle
// Intersection" (JCGT 2(1), 2013). Neighbours compute the same products for a shared edge, so one of them is hit.

// The three components with the axis of the ray's largest component last, in cyclic order.
KERNEL VEC3 permuted(VEC3 v, BOOL x_last, BOOL y_last) {
  return VEC3(pick(x_last, v.y, pick(y_last, v.z, v.x)), pick(x_last, v.z, pick(y_last, v.x, v.y)),
              pick(x_last, v.x, pick(y_last, v.y, v.z)));
}

// What a ray brings to all triangles: its largest axis, and the shear (x, y) and length (z) that make it run along it.
KERNEL void ray_shear(VEC3 d, OUT(BOOL) x_last, OUT(BOOL) y_last, OUT(VEC3) shear) {
  REAL ax = magnitude(d.x);
  REAL ay = magnitude(d.y);
  REAL az = magnitude(d.z);
  x_last = both(ax >= ay, ax >= az);
  y_last = ay >= az;
  VEC3 k = permuted(d, x_last, y_last);
  shear = VEC3(k.x / k.z, k.y / k.z, k.z);
}

// The edge functions of a sheared triangle, its corners' depths, and how far off the ray they are on either axis at most.
KERNEL void triangle_edges(VEC3 o, BOOL x_last, BOOL y_last, VEC3 shear, VEC3 a, VEC3 b, VEC3 c, OUT(VEC3) w,
                           OUT(VEC3) depth, OUT(REAL) size) {
  VEC3 pa = permuted(VEC3(a.x - o.x, a.y - o.y, a.z - o.z), x_last, y_last);
  VEC3 pb = permuted(VEC3(b.x - o.x, b.y - o.y, b.z - o.z), x_last, y_last);
  VEC3 pc = permuted(VEC3(c.x - o.x, c.y - o.y, c.z - o.z), x_last, y_last);
  REAL bx = pb.x - shear.x * pb.z;
  REAL by = pb.y - shear.y * pb.z;
  REAL cx = pc.x - shear.x * pc.z;
  REAL cy = pc.y - shear.y * pc.z;
  REAL dx = pa.x - shear.x * pa.z;
  REAL dy = pa.y - shear.y * pa.z;
  w = VEC3(cx * by - cy * bx, dx * cy - dy * cx, bx * dy - by * dx);
  depth = VEC3(pa.z, pb.z, pc.z);
  REAL x = larger(larger(magnitude(bx), magnitude(cx)), magnitude(dx));
  REAL y = larger(larger(magnitude(by), magnitude(cy)), magnitude(dy));
  size = larger(x, y);
}

// Whether the edge functions have one sign, when each may be off by `slack`; not for NaN.
KERNEL BOOL one_sign(VEC3 w, REAL slack) {
  BOOL positive = both(both(w.x >= -slack, w.y >= -slack), w.z >= -slack);
  return either(positive, both(both(w.x <= slack, w.y <= slack), w.z <= slack));
}

// Whether the ray passes inside; not for degenerate and parallel triangles.
KERNEL BOOL triangle_inside(VEC3 w) { return both(one_sign(w, w.x - w.x), (w.x + w.y) + w.z != 0); }

// t along the ray, and the barycentrics u of b and v of c, where it hits.
KERNEL void triangle_crossing(VEC3 shear, VEC3 w, VEC3 depth, OUT(REAL) t, OUT(REAL) u, OUT(REAL) v) {
  REAL per_sum = 1 / ((w.x + w.y) + w.z);
  t = (((w.x * depth.x + w.y * depth.y) + w.z * depth.z) / shear.z) * per_sum;
  u = w.y * per_sum;
  v = w.z * per_sum;
}

// All of it for one ray and one triangle.
KERNEL void triangle(VEC3 o, VEC3 d, VEC3 a, VEC3 b, VEC3 c, OUT(REAL) t, OUT(REAL) u, OUT(REAL) v, OUT(BOOL) hit) {
  BOOL x_last; BOOL y_last; VEC3 shear; VEC3 w; VEC3 depth; REAL size;
  ray_shear(d, x_last, y_last, shear);
  triangle_edges(o, x_last, y_last, shear, a, b, c, w, depth, size);
  hit = triangle_inside(w);
  triangle_crossing(shear, w, depth, t, u, v);
}
