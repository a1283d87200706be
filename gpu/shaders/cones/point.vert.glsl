// A primitive over a tile of rays, as one point of the tile's size: moved out of view where the tile's cone passes the
// primitive's sphere. One instance a tile. After prelude.glsl and ray_cone.glsl.
layout(binding = 9) uniform sampler2D apexes;       // apex, cosine
layout(binding = 10) uniform sampler2D axes;          // axis, sine
layout(binding = 11) uniform samplerBuffer spheres;  // centre, radius; of triangles, then of quadrics
layout(location = 5) uniform int tile;               // rays along a side
layout(location = 6) uniform ivec2 extent;           // of the viewport, in rays
layout(location = 7) uniform int first_sphere;       // of this type of primitives
layout(location = 0) flat out uint primitive;

void main() {
  int columns = extent.x / tile;
  ivec2 at = ivec2(gl_InstanceID % columns, gl_InstanceID / columns);
  vec4 a = texelFetch(apexes, at, 0);
  vec4 x = texelFetch(axes, at, 0);
  vec4 sphere = texelFetch(spheres, first_sphere + gl_VertexID);
  vec2 centre = (2 * vec2(at) + 1) * tile / extent - 1;
  primitive = gl_VertexID;
  gl_Position = vec4(cone_passes(a.xyz, x.xyz, a.w, x.w, sphere.xyz, sphere.w) ? vec2(-9) : centre, 0, 1);
}
