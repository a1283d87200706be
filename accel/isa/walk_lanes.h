// The walk of one ray, over the eight lanes that the including file names. No include guard and no shared inline
// functions: each instruction set has its own copy, in its own namespace, that no linker can mistake for another's.
//
// Why no box is missed. Rays are moved into the local frame in double, there to where they enter the scene, and only
// then rounded to float, so that all coordinates are at most 2 and all quotients of moderate size. Every rounding on
// the way (of the origin, the direction, its reciprocal, the differences and products) then amounts to a plane
// displaced by at most 8 units of 2^-24 in the frame, and the double part to some 2^-50 of the origin's distance.
// `slack` is more than both, and boxes are grown by it, by moving the origin away from either plane. Directions with a
// component below `least` get that instead, of the same sign: over the few units that a ray spends in the scene it
// moves by less than the slack.

constexpr double float_slack = 10 * 0x1p-24;
constexpr double double_slack = 0x1p-49;
constexpr float least = 0x1p-30f;

/// A ray in the local frame: the point at parameter t0 + s of the walk is origin + s * direction, 0 <= s <= length.
struct LocalRay {
  float near_origin[3], far_origin[3];  ///< moved away from the nearer and the farther plane, times `inverse`
  float inverse[3];                     ///< of the direction
  unsigned near_side[3];                ///< which plane of a slab is met first
  float length;
  double t0, shorter, longer;  ///< the ray's t is (t0 + s) * shorter / longer
};

static inline double absolute(double x) { return x < 0 ? -x : x; }
static inline double largest(const double* v) {
  const double a = absolute(v[0]), b = absolute(v[1]), c = absolute(v[2]);
  const double ab = a > b ? a : b;
  return ab > c ? ab : c;
}

/// The power of two that takes a positive double to [1, 2).
static inline double normaliser(double x) {
  unsigned long long bits;
  __builtin_memcpy(&bits, &x, sizeof bits);
  bits = (2046 - (bits >> 52)) << 52;
  double result;
  __builtin_memcpy(&result, &bits, sizeof result);
  return result;
}

static inline bool is_finite(const Ray& r) {
  return (r.origin.x * 0 + r.origin.y * 0) + (r.origin.z * 0 + r.direction.x * 0) +
             (r.direction.y * 0 + r.direction.z * 0) ==
         0;
}

/// Clips [enter, leave] to where o + t d, |d| >= 1, lies between two planes. No quotient is NaN: directions are kept
/// from zero.
static inline void clip(double lower, double upper, double o, double d, double& enter, double& leave) {
  const double tiny = 0x1p-900;
  const double safe = absolute(d) < tiny ? __builtin_copysign(tiny, d) : d;
  const double a = (lower - o) / safe, b = (upper - o) / safe;
  const double near = a < b ? a : b, far = a < b ? b : a;
  enter = near > enter ? near : enter;
  leave = far < leave ? far : leave;
}

/// False when the ray is invalid or passes the scene by.
static inline bool to_local(const WalkJob& job, const Ray& ray, LocalRay& local) {
  double d[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
  double longest = largest(d), prescale = 1;
  if (!is_finite(ray) || !(longest > 0) || !(ray.tmin <= ray.tmax)) return false;
  if (__builtin_expect(longest < 0x1p-1000 || longest > 0x1p1000, 0)) {
    prescale = longest < 1 ? 0x1p500 : 0x1p-500;
    for (double& x : d) x *= prescale;
    longest *= prescale;
  }
  const double norm = normaliser(longest);
  double o[3] = {(ray.origin.x - job.center[0]) * job.scale, (ray.origin.y - job.center[1]) * job.scale,
                 (ray.origin.z - job.center[2]) * job.scale};
  double slack = float_slack + double_slack * largest(o);

  // Two factors of moderate size, as their product may overflow.
  const double longer = job.scale, shorter = prescale * norm;
  double enter = ray.tmin * longer / shorter, leave = ray.tmax * longer / shorter;
  for (int axis = 0; axis < 3; ++axis) {
    d[axis] *= norm;
    clip(job.lower[axis] - slack, job.upper[axis] + slack, o[axis], d[axis], enter, leave);
  }
  if (!(enter <= leave)) return false;

  // From so far that double cannot place the ray in the scene: it meets all of it.
  const bool lost = slack > 1;
  if (lost) slack = 4;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = lost ? 0 : o[axis] + enter * d[axis];
    const float rounded = static_cast<float>(d[axis]);
    const float inverse = 1 / (absolute(rounded) < least ? __builtin_copysignf(least, rounded) : rounded);
    const double away = inverse > 0 ? slack : -slack;
    local.inverse[axis] = inverse;
    local.near_origin[axis] = static_cast<float>(at + away) * inverse;
    local.far_origin[axis] = static_cast<float>(at - away) * inverse;
    local.near_side[axis] = inverse > 0 ? 0 : 1;
  }
  local.length = static_cast<float>((leave - enter) * (1 + 0x1p-20));
  local.t0 = enter;
  local.shorter = shorter;
  local.longer = longer;
  return true;
}

