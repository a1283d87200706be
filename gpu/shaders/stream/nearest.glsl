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
#ifdef SHADED
  floor_rank = none;
#else
  floor_rank = texelFetch(entries, at, 0).x;
#endif
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
#if defined(ANY_HIT)
const bool any_will_do = true;
#elif defined(SHADED)
bool any_will_do = false;  // of a ray to a light
#else
const bool any_will_do = false;
#endif

bool enough() { return any_will_do && best_rank != none; }

void end() { result = uvec2(floatBitsToUint(best_t), best_rank); }
