// Shades the rays that have come to the end of their way. After shade.glsl.
layout(location = 1) out uvec4 place;
layout(location = 2) out vec4 next_origin;
layout(location = 3) out vec4 next_direction;
layout(location = 4) out vec4 gathered_by_now;
layout(location = 5) out vec4 next_weight;

void main() {
  read_ray();
  read_carried();
  place = read_place();
  place = shade();
  end();
  next_origin = vec4(origin, tmin);
  next_direction = vec4(direction, tmax);
  gathered_by_now = gathered;
  next_weight = weight;
}
