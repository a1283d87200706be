// A ray, and the nearest hit found so far.
vec3 origin;
vec3 direction;
float tmin;
float tmax;
uint floor_rank;
float best_t;
uint best_rank;

// Keeps a hit, and says so, if it is in the interval and nearer than the best, or as near and of lower rank. One at tmin
// counts if its rank is above the floor.
bool consider(float t, uint rank) {
#ifdef MUTANT_INDEX
  rank ^= 1u;
#endif
  bool inside = t <= tmax && (t > tmin || (t == tmin && rank > floor_rank));
  bool nearer = t < best_t || (t == best_t && rank < best_rank);
  if (!inside || !nearer) return false;
  best_t = t;
  best_rank = rank;
  return true;
}
