// One triangle over the whole viewport; no vertex data.
layout(location = 0) uniform float depth;

void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, depth, 1);
}
