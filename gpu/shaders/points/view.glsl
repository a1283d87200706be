// The rays of the camera, and where pixels lie on the screen.
layout(location = 19) uniform vec3 eye;
layout(location = 20) uniform vec3 view_corner;  // from the eye to the middle of the first pixel
layout(location = 21) uniform vec3 view_right;   // from pixel to pixel
layout(location = 22) uniform vec3 view_down;
layout(location = 23) uniform vec2 screen_size;  // in pixels

Ray eye_ray(uvec2 pixel) {
  vec3 direction = view_corner + float(pixel.x) * view_right + float(pixel.y) * view_down;
  return Ray(pixel, waiting, sees, 1, eye, normalize(direction), far_away, none, vec3(0));
}

vec4 screen_position(uvec2 pixel) { return vec4((2 * vec2(pixel) + 1) / screen_size - 1, 0, 1); }
