// A ray's way through a uniform grid, from voxel to voxel, without loss: whatever rounding does, no point of the ray is
// farther than 2^-18 from the voxel that it is said to be in, in a frame where the grid spans no more than [-1, 1]^3. Lists
// of voxels that are that much too wide leave nothing out. Source: Amanatides, Woo, "A Fast Voxel Traversal Algorithm for Ray
// Tracing" (Eurographics 1987), with every plane's t from its index instead of sums, whose rounding would add up.

// What rounding in single precision can make of t in such a frame, generously: for choices that must not miss anything.
KERNEL REAL frame_slack(REAL t) {
  REAL near = 4;
  return (near + magnitude(t)) / 524288;
}

// The voxel's index along one axis that holds the coordinate p, or the one nearest to it.
KERNEL REAL index_at(REAL p, REAL lower, REAL cell, REAL count) {
  REAL first = 0;
  return larger(smaller(whole((p - lower) / cell), count - 1), first);
}

// The voxel in which the ray's interval begins, and whether any of it lies in the grid.
KERNEL void enter_grid(VEC3 lower, VEC3 cell, VEC3 counts, VEC3 o, VEC3 d, REAL tmin, REAL tmax, OUT(VEC3) voxel, OUT(BOOL) meets) {
  REAL enter;
  REAL leave;
  REAL widening = REAL(1.000001);
  VEC3 upper = VEC3(lower.x + counts.x * cell.x, lower.y + counts.y * cell.y, lower.z + counts.z * cell.z);
  box(lower, upper, o, d, tmin - frame_slack(tmin), tmax + frame_slack(tmax), widening, enter, leave);
  meets = enter <= leave;
  voxel = VEC3(index_at(o.x + enter * d.x, lower.x, cell.x, counts.x), index_at(o.y + enter * d.y, lower.y, cell.y, counts.y),
               index_at(o.z + enter * d.z, lower.z, cell.z, counts.z));
}

// Where the ray leaves the slab of a voxel along one axis; REAL_MAX when it runs in parallel.
KERNEL REAL leave_slab(REAL lower, REAL cell, REAL index, REAL o, REAL d) {
  REAL beyond = pick(d > 0, index + 1, index);
  return pick(d != 0, ((lower + beyond * cell) - o) / d, REAL_MAX);
}

// Where the ray leaves its voxel, and the voxel that it goes to: outside of the grid, where it leaves that.
KERNEL void leave_voxel(VEC3 lower, VEC3 cell, VEC3 o, VEC3 d, VEC3 voxel, OUT(REAL) leave, OUT(VEC3) next) {
  REAL x = leave_slab(lower.x, cell.x, voxel.x, o.x, d.x);
  REAL y = leave_slab(lower.y, cell.y, voxel.y, o.y, d.y);
  REAL z = leave_slab(lower.z, cell.z, voxel.z, o.z, d.z);
  leave = smaller(smaller(x, y), z);
  BOOL by_x = x <= leave;
  BOOL by_y = both(y <= leave, x > leave);
  BOOL by_z = both(x > leave, y > leave);
  next = VEC3(voxel.x + pick(by_x, pick(d.x > 0, REAL(1), REAL(-1)), REAL(0)),
              voxel.y + pick(by_y, pick(d.y > 0, REAL(1), REAL(-1)), REAL(0)),
              voxel.z + pick(by_z, pick(d.z > 0, REAL(1), REAL(-1)), REAL(0)));
}

KERNEL BOOL in_grid(VEC3 counts, VEC3 voxel) {
  BOOL x = both(voxel.x >= 0, voxel.x < counts.x);
  BOOL y = both(voxel.y >= 0, voxel.y < counts.y);
  BOOL z = both(voxel.z >= 0, voxel.z < counts.z);
  return both(both(x, y), z);
}
