// Where the ray of this fragment is; see traverse.glsl.
uvec4 read_place() {
  uvec4 place = texelFetch(lists, ivec2(gl_FragCoord.xy), 0);
#ifdef SHADED
  best_primitive = place.w;
#endif
  return place;
}
