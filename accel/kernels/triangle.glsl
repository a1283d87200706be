// Ray against triangle without gaps at shared edges. Source of the method: Woop, Benthin, Wald, "Watertight Ray/Triangle
// Intersection" (JCGT 2(1), 2013). Neighbours compute the same products for a shared edge, so one of them is hit.

// The three components with the axis of the ray's largest component last, in cyclic order.
KERNEL VEC3 permuted(VEC3 v, BOOL x_last, BOOL y_last) {
  return VEC3(pick(x_last, v.y, pick(y_last, v.z, v.x)), pick(x_last, v.z, pick(y_last, v.x, v.y)),
              pick(x_last, v.x, pick(y_last, v.y, v.z)));
}

// t along o + t d, and the barycentrics u of b and v of c; `hit` is false for degenerate and parallel triangles and for NaN.
KERNEL void triangle(VEC3 o, VEC3 d, VEC3 a, VEC3 b, VEC3 c, OUT(REAL) t, OUT(REAL) u, OUT(REAL) v, OUT(BOOL) hit) {
  REAL ax = magnitude(d.x);
  REAL ay = magnitude(d.y);
  REAL az = magnitude(d.z);
  BOOL x_last = both(ax >= ay, ax >= az);
  BOOL y_last = ay >= az;
  VEC3 k = permuted(d, x_last, y_last);
  REAL sx = k.x / k.z;
  REAL sy = k.y / k.z;
  VEC3 pa = permuted(VEC3(a.x - o.x, a.y - o.y, a.z - o.z), x_last, y_last);
  VEC3 pb = permuted(VEC3(b.x - o.x, b.y - o.y, b.z - o.z), x_last, y_last);
  VEC3 pc = permuted(VEC3(c.x - o.x, c.y - o.y, c.z - o.z), x_last, y_last);
  REAL bx = pb.x - sx * pb.z;
  REAL by = pb.y - sy * pb.z;
  REAL cx = pc.x - sx * pc.z;
  REAL cy = pc.y - sy * pc.z;
  REAL dx = pa.x - sx * pa.z;
  REAL dy = pa.y - sy * pa.z;
  REAL wa = cx * by - cy * bx;
  REAL wb = dx * cy - dy * cx;
  REAL wc = bx * dy - by * dx;
  REAL w = (wa + wb) + wc;
  BOOL inside = either(both(both(wa >= 0, wb >= 0), wc >= 0), both(both(wa <= 0, wb <= 0), wc <= 0));
  hit = both(inside, w != 0);
  t = (((wa * pa.z + wb * pb.z) + wc * pc.z) / k.z) / w;
  u = wb / w;
  v = wc / w;
}
