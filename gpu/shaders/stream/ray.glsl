// What the passes over a stream of rays share: one texel a ray. Coordinates are those of the scene's LocalFrame.
layout(binding = 0) uniform sampler2D origins;      // origin, tmin
layout(binding = 1) uniform sampler2D directions;   // direction, tmax
layout(binding = 2) uniform usampler2D lists;       // treelets front to back, `none` behind the last
layout(binding = 3) uniform usampler2D entries;     // x: a hit at tmin counts if its rank is above this; y: t, as two halves, where
                                                    // the ray enters the second and third treelet
layout(binding = 4) uniform usampler2D hits;        // the nearest so far: bits of t, and rank; or `none`
layout(binding = 5) uniform usamplerBuffer ranges;  // of treelet * types + type: first primitive and count

layout(location = 1) uniform int round;  // the place in their lists at which all rays are
layout(location = 2) uniform int type;   // the place of this pass's type among the scene's
layout(location = 3) uniform int types;

layout(location = 4) uniform uvec2 object_range;  // first primitive and count, for tracers that go by objects

const uint none = 0xFFFFFFFFu;

uvec2 range_of(uint treelet, int place) { return texelFetch(ranges, int(treelet) * types + place).xy; }
uvec2 range_of(uint treelet) { return range_of(treelet, type); }
