// Rays of 64 bytes. Source: Ralovich, Magdics, "Recursive Ray Tracing in Geometry Shader" (2010), listing 2: position; origin, t;
// direction, index; u, v, state, type. In u's place is the weight; v stays empty, since normals are worked out from corners.
#define BUFFERED 4
#define CARRIED 4
#define SHOWN 4

Ray from_record(uvec4 r[4]) {
  Ray ray;
  ray.pixel = r[0].xy;
  ray.origin = uintBitsToFloat(r[1].xyz);
  ray.t = uintBitsToFloat(r[1].w);
  ray.direction = uintBitsToFloat(r[2].xyz);
  ray.index = r[2].w;
  ray.weight = uintBitsToFloat(r[3].x);
  ray.state = r[3].z;
  ray.role = r[3].w;
  return ray;
}

uvec4[4] record(Ray ray) {
  return uvec4[4](uvec4(ray.pixel, 0, 0), uvec4(floatBitsToUint(ray.origin), floatBitsToUint(ray.t)),
                  uvec4(floatBitsToUint(ray.direction), ray.index), uvec4(floatBitsToUint(ray.weight), 0, ray.state, ray.role));
}

Ray from_buffer(uvec4 r[BUFFERED]) { return from_record(r); }
Ray from_carried(uvec4 r[CARRIED]) { return from_record(r); }
uvec4[CARRIED] carried_of(Ray ray) { return record(ray); }
Ray from_shown(uvec4 r[SHOWN]) { return from_record(r); }
