layout(local_size_x = SIDE) in;
layout(binding = 0, r32ui) uniform writeonly uimage2D results;

void main() {
  ivec2 place = ivec2(gl_LocalInvocationID.x, gl_WorkGroupID.x);
  imageStore(results, place, uvec4(answer(place.y * SIDE + place.x)));
}
