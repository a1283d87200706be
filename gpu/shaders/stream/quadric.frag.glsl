// Four texels a quadric: the rows of the map to object space, each with a component of its origin, then clip planes, rank,
// and the index of a general form, or whether there are caps. Defined from outside: FORM, the coefficients A, E, H, I, J of
// a unit primitive, or GENERAL; PLANE, DISK or SADDLE for what is clipped in their ways; CAPS where there can be any; CONE.
layout(binding = 6) uniform usamplerBuffer quadrics;
#ifdef GENERAL
layout(binding = 7) uniform usamplerBuffer forms; // four texels each: the ten coefficients, then the box
#endif

void to_object(vec4 row0, vec4 row1, vec4 row2, vec3 o, vec3 d, OUT(vec3) local_o, OUT(vec3) local_d) {
  vec3 from = vec3(o.x - row0.w, o.y - row1.w, o.z - row2.w);
  local_o = vec3((row0.x * from.x + row0.y * from.y) + row0.z * from.z, (row1.x * from.x + row1.y * from.y) + row1.z * from.z,
                 (row2.x * from.x + row2.y * from.y) + row2.z * from.z);
  local_d = vec3((row0.x * d.x + row0.y * d.y) + row0.z * d.z, (row1.x * d.x + row1.y * d.y) + row1.z * d.z,
                 (row2.x * d.x + row2.y * d.y) + row2.z * d.z);
}

float clipped(float r, vec3 p, vec3 d, float zmin, float zmax, vec3 lower, vec3 upper) {
#if defined(MUTANT_CLIP) || defined(PLANE)
  return r;
#elif defined(DISK)
  return clip_disk(r, p, d);
#elif defined(SADDLE)
  return clip_box(r, p, d, vec3(-1, -1, max(zmin, -1)), vec3(1, 1, min(zmax, 1)));
#elif defined(GENERAL)
  return clip_box(r, p, d, lower, upper);
#else
  return clip_z(r, p, d, zmin, zmax);
#endif
}

#ifdef CAPS
float cap_root(float at, vec3 p, vec3 d) {
#ifdef CONE
  if (at == 0) return REAL_MAX; // the apex is a cap without area
#endif
  return cap(FORM, at, p, d);
}
#endif

// Tests one quadric, and says whether a hit was kept.
bool test(int i) {
  vec4 row0 = uintBitsToFloat(texelFetch(quadrics, i));
  vec4 row1 = uintBitsToFloat(texelFetch(quadrics, i + 1));
  vec4 row2 = uintBitsToFloat(texelFetch(quadrics, i + 2));
  uvec4 rest = texelFetch(quadrics, i + 3);
  vec3 o;
  vec3 d;
  to_object(row0, row1, row2, origin, direction, o, d);
  vec3 p;
  float s;
  approach(o, d, p, s);
  vec3 lower = vec3(0);
  vec3 upper = vec3(0);
  float a;
  float b;
  float c;
#ifdef GENERAL
  int form = 4 * int(rest.w);
  vec4 f0 = uintBitsToFloat(texelFetch(forms, form));
  vec4 f1 = uintBitsToFloat(texelFetch(forms, form + 1));
  vec4 f2 = uintBitsToFloat(texelFetch(forms, form + 2));
  vec4 f3 = uintBitsToFloat(texelFetch(forms, form + 3));
  general_coefficients(f0.x, f0.y, f0.z, f0.w, f1.x, f1.y, f1.z, f1.w, f2.x, f2.y, p, d, a, b, c);
  lower = vec3(f2.z, f2.w, f3.x);
  upper = f3.yzw;
#else
  diagonal_coefficients(FORM, p, d, a, b, c);
#endif
  float near;
  float far;
  roots(a, b, c, near, far);
#ifdef MUTANT_ROOT
  near = far;
#endif
  float zmin = uintBitsToFloat(rest.x);
  float zmax = uintBitsToFloat(rest.y);
  bool kept = consider(s + clipped(near, p, d, zmin, zmax, lower, upper), rest.z);
  kept = consider(s + clipped(far, p, d, zmin, zmax, lower, upper), rest.z) || kept;
#ifdef CAPS
  if (rest.w != 0u) {
    kept = consider(s + cap_root(zmin, p, d), rest.z + 1u) || kept;
    kept = consider(s + cap_root(zmax, p, d), rest.z + 2u) || kept;
  }
#endif
  return kept;
}

#ifdef HALF
int nearest;

// Half the gradient of the form at a point of object space.
vec3 gradient(vec3 p, uint form) {
#ifdef GENERAL
  vec4 f0 = uintBitsToFloat(texelFetch(forms, 4 * int(form)));
  vec4 f1 = uintBitsToFloat(texelFetch(forms, 4 * int(form) + 1));
  vec4 f2 = uintBitsToFloat(texelFetch(forms, 4 * int(form) + 2));
  return vec3(f0.x * p.x + f0.y * p.y + f0.z * p.z + f0.w, f0.y * p.x + f1.x * p.y + f1.y * p.z + f1.z,
              f0.z * p.x + f1.y * p.y + f1.w * p.z + f2.x);
#else
  const float unit[5] = float[5](FORM);
  return vec3(unit[0] * p.x, unit[1] * p.y, unit[2] * p.z + unit[3]);
#endif
}

vec3 best_normal() {
  vec4 row0 = uintBitsToFloat(texelFetch(quadrics, nearest));
  vec4 row1 = uintBitsToFloat(texelFetch(quadrics, nearest + 1));
  vec4 row2 = uintBitsToFloat(texelFetch(quadrics, nearest + 2));
  uvec4 rest = texelFetch(quadrics, nearest + 3);
  vec3 p;
  vec3 d;
  to_object(row0, row1, row2, best_position(), direction, p, d);
  uint part = best_rank - rest.z;
  vec3 n = part == 0u ? gradient(p, rest.w) : vec3(0, 0, part == 1u ? -1 : 1);
  return normalize(row0.xyz * n.x + row1.xyz * n.y + row2.xyz * n.z);
}
#endif

void main() {
  uvec2 range = begin();
  int stop = 4 * int(range.x + range.y);
  for (int i = 4 * int(range.x); i < stop && !enough(); i += 4) {
    bool kept = test(i);
#ifdef HALF
    if (kept) nearest = i;
#endif
  }
  end();
}
