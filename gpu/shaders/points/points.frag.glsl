// What a ray that was intersected brings to its pixel. Blending adds it to alpha times what is there: rays that see keep what is
// there, and one that finds its light hidden puts out what that light had brought, which has a target of its own.
layout(location = 0) flat in uvec4 shown[SHOWN];
uniform vec3 background;
layout(location = 0) out vec4 base;
#ifdef SHADOWS
layout(location = 1) out vec4 lit[LIGHTS];
#endif

void main() {
  Ray ray = from_shown(shown);
  base = vec4(0, 0, 0, 1);
#ifdef SHADOWS
  for (int i = 0; i < LIGHTS; ++i) lit[i] = vec4(0, 0, 0, ray.role == uint(i) + 1u ? 0 : 1);
#endif
  if (ray.role != sees) return;
  if (ray.index == none) {
    base.rgb = ray.weight * background;
    return;
  }
  Surface surface = surface_of(ray);
  base.rgb = unlit(ray, surface);
  for (int i = 0; i < LIGHTS; ++i) {
#ifdef SHADOWS
    lit[i].rgb = lit_by(i, ray, surface);
#else
    base.rgb += lit_by(i, ray, surface);
#endif
  }
}
