// Run over the rays that are not done, under a depth test: keeps those whose list has ended, or whose nearest hit lies before
// their next treelet, and which so get the depth of those that are done. The others are discarded, and stay as they are.
#ifndef ANY_HIT
// Where the ray enters its next treelet, or one before that.
float entry(ivec2 at) {
  vec2 t = unpackHalf2x16(texelFetch(entries, at, 0).y);
  return round == 1 ? t.x : t.y;
}
#endif

bool done(ivec2 at) {
  if (texelFetch(lists, at, 0)[round] == none) return true;
  uvec2 hit = texelFetch(hits, at, 0).xy;
#ifdef ANY_HIT
  return hit.y != none;
#else
  return hit.y != none && uintBitsToFloat(hit.x) < entry(at);
#endif
}

void main() {
  if (!done(ivec2(gl_FragCoord.xy))) discard;
}
