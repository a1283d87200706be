// A range of quadrics of one type against the ray of this fragment. Defined from outside: TEST(i), and FORM, the coefficients
// A, E, H, I, J of a unit primitive, or GENERAL.
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
    bool kept = TEST(i);
#ifdef HALF
    if (kept) nearest = i;
#endif
  }
  end();
}
