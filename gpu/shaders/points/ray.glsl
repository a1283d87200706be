// A ray, and what it hit: what stages and vertex buffers hand on. Coordinates are those of the scene's LocalFrame.
const float far_away = 1e37;

// Roles: a ray that sees, or the number of a light, from 1, of which it finds whether it is hidden.
const uint sees = 0u;

// States: to be made from the pixel, to be intersected, shown.
const uint fresh = 0u;
const uint waiting = 1u;
const uint finished = 2u;

struct Ray {
  uvec2 pixel;
  uint state;
  uint role;
  float weight;  // what reflections leave of what it sees
  vec3 origin;
  vec3 direction;
  float t;        // where it ends; of the nearest hit, once it is intersected
  uint material;  // of what was hit, or none
  vec3 normal;    // there, of unit length
};
