// Traces a ray: what the vertex shader does for each point, or the fragment shader of the baseline for each pixel.
layout(location = 16) uniform vec3 scene_lower;
layout(location = 17) uniform vec3 scene_upper;

// An early test: most rays that leave an open scene meet nothing.
bool meets_scene() {
  float enter;
  float leave;
  box(scene_lower, scene_upper, origin, direction, tmin, tmax, 1.000001, enter, leave);
  return enter <= leave;
}

void trace(inout Ray ray) {
  origin = ray.origin;
  direction = ray.direction;
  tmin = 0;
  tmax = ray.t;
  floor_rank = none;
  best_t = far_away;
  best_rank = none;
  if (!meets_scene()) return;
  any_will_do = ray.role != sees;
  find();
  if (best_rank == none) return;
  ray.t = best_t;
  ray.material = material_of(best_rank);
  if (ray.role == sees) ray.normal = triangle_normal(nearest);
}
