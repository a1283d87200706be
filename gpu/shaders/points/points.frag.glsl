// What a ray that was intersected brings to its pixel. Blending adds it to alpha times what is there: rays that see keep what is
// there, and one that finds its light hidden puts out what that light had brought.
layout(location = 0) flat in uvec4 shown[CARRIED];
layout(location = 12) uniform vec3 background;
layout(location = 0) out vec4 base;
#if LIGHTS > 0
layout(location = 1) out vec4 lit[LIGHTS];
#endif

void main() {
  Ray ray = from_carried(shown);
  base = vec4(0, 0, 0, 1);
#if LIGHTS > 0
  for (int i = 0; i < LIGHTS; ++i) lit[i] = vec4(0, 0, 0, ray.role == uint(i) + 1u ? 0 : 1);
#endif
  if (ray.role != sees) return;
  if (ray.index == none) {
    base.rgb = ray.weight * background;
    return;
  }
  Surface surface = surface_of(ray);
  base.rgb = unlit(ray, surface);
#if LIGHTS > 0
  for (int i = 0; i < LIGHTS; ++i) lit[i].rgb = lit_by(i, ray, surface);
#endif
}
