// The colour that each ray sees of what it hit: ambient light, and what lights it reflects, without shadows. After packed.glsl,
// whose streams it reads, and highlight.glsl. Positions are those of the scene's LocalFrame.
layout(binding = 1) uniform usamplerBuffer owners;    // of a primitive, by rank: its material
layout(binding = 2) uniform samplerBuffer materials;  // two texels each: colour and ambient; diffuse, specular, shininess
layout(binding = 3) uniform samplerBuffer lights;     // two texels each: position, or direction to it where w is 0; colour
layout(location = 1) uniform int light_count;
layout(location = 0) out vec4 color;                  // a: whether anything was hit

vec3 reflected_light(vec4 tint, vec3 finish, vec3 normal, vec3 to_light, vec3 view) {
  float cosine = dot(normal, to_light);
  if (!(cosine > 0)) return vec3(0);
  return finish.x * cosine * tint.rgb + finish.y * highlight(finish.z, normal, to_light, view);
}

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
  int material = 2 * int(texelFetch(owners, int(hit.w)).x);
  vec4 tint = texelFetch(materials, material);
  vec3 finish = texelFetch(materials, material + 1).xyz;
  color = vec4(tint.a * tint.rgb, 1);
  for (int i = 0; i < light_count; ++i) {
    vec4 place = texelFetch(lights, 2 * i);
    vec3 to_light = normalize(place.xyz - place.w * position);
    color.rgb += texelFetch(lights, 2 * i + 1).rgb * reflected_light(tint, finish, normal, to_light, view);
  }
}