/// What a ray meets of a node: a bit per lane, and where.
static inline unsigned meet(const WideNode& node, const LocalRay& ray, lanes after, float* entries) {
  lanes enter = all(0), leave = all(ray.length);
  for (int axis = 0; axis < 3; ++axis) {
    const float* near = node.planes[axis][ray.near_side[axis]];
    const float* far = node.planes[axis][1 - ray.near_side[axis]];
    const lanes inverse = all(ray.inverse[axis]);
    enter = larger(multiply_subtract(load(near), inverse, all(ray.near_origin[axis])), enter);
    leave = smaller(multiply_subtract(load(far), inverse, all(ray.far_origin[axis])), leave);
  }
  store(entries, enter);
  return not_above(larger(enter, after), leave);
}

/// Orders what waits in the queue: by entry, then nodes before leaves, then by number. Entries are never negative.
static inline std::uint64_t key_of(float entry, std::uint32_t child) {
  std::uint32_t bits;
  __builtin_memcpy(&bits, &entry, sizeof bits);
  return static_cast<std::uint64_t>(bits) << 32 | child;
}
static inline float entry_of(std::uint64_t key) {
  const std::uint32_t bits = static_cast<std::uint32_t>(key >> 32);
  float entry;
  __builtin_memcpy(&entry, &bits, sizeof entry);
  return entry;
}

/// Keeps the queue sorted, its least key last.
static inline std::uint64_t* insert(std::uint64_t* end, std::uint64_t key) {
  std::uint64_t* at = end;
  for (; at[-1] < key; --at) *at = at[-1];
  *at = key;
  return end + 1;
}

/// Lists the next leaves of one ray; moves its cursor.
static inline std::uint32_t walk_one(const WalkJob& job, const Ray& ray, WalkCursor& cursor, TreeletEntry* list) {
  LocalRay local;
  std::uint32_t count = 0;
  if (cursor.finished() || !to_local(job, ray, local)) {
    cursor.last = WalkCursor::end;
    return 0;
  }
  const std::uint64_t last = cursor.last;
  const lanes after = all(entry_of(last));
  job.queue[0] = WalkCursor::end;  // above all keys: where an insertion stops
  std::uint64_t* const begin = job.queue + 1;
  begin[0] = key_of(0, 0);
  for (std::uint64_t* end = begin + 1; end != begin;) {
    const std::uint64_t key = *--end;
    const std::uint32_t child = static_cast<std::uint32_t>(key);
    if (child & WideNode::leaf) {
      if (key <= last) continue;
      const double t = (local.t0 + entry_of(key)) * local.shorter / local.longer;
      list[count++] = {t > ray.tmin ? t : ray.tmin, child ^ WideNode::leaf};
      cursor.last = key;
      if (count == job.capacity) return count;
      continue;
    }
    const WideNode& node = job.nodes[child];
    alignas(32) float entries[WideNode::width];
    for (unsigned met = meet(node, local, after, entries); met; met &= met - 1) {
      const int lane = __builtin_ctz(met);
      end = insert(end, key_of(entries[lane], node.children[lane]));
    }
  }
  cursor.last = WalkCursor::end;
  return count;
}

void walk(const WalkJob& job) {
  for (std::size_t i = 0; i < job.ray_count; ++i)
    job.counts[i] = walk_one(job, job.rays[i], job.cursors[i], job.lists + i * job.capacity);
}
