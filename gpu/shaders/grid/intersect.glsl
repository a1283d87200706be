// Tests what a voxel lists, after traverse.glsl and the tests of all types that the scene has. Defined from outside: TEST_ALL,
// a TEST_MEMBERS for each of these types.
layout(binding = 10) uniform usamplerBuffer triangle_members;  // primitives, list by list
layout(binding = 11) uniform usamplerBuffer quadric_members;

#ifdef SHADED
#define KEEP(type_place, i) best_primitive = uint(type_place) << 28 | uint(i)
#else
int nearest;  // the first texel of what was hit last, for those who go on to shade it
#define KEEP(type_place, i) nearest = i
#endif

#define TEST_MEMBERS(type_place, members, texels, TEST)                \
  {                                                                    \
    uvec2 range = range_of(list, type_place);                          \
    uint stop = range.x + range.y;                                     \
    for (uint k = range.x; k < stop && !enough(); ++k) {               \
      int i = texels * int(texelFetch(members, int(k)).x);             \
      if (TEST) { KEEP(type_place, i); }                               \
    }                                                                  \
  }

// Tests the list of the place, and says where the ray is then.
uvec4 intersect(uvec4 place) {
  uint list = place.x;
  TEST_ALL
  return uvec4(none, place.y, enough() ? arrived : traversing, best_primitive);
}
