// What happens at the end of a ray's way, after intersect.glsl and the shared shade.glsl. One ray at most goes on from a surface:
// the reflected one where it mirrors, else one to the first light. Light that no ray asks after is taken to arrive. Defined
// from outside: NORMAL_ALL, a NORMAL_OF for each type that the scene has.
layout(binding = 15) uniform sampler2D gathered_so_far;  // light; a: how often the ray was reflected
layout(binding = 16) uniform sampler2D weights;          // of what it will bring; a: whether it goes to a light
layout(location = 20) uniform int reflections;
layout(location = 21) uniform bool shadows;
layout(location = 22) uniform int light_count;
layout(location = 23) uniform vec3 background;
layout(location = 24) uniform uvec2 start;  // the list and the state with which rays set out

const float far_away = 1e37;

vec4 gathered;
vec4 weight;

void read_carried() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  gathered = texelFetch(gathered_so_far, at, 0);
  weight = texelFetch(weights, at, 0);
  any_will_do = weight.a != 0;
}

uvec4 set_out(vec3 from, vec3 way, float until) {
  origin = from;
  direction = way;
  tmin = 0;
  tmax = until;
  best_t = REAL_MAX;
  best_rank = none;
  any_will_do = weight.a != 0;
  return uvec4(start.x, none, start.y, 0);
}

#define NORMAL_OF(type_place, NORMAL) \
  if (best_primitive >> 28 == type_place) normal = NORMAL;

// Faces the ray.
vec3 normal_at(vec3 position) {
  int i = int(best_primitive & 0x0FFFFFFFu);
  uint rank = best_rank;
  vec3 normal = vec3(0);
  NORMAL_ALL
  return dot(normal, direction) > 0 ? -normal : normal;
}

uvec4 to_first_light(vec3 from) {
  vec3 way = towards_light(0, from);
  bool has_place = texelFetch(lights, 0).w != 0;
  return set_out(from, normalize(way), has_place ? length(way) : far_away);
}

uvec4 shade_surface() {
  vec3 position = origin + best_t * direction;
  vec3 normal = normal_at(position);
  vec3 view = -normalize(direction);
  Finish finish = finish_of(best_rank);
  bool mirrors = finish.reflect > 0 && gathered.a < reflections;
  vec3 asked_after = vec3(0);
  gathered.rgb += weight.rgb * finish.ambient * finish.color;
  for (int i = 0; i < light_count; ++i) {
    vec3 seen = weight.rgb * from_light(i, finish, normal, normalize(towards_light(i, position)), view);
    if (i == 0 && shadows && !mirrors) asked_after = seen;
    else gathered.rgb += seen;
  }
  vec3 from = position + clearance * normal;
  if (mirrors) {
    gathered.a += 1;
    weight.rgb *= finish.reflect;
    return set_out(from, reflect(-view, normal), far_away);
  }
  if (asked_after == vec3(0)) return uvec4(none, none, done, 0);
  weight = vec4(asked_after, 1);
  return to_first_light(from);
}

uvec4 shade() {
  bool to_light = weight.a != 0;
  bool hit = best_rank != none;
  if (hit && !to_light) return shade_surface();
  if (!hit) gathered.rgb += to_light ? weight.rgb : weight.rgb * background;
  return uvec4(none, none, done, 0);
}
