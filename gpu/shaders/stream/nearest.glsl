// The ray of this fragment and the nearest hit found so far. A kernel's main loops over a range of primitives of its type:
// what the ray's treelet holds, and only rays in that state get here; or, where OBJECT is defined, one object for all rays.
layout(early_fragment_tests) in;
layout(location = 0) out uvec2 result;

vec3 origin;
vec3 direction;
float tmin;
float tmax;
uint floor_rank;
float best_t;
uint best_rank;

// Reads the ray, and returns the range of primitives to test.
uvec2 begin() {
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
#ifdef OBJECT
  return object_range;
#else
  return range_of(texelFetch(lists, at, 0)[round]);
#endif
}

// Keeps a hit, and says so, if it is in the interval and nearer than the best, or as near and of lower rank.
bool consider(float t, uint rank) {
#ifdef MUTANT_INDEX
  rank ^= 1u;
#endif
  bool inside = t <= tmax && (t > tmin || (t == tmin && rank > floor_rank));
  bool nearer = t < best_t || (t == best_t && rank < best_rank);
  if (!inside || !nearer) return false;
  best_t = t;
  best_rank = rank;
  return true;
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
