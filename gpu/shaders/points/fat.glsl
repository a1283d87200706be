// Rays of 64 bytes. Source: Ralovich, Magdics, "Recursive Ray Tracing in Geometry Shader" (2010), listing 2: position; origin, t;
// direction, index; u, v, state, type. The position leaves room for two numbers: with v, for the normal. In u's place is the
// weight, in the index's the material.
#define BUFFERED 4
#define CARRIED 4
#define SHOWN 4
#define SHOWN_TYPE uvec4

Ray from_record(uvec4 r[4]) {
  Ray ray;
  ray.pixel = r[0].xy;
  ray.origin = uintBitsToFloat(r[1].xyz);
  ray.t = uintBitsToFloat(r[1].w);
  ray.direction = uintBitsToFloat(r[2].xyz);
  ray.material = r[2].w;
  ray.normal = uintBitsToFloat(uvec3(r[0].zw, r[3].y));
  ray.weight = uintBitsToFloat(r[3].x);
  ray.state = r[3].z;
  ray.role = r[3].w;
  return ray;
}

uvec4[4] record(Ray ray) {
  uvec3 normal = floatBitsToUint(ray.normal);
  return uvec4[4](uvec4(ray.pixel, normal.xy), uvec4(floatBitsToUint(ray.origin), floatBitsToUint(ray.t)),
                  uvec4(floatBitsToUint(ray.direction), ray.material),
                  uvec4(floatBitsToUint(ray.weight), normal.z, ray.state, ray.role));
}

Ray from_buffer(uvec4 r[BUFFERED]) { return from_record(r); }
Ray from_carried(uvec4 r[CARRIED]) { return from_record(r); }
uvec4[CARRIED] carried_of(Ray ray) { return record(ray); }
