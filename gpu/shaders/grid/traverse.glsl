// The way of this fragment's ray through the grid. After the kernels, ray.glsl and nearest.glsl. Where a ray is, is a texel of
// `lists`: the list to be tested now; its voxel, ten bits an axis, or `none` where it has not come to the grid; its state; and
// where it is shaded, the primitive of its nearest hit.
layout(binding = 9) uniform usamplerBuffer voxels;  // x running fastest: the voxel's list, or `none` where it is empty
layout(location = 5) uniform vec3 grid_lower;
layout(location = 6) uniform vec3 grid_cell;
layout(location = 7) uniform vec3 grid_counts;
layout(location = 8) uniform int steps;  // voxels that one pass crosses, at most

// Depths of states are quarters of these.
const uint traversing = 0u;
const uint intersecting = 1u;
const uint shading = 2u;
const uint done = 4u;
#ifdef SHADED
uint best_primitive = 0u;  // the place of its type among the scene's, from bit 28, and the index of its first texel
const uint arrived = shading;
#else
const uint best_primitive = 0u;
const uint arrived = done;
#endif

uint packed_voxel(vec3 voxel) { return uint(voxel.x) | uint(voxel.y) << 10 | uint(voxel.z) << 20; }
vec3 voxel_of(uint bits) { return vec3(bits & 1023u, bits >> 10 & 1023u, bits >> 20); }

uint list_of(vec3 voxel) {
  ivec3 at = ivec3(voxel);
  ivec3 counts = ivec3(grid_counts);
  return texelFetch(voxels, (at.z * counts.y + at.y) * counts.x + at.x).x;
}

// Whether nothing from t on can change the answer.
bool settled_before(float t) { return min(best_t, tmax) < t - frame_slack(t); }

// Goes from where the ray is to the next voxel that lists anything, or as far as one pass goes.
uvec4 traverse(uvec4 place) {
  vec3 voxel = voxel_of(place.y);
  if (place.y == none) {
    bool meets;
    enter_grid(grid_lower, grid_cell, grid_counts, origin, direction, tmin, min(best_t, tmax), voxel, meets);
    if (!meets) return uvec4(none, none, arrived, best_primitive);
    uint first = list_of(voxel);
    if (first != none) return uvec4(first, packed_voxel(voxel), intersecting, best_primitive);
  }
  for (int i = 0; i < steps; ++i) {
    float leave;
    vec3 next;
    leave_voxel(grid_lower, grid_cell, origin, direction, voxel, leave, next);
    if (settled_before(leave) || !in_grid(grid_counts, next)) return uvec4(none, none, arrived, best_primitive);
    voxel = next;
    uint list = list_of(voxel);
    if (list != none) return uvec4(list, packed_voxel(voxel), intersecting, best_primitive);
  }
  return uvec4(none, packed_voxel(voxel), traversing, best_primitive);
}
