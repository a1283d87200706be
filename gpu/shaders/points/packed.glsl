// Rays of 32 bytes in vertex buffers, which hold only those that wait: the origin, with the pixel (14 bits a coordinate) and
// the role (4 bits); the direction, with the weight. A ray that sees has no end, and one to a light ends at t = 1.
#define BUFFERED 2
#define CARRIED 3
#define SHOWN 2

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
  ray.index = none;
  return ray;
}

uvec4[BUFFERED] buffered_of(Ray ray) {
  return uvec4[BUFFERED](uvec4(floatBitsToUint(ray.origin), place_of(ray)),
                         uvec4(floatBitsToUint(ray.direction), floatBitsToUint(ray.weight)));
}

Ray from_carried(uvec4 r[CARRIED]) {
  Ray ray;
  ray.origin = uintBitsToFloat(r[0].xyz);
  ray.t = uintBitsToFloat(r[0].w);
  ray.direction = uintBitsToFloat(r[1].xyz);
  ray.index = r[1].w;
  set_place(ray, r[2].x);
  ray.weight = uintBitsToFloat(r[2].y);
  ray.state = waiting;
  return ray;
}

uvec4[CARRIED] carried_of(Ray ray) {
  return uvec4[CARRIED](uvec4(floatBitsToUint(ray.origin), floatBitsToUint(ray.t)),
                        uvec4(floatBitsToUint(ray.direction), ray.index),
                        uvec4(place_of(ray), floatBitsToUint(ray.weight), 0, 0));
}

// What the fragment shader needs: the position in place of what led there, and the role in place of a shadow ray's weight.
uvec4[SHOWN] shown_of(Ray ray) {
  float weight = ray.role == sees ? ray.weight : -float(ray.role);
  return uvec4[SHOWN](uvec4(floatBitsToUint(ray.origin + ray.t * ray.direction), ray.index),
                      uvec4(floatBitsToUint(ray.direction), floatBitsToUint(weight)));
}

Ray from_shown(uvec4 r[SHOWN]) {
  Ray ray;
  ray.pixel = uvec2(0);
  ray.state = finished;
  ray.origin = uintBitsToFloat(r[0].xyz);
  ray.t = 0;
  ray.index = r[0].w;
  ray.direction = uintBitsToFloat(r[1].xyz);
  ray.weight = uintBitsToFloat(r[1].w);
  ray.role = ray.weight < 0 ? uint(-ray.weight) : sees;
  return ray;
}
