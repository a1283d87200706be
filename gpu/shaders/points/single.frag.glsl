// The baseline: all of a pixel's rays in one loop of one fragment shader.
layout(location = 24) uniform int reflections;
layout(location = 0) out vec4 color;

vec3 seen_of_lights(Ray ray, Surface surface) {
  vec3 sum = vec3(0);
  for (int i = 0; i < LIGHTS; ++i) {
#ifdef SHADOWS
    Ray next = shadow_ray(ray, surface, i);
    if (next.state != waiting) continue;
    trace(next);
    if (next.material != none) continue;
#endif
    sum += lit_by(i, ray, surface);
  }
  return sum;
}

void main() {
  Ray ray = eye_ray(uvec2(gl_FragCoord.xy));
  color = vec4(0, 0, 0, 1);
  for (int generation = 0; ray.state == waiting; ++generation) {
    trace(ray);
    if (ray.material == none) {
      color.rgb += ray.weight * background;
      break;
    }
    Surface surface = surface_of(ray);
    color.rgb += unlit(ray, surface) + seen_of_lights(ray, surface);
    if (generation == reflections) break;
    ray = reflected_ray(ray, surface);
  }
}
