// The ray of this fragment against one primitive, in place of nearest.glsl; after consider.glsl. The depth test keeps the
// nearest hit. Points come by falling rank and pass where they are as near, so that of primitives as near the one of lowest
// rank stays; what draws of other types have found before is looked up. PLAIN: a full-screen pass for object_range. PATHS: no
// ray looks behind a hit.
layout(location = 0) out uvec2 result;
#ifndef PLAIN
layout(location = 0) flat in uint primitive;
#endif
uint rank_before;

uvec2 begin() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 o = texelFetch(origins, at, 0);
  vec4 d = texelFetch(directions, at, 0);
  origin = o.xyz;
  direction = d.xyz;
  tmin = o.w;
  tmax = d.w;
#ifdef PATHS
  if (tmax < tmin) discard;  // software skips what follows, and knows no early stencil test where depths are written
  floor_rank = none;
#else
  floor_rank = texelFetch(entries, at, 0).x;
#endif
#ifdef SEVERAL_TYPES
  uvec2 hit = texelFetch(hits, at, 0).xy;
  best_t = uintBitsToFloat(hit.x);
  rank_before = hit.y;
#else
  best_t = REAL_MAX;
  rank_before = none;
#endif
  best_rank = rank_before;
#ifdef PLAIN
  return object_range;
#else
  return uvec2(primitive, 1);
#endif
}

bool enough() { return false; }

void end() {
  if (best_rank == rank_before) discard;
  result = uvec2(floatBitsToUint(best_t), best_rank);
  gl_FragDepth = best_t * (1.0f / 1099511627776.0f);  // 2^-40, which costs no bits of what lies in the frame
}
