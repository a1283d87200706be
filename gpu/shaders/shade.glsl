// What surfaces do with light, without shadows. After highlight.glsl. Positions are those of the scene's LocalFrame.
layout(binding = 12) uniform usamplerBuffer owners;   // of a primitive, by rank: its material
layout(binding = 13) uniform samplerBuffer materials;  // two texels each: colour and ambient; diffuse, specular, shininess, reflect
layout(binding = 14) uniform samplerBuffer lights;     // two texels each: position, or direction to it where w is 0; colour

// How far rays start off the surface, in the frame, where the scene is 2 wide: the error of a hit in single precision.
const float clearance = 1.0 / (1 << 17);

struct Finish {
  vec3 color;
  float ambient;
  float diffuse;
  float specular;
  float shininess;
  float reflect;
};

uint material_of(uint rank) { return texelFetch(owners, int(rank)).x; }

Finish finish_of_material(uint material) {
  vec4 a = texelFetch(materials, 2 * int(material));
  vec4 b = texelFetch(materials, 2 * int(material) + 1);
  return Finish(a.rgb, a.a, b.x, b.y, b.z, b.w);
}

Finish finish_of(uint rank) { return finish_of_material(material_of(rank)); }

// All the way to a light that has a place, else a direction of unit length.
vec3 towards_light(int light, vec3 position) {
  vec4 place = texelFetch(lights, 2 * light);
  return place.xyz - place.w * position;
}

// What the surface sends to the eye of a light in this direction of unit length; the normal faces the eye.
vec3 from_light(int light, Finish f, vec3 normal, vec3 to_light, vec3 view) {
  float cosine = dot(normal, to_light);
  if (!(cosine > 0)) return vec3(0);
  float shine = f.specular > 0 ? f.specular * highlight(f.shininess, normal, to_light, view) : 0;
  return texelFetch(lights, 2 * light + 1).rgb * (f.diffuse * cosine * f.color + shine);
}
