// All of a ray's way in one loop. After intersect.glsl, or shade.glsl where rays are shaded.
#ifdef SHADED
layout(location = 4) out vec4 gathered_by_now;
#endif

void main() {
  read_ray();
  uvec4 place = read_place();
#ifdef SHADED
  read_carried();
#endif
  while (place.z != done) {
    if (place.z == traversing) place = traverse(place);
    else if (place.z == intersecting) place = intersect(place);
#ifdef SHADED
    else place = shade();
#endif
  }
#ifdef SHADED
  gathered_by_now = gathered;
#endif
  end();
}
