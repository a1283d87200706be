// Without a geometry shader: from each pixel's last ray that saw, the ray that follows of one kind, intersected. There is one
// for every pixel, also where none follows; such rays are not shown.
layout(location = 0) in uvec4 before[CARRIED];
#ifdef FAT
layout(location = 0, xfb_buffer = 0, xfb_offset = 0, xfb_stride = 64) flat out uvec4 shown[SHOWN];
#else
layout(location = 0) flat out vec4 shown[SHOWN];
layout(location = SHOWN, xfb_buffer = 0, xfb_offset = 0, xfb_stride = 48) flat out uvec4 kept[CARRIED];
#endif
layout(location = 25) uniform bool sees_background;
layout(location = 27) uniform int kind;  // -2: the camera's; -1: reflected; else to the light of this number

Ray follower(Ray ray) {
  if (kind == -2) return eye_ray(ray.pixel);
  if (ray.material == none) return Ray(ray.pixel, finished, ray.role, 0, vec3(0), vec3(0), 0, none, vec3(0));
#if defined(SHADOWS) || defined(REFLECTIONS)
  Surface surface = surface_of(ray);
  return kind == -1 ? reflected_ray(ray, surface) : shadow_ray(ray, surface, kind);
#endif
}

void main() {
  Ray ray = follower(from_carried(before));
  bool goes = ray.state == waiting;
  if (goes) trace(ray);
#ifdef FAT
  shown = record(ray);
#else
  shown = brought_by(ray);
  kept = carried_of(ray);
#endif
  bool hit = ray.material != none;
  bool seen = goes && (hit || (ray.role == sees && sees_background));
  gl_Position = seen ? screen_position(ray.pixel) : vec4(2, 2, 0, 1);
}
