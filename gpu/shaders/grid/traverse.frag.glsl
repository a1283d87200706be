// Moves the rays that are traversing. After traverse.glsl.
layout(location = 1) out uvec4 place;

void main() {
  read_ray();
  place = traverse(read_place());
}
