// The next ray of each path: refracted or, at mirrors and beyond the critical angle, reflected. Paths that hit nothing have
// ended, and keep their last ray, with a tmax below its tmin. After the ray, consider and triangle
// sources of stream.
layout(binding = 12) uniform samplerBuffer indices;  // of refraction, by rank; 0 for a mirror
layout(binding = 14) uniform samplerBuffer normals;  // three texels a triangle: at its corners; zeros for the flat one
layout(location = 5) uniform int last_rank;          // of the first triangle: they come by falling rank
layout(location = 0) out vec4 next_origin;
layout(location = 1) out vec4 next_direction;

// How far from its plane a triangle may still be seen where a ray leaves it, in the frame, where the scene is 2 wide.
const float clearance = 1.0f / (1 << 18);

// The interpolated normal, where the triangle has such.
vec3 shading_normal(int i, vec3 o, vec3 d, vec3 flat_normal) {
  float t;
  float u;
  float v;
  bool hit;
  triangle(o, d, uintBitsToFloat(texelFetch(triangles, i).xyz), uintBitsToFloat(texelFetch(triangles, i + 1).xyz),
           uintBitsToFloat(texelFetch(triangles, i + 2).xyz), t, u, v, hit);
  vec3 n = (1 - u - v) * texelFetch(normals, i).xyz + u * texelFetch(normals, i + 1).xyz + v * texelFetch(normals, i + 2).xyz;
  return dot(n, n) > 0 ? normalize(n) : flat_normal;
}

// Directions of unit length. Where an interpolated normal would bend a ray to the wrong side of the surface, a refracted one
// passes straight, and a reflected one obeys the flat normal.
vec3 scattered(vec3 d, vec3 flat_normal, vec3 normal, float index) {
  bool entering = dot(d, flat_normal) < 0;
  vec3 facing = dot(d, normal) < 0 ? normal : -normal;
  vec3 through = index == 0 ? vec3(0) : refract(d, facing, entering ? 1 / index : index);
  if (through != vec3(0)) return dot(through, flat_normal) < 0 == entering ? through : d;
  vec3 back = reflect(d, facing);
  return dot(back, flat_normal) < 0 == entering ? reflect(d, flat_normal) : back;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 o = texelFetch(origins, at, 0);
  vec4 d = texelFetch(directions, at, 0);
  uvec2 hit = texelFetch(hits, at, 0).xy;
  next_origin = o;
  next_direction = vec4(d.xyz, -1);
  if (d.w < o.w || hit.y == none) return;
  int i = 3 * (last_rank - int(hit.y));
  vec3 flat_normal = triangle_normal(i);
  vec3 normal = shading_normal(i, o.xyz, d.xyz, flat_normal);
  vec3 along = normalize(scattered(normalize(d.xyz), flat_normal, normal, texelFetch(indices, int(hit.y)).x));
  next_origin = vec4(o.xyz + uintBitsToFloat(hit.x) * d.xyz, clearance / abs(dot(along, flat_normal)));
  next_direction = vec4(along, 1e37);
}
