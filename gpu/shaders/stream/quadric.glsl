// Four texels a quadric: the rows of the map to object space, each with a component of its origin, then clip planes, rank,
// and the index of a general form, or whether there are caps. Where all spheres are whole, round and not turned, the clip
// planes of theirs make room for the y and z of the origin. After the kernel, and consider().
layout(binding = 8) uniform usamplerBuffer quadrics;
layout(binding = 7) uniform usamplerBuffer forms;  // four texels each: the ten coefficients, then the box

// How a type is clipped.
const int by_planes = 0;
const int to_disk = 1;
const int to_cube = 2;  // [-1, 1]^3, and by planes
const int to_box = 3;
const int never = 4;

void to_object(vec4 row0, vec4 row1, vec4 row2, vec3 o, vec3 d, OUT(vec3) local_o, OUT(vec3) local_d) {
  vec3 from = vec3(o.x - row0.w, o.y - row1.w, o.z - row2.w);
  local_o = vec3((row0.x * from.x + row0.y * from.y) + row0.z * from.z, (row1.x * from.x + row1.y * from.y) + row1.z * from.z,
                 (row2.x * from.x + row2.y * from.y) + row2.z * from.z);
  local_d = vec3((row0.x * d.x + row0.y * d.y) + row0.z * d.z, (row1.x * d.x + row1.y * d.y) + row1.z * d.z,
                 (row2.x * d.x + row2.y * d.y) + row2.z * d.z);
}

float clipped(float r, vec3 p, vec3 d, int clip, vec3 lower, vec3 upper) {
#ifdef MUTANT_CLIP
  return r;
#endif
  if (clip == to_disk) return clip_disk(r, p, d);
  if (clip == to_cube) return clip_box(r, p, d, vec3(-1, -1, max(lower.z, -1)), vec3(1, 1, min(upper.z, 1)));
  if (clip == to_box) return clip_box(r, p, d, lower, upper);
  if (clip == by_planes) return clip_z(r, p, d, lower.z, upper.z);
  return r;
}

// Considers both roots of the side.
bool test_side(float a, float b, float c, vec3 p, vec3 d, float s, int clip, vec3 lower, vec3 upper, uint rank) {
  float near;
  float far;
  roots(a, b, c, near, far);
#ifdef MUTANT_ROOT
  near = far;
#endif
  bool kept = consider(s + clipped(near, p, d, clip, lower, upper), rank);
  return consider(s + clipped(far, p, d, clip, lower, upper), rank) || kept;
}

void to_quadric(int i, OUT(vec3) p, OUT(vec3) d, OUT(float) s) {
  vec3 o;
  to_object(uintBitsToFloat(texelFetch(quadrics, i)), uintBitsToFloat(texelFetch(quadrics, i + 1)),
            uintBitsToFloat(texelFetch(quadrics, i + 2)), origin, direction, o, d);
  approach(o, d, p, s);
}

// The normal of unit length at a point of the frame, of the part of a quadric that has this rank; `gradient` is the form's, in
// object space.
vec3 normal_of_part(int i, vec3 gradient, uint rank) {
  uint part = rank - texelFetch(quadrics, i + 3).z;
  vec3 n = part == 0u ? gradient : vec3(0, 0, part == 1u ? -1 : 1);
  return normalize(uintBitsToFloat(texelFetch(quadrics, i).xyz) * n.x + uintBitsToFloat(texelFetch(quadrics, i + 1).xyz) * n.y +
                   uintBitsToFloat(texelFetch(quadrics, i + 2).xyz) * n.z);
}

vec3 point_in_object(int i, vec3 position) {
  vec3 p;
  vec3 d;
  to_object(uintBitsToFloat(texelFetch(quadrics, i)), uintBitsToFloat(texelFetch(quadrics, i + 1)),
            uintBitsToFloat(texelFetch(quadrics, i + 2)), position, direction, p, d);
  return p;
}

