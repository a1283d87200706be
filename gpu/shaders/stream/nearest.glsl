// The ray of this fragment and its nearest hit, after consider.glsl. A kernel's main loops over a range of primitives of its
// type: what the ray's treelet holds, and only rays in that state get here; or, where OBJECT is defined, one object for all
// rays.
layout(early_fragment_tests) in;
layout(location = 0) out uvec2 result;

void read_ray() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 o = texelFetch(origins, at, 0);
  vec4 d = texelFetch(directions, at, 0);
  uvec2 hit = texelFetch(hits, at, 0).xy;
  origin = o.xyz;
  direction = d.xyz;
  tmin = o.w;
  tmax = d.w;
  floor_rank = texelFetch(entries, at, 0).x;
  best_t = uintBitsToFloat(hit.x);
  best_rank = hit.y;
}

// Reads the ray, and returns the range of primitives to test.
uvec2 begin() {
  read_ray();
#ifdef OBJECT
  return object_range;
#else
  return range_of(texelFetch(lists, ivec2(gl_FragCoord.xy), 0)[round]);
#endif
}

// For any-hit queries one is enough.
bool enough() {
#ifdef ANY_HIT
  return best_rank != none;
#else
  return false;
#endif
}

void end() { result = uvec2(floatBitsToUint(best_t), best_rank); }
