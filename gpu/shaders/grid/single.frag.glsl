// All of a ray's way in one loop. After intersect.glsl.

void main() {
  read_ray();
  uvec4 place = texelFetch(lists, ivec2(gl_FragCoord.xy), 0);
  while (place.z != done) place = place.z == traversing ? traverse(place) : intersect(place);
  end();
}
