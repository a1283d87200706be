// The camera's rays, for paths to begin with.
layout(location = 1) uniform vec3 eye;
layout(location = 2) uniform vec3 corner;  // from the eye to the middle of the first pixel
layout(location = 3) uniform vec3 right;   // from pixel to pixel
layout(location = 4) uniform vec3 down;
layout(location = 5) uniform ivec2 picture;  // in pixels
layout(location = 0) out vec4 origin;        // origin, tmin
layout(location = 1) out vec4 direction;     // direction, tmax: below tmin where there is no pixel, only the rest of a tile

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  bool there = pixel.x < picture.x && pixel.y < picture.y;
  origin = vec4(eye, 0);
  direction = vec4(normalize(corner + float(pixel.x) * right + float(pixel.y) * down), there ? 1e37 : -1);
}
