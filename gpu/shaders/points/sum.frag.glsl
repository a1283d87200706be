// Adds up the layers, one for each target and generation.
layout(binding = 0) uniform sampler2DArray layers;
layout(location = 0) out vec4 color;

void main() {
  color = vec4(0, 0, 0, 1);
  for (int i = 0; i < textureSize(layers, 0).z; ++i) color.rgb += texelFetch(layers, ivec3(gl_FragCoord.xy, i), 0).rgb;
}
