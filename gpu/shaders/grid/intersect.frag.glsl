// Tests the rays that have come to a voxel that lists anything. After intersect.glsl.
layout(location = 1) out uvec4 place;

void main() {
  read_ray();
  place = intersect(texelFetch(lists, ivec2(gl_FragCoord.xy), 0));
  end();
}
