// The camera's rays. After stream/ray.glsl, points/ray.glsl and points/view.glsl; see traverse.glsl and shade.glsl for what the targets hold.
layout(location = 0) out uvec2 hit;
layout(location = 1) out uvec4 place;
layout(location = 2) out vec4 origin;
layout(location = 3) out vec4 direction;
layout(location = 4) out vec4 gathered;
layout(location = 5) out vec4 weight;
layout(location = 24) uniform uvec2 start;  // the list and the state with which rays set out

const uint no_more = 4u;

void main() {
  uvec2 pixel = uvec2(gl_FragCoord.xy);
  Ray ray = eye_ray(pixel);
  bool there = pixel.x < screen_size.x && pixel.y < screen_size.y;
  // From afar they begin two lengths before the middle of the scene, which spans two: where numbers are small.
  float apart = max(max(abs(ray.origin.x), abs(ray.origin.y)), abs(ray.origin.z));
  float skipped = apart > 4 ? max(-dot(ray.origin, ray.direction) - 2, 0) : 0;
  hit = uvec2(0x7F7FFFFFu, none);
  place = uvec4(start.x, none, there ? start.y : no_more, 0);
  origin = vec4(ray.origin + skipped * ray.direction, -skipped);
  direction = vec4(ray.direction, far_away);
  gathered = vec4(0);
  weight = vec4(1, 1, 1, 0);
}
