// The surface that a ray has hit, and the rays that go on from it. After shade.glsl.
struct Surface {
  vec3 position;
  vec3 normal;  // faces the ray
  vec3 view;
  Finish finish;
};

// Reflections that bring less are not traced.
const float least_weight = 1.0 / 2048;

Surface surface_of(Ray ray) {
  Surface s;
  s.position = ray.origin + ray.t * ray.direction;
  s.normal = dot(ray.normal, ray.direction) > 0 ? -ray.normal : ray.normal;
  s.view = -normalize(ray.direction);
  s.finish = finish_of_material(ray.material);
  return s;
}

// To a light; not waiting when the surface is turned away from it.
Ray shadow_ray(Ray ray, Surface s, int light) {
  vec3 origin = s.position + clearance * s.normal;
  bool has_place = texelFetch(lights, 2 * light).w != 0;
  vec3 way = towards_light(light, origin) * (has_place ? 1 : 16);  // out of the scene
  return Ray(ray.pixel, dot(way, s.normal) > 0 ? waiting : finished, uint(light) + 1u, 1, origin, way, 1, none, vec3(0));
}

// Not waiting when it would bring nothing.
Ray reflected_ray(Ray ray, Surface s) {
  float weight = ray.weight * s.finish.reflect;
  return Ray(ray.pixel, weight >= least_weight ? waiting : finished, sees, weight, s.position + clearance * s.normal,
             reflect(-s.view, s.normal), far_away, none, vec3(0));
}

// What a ray sees of the light that the surface reflects, were it not in shadow.
vec3 lit_by(int light, Ray ray, Surface s) {
  return ray.weight * from_light(light, s.finish, s.normal, normalize(towards_light(light, s.position)), s.view);
}

// What it sees whatever the lights.
vec3 unlit(Ray ray, Surface s) { return ray.weight * s.finish.ambient * s.finish.color; }
