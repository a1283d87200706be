// Rays of 32 bytes in vertex buffers, which hold only those that wait: the origin, with the pixel (14 bits a coordinate) and
// the role (4 bits); the direction, with the weight. A ray that sees has no end, and one to a light ends at t = 1.
#define BUFFERED 2
#define CARRIED 3
#define SHOWN TARGETS
#define SHOWN_TYPE vec4

const uint fresh_role = 15u;

uint place_of(Ray ray) { return ray.pixel.x | ray.pixel.y << 14 | ray.role << 28; }

void set_place(inout Ray ray, uint place) {
  ray.pixel = uvec2(place, place >> 14) & 0x3FFFu;
  ray.role = place >> 28;
}

Ray from_buffer(uvec4 r[BUFFERED]) {
  Ray ray;
  set_place(ray, r[0].w);
  ray.state = ray.role == fresh_role ? fresh : waiting;
  ray.weight = uintBitsToFloat(r[1].w);
  ray.origin = uintBitsToFloat(r[0].xyz);
  ray.direction = uintBitsToFloat(r[1].xyz);
  ray.t = ray.role == sees ? far_away : 1;
  ray.material = none;
  ray.normal = vec3(0);
  return ray;
}

uvec4[BUFFERED] buffered_of(Ray ray) {
  return uvec4[BUFFERED](uvec4(floatBitsToUint(ray.origin), place_of(ray)),
                         uvec4(floatBitsToUint(ray.direction), floatBitsToUint(ray.weight)));
}

// Of a ray that was intersected its end matters, and no longer where it began.
vec3 end_of(Ray ray) { return ray.origin + ray.t * ray.direction; }

Ray from_carried(uvec4 r[CARRIED]) {
  Ray ray;
  ray.origin = uintBitsToFloat(r[0].xyz);
  ray.t = 0;
  ray.direction = uintBitsToFloat(r[1].xyz);
  ray.material = r[1].w;
  ray.normal = uintBitsToFloat(uvec3(r[0].w, r[2].zw));
  set_place(ray, r[2].x);
  ray.weight = uintBitsToFloat(r[2].y);
  ray.state = waiting;
  return ray;
}

uvec4[CARRIED] carried_of(Ray ray) {
  uvec3 normal = floatBitsToUint(ray.normal);
  return uvec4[CARRIED](uvec4(floatBitsToUint(end_of(ray)), normal.x), uvec4(floatBitsToUint(ray.direction), ray.material),
                        uvec4(place_of(ray), floatBitsToUint(ray.weight), normal.yz));
}