vec3 unit_normal(int i, vec3 position, uint rank, float A, float E, float H, float I, float J) {
  vec3 p = point_in_object(i, position);
  return normal_of_part(i, vec3(A * p.x, E * p.y, H * p.z + I), rank);
}

vec3 general_normal(int i, vec3 position, uint rank) {
  vec3 p = point_in_object(i, position);
  int form = 4 * int(texelFetch(quadrics, i + 3).w);
  vec4 f0 = uintBitsToFloat(texelFetch(forms, form));
  vec4 f1 = uintBitsToFloat(texelFetch(forms, form + 1));
  vec4 f2 = uintBitsToFloat(texelFetch(forms, form + 2));
  return normal_of_part(i,
                        vec3(f0.x * p.x + f0.y * p.y + f0.z * p.z + f0.w, f0.y * p.x + f1.x * p.y + f1.y * p.z + f1.z,
                             f0.z * p.x + f1.y * p.y + f1.w * p.z + f2.x),
                        rank);
}

// Tests the quadric whose texels begin at i, of a type that has a unit primitive of these coefficients, and says whether a
// hit was kept. What is said of the type is known to the compiler.
bool test_unit(int i, float A, float E, float H, float I, float J, int clip, bool may_have_caps, bool is_cone) {
  vec3 p;
  vec3 d;
  float s;
  to_quadric(i, p, d, s);
  uvec4 rest = texelFetch(quadrics, i + 3);
  float a;
  float b;
  float c;
  diagonal_coefficients(A, E, H, I, J, p, d, a, b, c);
  float zmin = uintBitsToFloat(rest.x);
  float zmax = uintBitsToFloat(rest.y);
  bool kept = test_side(a, b, c, p, d, s, clip, vec3(0, 0, zmin), vec3(0, 0, zmax), rest.z);
  if (!may_have_caps || rest.w == 0u) return kept;
  // The apex of a cone is a cap without area.
  if (!(is_cone && zmin == 0)) kept = consider(s + cap(A, E, H, I, J, zmin, p, d), rest.z + 1u) || kept;
  if (!(is_cone && zmax == 0)) kept = consider(s + cap(A, E, H, I, J, zmax, p, d), rest.z + 2u) || kept;
  return kept;
}

// The same for a sphere that is known to be whole, and under one scale for all axes: of two texels, and by the same numbers
// as above, where the rest of the map would add zeros.
bool test_ball(int i, float A, float E, float H, float I, float J) {
  vec4 row = uintBitsToFloat(texelFetch(quadrics, i));
  uvec4 rest = texelFetch(quadrics, i + 3);
  vec3 from = vec3(origin.x - row.w, origin.y - uintBitsToFloat(rest.x), origin.z - uintBitsToFloat(rest.y));
  precise vec3 o = row.x * from;
  precise vec3 direction_in_object = row.x * direction;
  vec3 p;
  float s;
  approach(o, direction_in_object, p, s);
  float a;
  float b;
  float c;
  diagonal_coefficients(A, E, H, I, J, p, direction_in_object, a, b, c);
  return test_side(a, b, c, p, direction_in_object, s, never, vec3(0), vec3(0), rest.z);
}

// The same for one that has a form of its own.
bool test_general(int i) {
  vec3 p;
  vec3 d;
  float s;
  to_quadric(i, p, d, s);
  uvec4 rest = texelFetch(quadrics, i + 3);
  int form = 4 * int(rest.w);
  vec4 f0 = uintBitsToFloat(texelFetch(forms, form));
  vec4 f1 = uintBitsToFloat(texelFetch(forms, form + 1));
  vec4 f2 = uintBitsToFloat(texelFetch(forms, form + 2));
  vec4 f3 = uintBitsToFloat(texelFetch(forms, form + 3));
  float a;
  float b;
  float c;
  general_coefficients(f0.x, f0.y, f0.z, f0.w, f1.x, f1.y, f1.z, f1.w, f2.x, f2.y, p, d, a, b, c);
  return test_side(a, b, c, p, d, s, to_box, vec3(f2.z, f2.w, f3.x), f3.yzw, rest.z);
}
