// Where no ray follows another one: drops those that see nothing, and passes the others on. After casting.vert.glsl.
layout(points) in;
layout(points, max_vertices = 1) out;
layout(location = 0) flat in uvec4 seen[];
layout(location = 0) flat out vec4 shown[SHOWN];

void main() {
  if (seen[0].w == none) return;
  Ray ray;
  set_place(ray, seen[0].w);
  shown[0] = vec4(uintBitsToFloat(seen[0].xyz), 1);
  gl_Position = screen_position(ray.pixel);
  EmitVertex();
}
