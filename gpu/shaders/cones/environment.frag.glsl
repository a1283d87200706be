// What each path sees at its end: the environment, a latitude-longitude image, along its last ray. Its middle column lies in
// +x, its top row in +z; bilinear between the middles of its pixels.
layout(binding = 1) uniform sampler2D directions;
layout(binding = 13) uniform sampler2D environment;  // rows from the top
layout(location = 0) out vec4 color;

const float pi = 3.14159265;

void main() {
  vec3 d = texelFetch(directions, ivec2(gl_FragCoord.xy), 0).xyz;
  vec2 size = vec2(textureSize(environment, 0));
  float longitude = atan(d.y, d.x);
  float latitude = atan(d.z, length(d.xy));
  vec2 place = vec2(0.5f - longitude / (2 * pi), 0.5f - latitude / pi) * size - 0.5f;
  vec2 first = floor(place);
  vec2 part = place - first;
  ivec2 a = ivec2(first);
  ivec2 columns = (ivec2(a.x, a.x + 1) + int(size.x)) % int(size.x);  // which meet behind the viewer
  ivec2 rows = clamp(ivec2(a.y, a.y + 1), 0, int(size.y) - 1);
  vec4 top = mix(texelFetch(environment, ivec2(columns.x, rows.x), 0), texelFetch(environment, ivec2(columns.y, rows.x), 0), part.x);
  vec4 bottom = mix(texelFetch(environment, ivec2(columns.x, rows.y), 0), texelFetch(environment, ivec2(columns.y, rows.y), 0), part.x);
  color = mix(top, bottom, part.y);
}
