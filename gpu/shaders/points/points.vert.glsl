// Intersects each ray, a point of a vertex buffer, with the scene.
layout(location = 0) in uvec4 buffered[BUFFERED];
layout(location = 0) flat out uvec4 carried[CARRIED];

void main() {
  Ray ray = from_buffer(buffered);
  if (ray.state == fresh) ray = eye_ray(ray.pixel);
  if (ray.state == waiting) trace(ray);
  carried = carried_of(ray);
#ifdef NOTHING_FOLLOWS
  gl_Position = vec4(2 + abs(ray.t), float(ray.material), 0, 1);  // off the screen, yet not known before
#endif
}
