// Tests the rays that have come to a voxel that lists anything. After intersect.glsl, or shade.glsl where they are shaded.
layout(location = 1) out uvec4 place;

void main() {
  read_ray();
#ifdef SHADED
  read_carried();
#endif
  place = intersect(read_place());
  end();
}
