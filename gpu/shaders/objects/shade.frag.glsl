// The colour that each ray sees of what it hit: ambient light, and what lights it reflects. After packed.glsl, whose streams
// it reads, and shade.glsl.
layout(location = 1) uniform int light_count;
layout(location = 0) out vec4 color;  // a: whether anything was hit

void main() {
  uvec4 hit = texelFetch(hits, ivec2(gl_FragCoord.xy), 0);
  color = vec4(0);
  if (hit.w == none) return;
  vec3 from;
  vec3 along;
  vec3 position;
  vec3 normal;
  unpack(texelFetch(rays, ivec2(gl_FragCoord.xy), 0).xyz, from, along);
  unpack(hit.xyz, position, normal);
  vec3 view = -normalize(along);
  normal = dot(normal, view) < 0 ? -normalize(normal) : normalize(normal);
  Finish finish = finish_of(hit.w);
  color = vec4(finish.ambient * finish.color, 1);
  for (int i = 0; i < light_count; ++i)
    color.rgb += from_light(i, finish, normal, normalize(towards_light(i, position)), view);
}
