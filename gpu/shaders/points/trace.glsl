// Traces a ray: what the vertex shader does for each point, or the fragment shader of the baseline for each pixel.
layout(location = 1) uniform vec3 scene_lower;
layout(location = 2) uniform vec3 scene_upper;

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
  int nearest = intersect(ray.role != sees);
  if (nearest < 0) return;
  ray.t = best_t;
  ray.index = uint(nearest);
}
