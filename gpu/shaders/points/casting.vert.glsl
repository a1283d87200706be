// Where no ray follows another one: intersects the camera's rays, and shades what they see.
layout(location = 0) in uvec4 buffered[BUFFERED];
layout(location = 25) uniform bool sees_background;
layout(location = 0) flat out uvec4 seen;  // the colour's bits, and the place; or none

void main() {
  Ray ray = eye_ray(from_buffer(buffered).pixel);
  trace(ray);
  bool shows = ray.material != none || sees_background;
  seen = uvec4(floatBitsToUint(brought_by(ray)[0].rgb), shows ? place_of(ray) : none);
}
