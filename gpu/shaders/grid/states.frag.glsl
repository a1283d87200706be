// Makes each ray's state its depth. After ray.glsl; see traverse.glsl.
void main() { gl_FragDepth = float(texelFetch(lists, ivec2(gl_FragCoord.xy), 0).z) / 4; }
