// What a ray that was intersected brings to each target of its pixel. Blending adds it to alpha times what is there: rays that see
// keep what is there, and one that finds its light hidden puts out what that light had brought, which has a target of its own.
// After surface.glsl.
uniform vec3 background;

vec4[TARGETS] brought_by(Ray ray) {
  vec4 brought[TARGETS];
  brought[0] = vec4(0, 0, 0, 1);
#ifdef SHADOWS
  for (int i = 0; i < LIGHTS; ++i) brought[1 + i] = vec4(0, 0, 0, ray.role == uint(i) + 1u ? 0 : 1);
#endif
  if (ray.role != sees) return brought;
  if (ray.material == none) {
    brought[0].rgb = ray.weight * background;
    return brought;
  }
  Surface surface = surface_of(ray);
  brought[0].rgb = unlit(ray, surface);
  for (int i = 0; i < LIGHTS; ++i) {
#ifdef SHADOWS
    brought[1 + i].rgb = lit_by(i, ray, surface);
#else
    brought[0].rgb += lit_by(i, ray, surface);
#endif
  }
  return brought;
}
