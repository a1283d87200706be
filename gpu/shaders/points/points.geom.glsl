// Drops the rays that were shown in the pass before, shows those that have been intersected, and after each that sees a
// surface sends the rays to the lights, and the reflected one. Points reach the screen, and the next pass, in this order.
layout(points) in;
layout(points, max_vertices = 2 + LIGHTS) out;
layout(location = 0) flat in uvec4 carried[][CARRIED];
layout(location = 24) uniform bool reflects;
layout(location = 25) uniform bool sees_background;
layout(location = 26) uniform int generation;  // of the rays that see, in this pass

#ifdef FAT
layout(location = 0, xfb_buffer = 0, xfb_offset = 0, xfb_stride = 64) flat out uvec4 shown[SHOWN];

void show(Ray ray) {
  ray.state = finished;
  shown = record(ray);
  EmitVertex();
}

void send(Ray ray) {
  shown = record(ray);
  gl_Position = vec4(2, 2, 0, 1);  // not on the screen
  EmitVertex();
}
#else
layout(stream = 0, location = 0) flat out vec4 shown[SHOWN];
layout(stream = 1, location = SHOWN, xfb_buffer = 0, xfb_offset = 0, xfb_stride = 32) flat out uvec4 sent[BUFFERED];

void show(Ray ray) {
  shown = brought_by(ray);
  EmitStreamVertex(0);
}

void send(Ray ray) {
  sent = buffered_of(ray);
  EmitStreamVertex(1);
}
#endif

void place(Ray ray) {
  gl_Position = screen_position(ray.pixel);
#ifdef SHADOWS
  gl_Layer = ray.role == sees ? generation : generation - 1;
#endif
}

void main() {
  Ray ray = from_carried(carried[0]);
  bool hit = ray.material != none;
  if (ray.state != waiting || !(hit || (ray.role == sees && sees_background))) return;
  place(ray);
  show(ray);
  if (!hit || ray.role != sees) return;
#if defined(SHADOWS) || defined(REFLECTIONS)
  Surface surface = surface_of(ray);
#endif
#ifdef SHADOWS
  for (int light = 0; light < LIGHTS; ++light) {
    Ray next = shadow_ray(ray, surface, light);
    if (next.state == waiting) send(next);
  }
#endif
#ifdef REFLECTIONS
  if (!reflects) return;
  Ray next = reflected_ray(ray, surface);
  if (next.state == waiting) send(next);
#endif
}
