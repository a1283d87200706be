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

typedef float floats __attribute__((vector_size(sizeof(reals) / 2)));
typedef long long integers __attribute__((vector_size(sizeof(reals))));
constexpr int packet = sizeof(reals) / sizeof(double);

/// Rays in the local frame, side by side: the point at parameter t0 + s of the walk is origin + s * direction,
/// 0 <= s <= length. The ray's t is (t0 + s) / scale / stride, scale that of the frame.
struct alignas(64) LocalRays {
  float near_origin[3][packet],
      far_origin[3][packet];  ///< moved away from the nearer and the farther plane, times `inverse`
  float inverse[3][packet];   ///< of the direction
  float length[packet];
  double t0[packet], stride[packet];
  long long alive[packet];  ///< 0 when the ray is invalid or passes the scene by
};

template <class V>
static inline V greater(V a, V b) {
  return a > b ? a : b;
}
template <class V>
static inline V lesser(V a, V b) {
  return a < b ? a : b;
}
static inline reals absolute(reals x) { return (reals)((integers)x & 0x7FFFFFFFFFFFFFFF); }
static inline reals with_sign_of(reals x, reals sign) {
  return (reals)((integers)x | ((integers)sign & ~0x7FFFFFFFFFFFFFFF));
}
static inline reals largest(const reals* v) { return greater(greater(absolute(v[0]), absolute(v[1])), absolute(v[2])); }

/// The largest power of two not above a normal positive number, and its inverse.
static inline reals power_below(reals x) { return (reals)((integers)x & (0x7FFll << 52)); }
static inline reals inverse_power(reals power) { return (reals)((2046ll << 52) - (integers)power); }

/// The eight numbers of each ray, from rows to columns; rows past the last repeat it.
static inline void gather(const Ray* rays, std::size_t count, reals* columns) {
  double numbers[8][packet];
  for (std::size_t k = 0; k < packet; ++k) {
    const auto* row = reinterpret_cast<const double*>(rays + (k < count ? k : count - 1));
    for (int i = 0; i < 8; ++i) numbers[i][k] = row[i];
  }
  __builtin_memcpy(columns, numbers, sizeof numbers);
}

/// Clips [enter, leave] to where o + t d lies between two planes. No quotient is NaN: directions are kept from zero.
static inline void clip(reals lower, reals upper, reals o, reals d, reals& enter, reals& leave) {
  const reals tiny = reals{} + 0x1p-900;
  const reals safe = absolute(d) < tiny ? with_sign_of(tiny, d) : d;
  const reals a = (lower - o) / safe, b = (upper - o) / safe;
  enter = greater(lesser(a, b), enter);
  leave = lesser(greater(a, b), leave);
}

static inline void store(float* to, reals value) {
  const floats rounded = __builtin_convertvector(value, floats);
  __builtin_memcpy(to, &rounded, sizeof rounded);
}

/// Takes up to `packet` rays to the local frame. Branch-free: what rays do here is not to be predicted.
static inline void to_local(const WalkJob& job, const Ray* rays, std::size_t count, LocalRays& local) {
  reals column[8];
  gather(rays, count, column);
  const reals *origin = column, *direction = column + 4, tmin = column[3], tmax = column[7];
  const reals nothing =
      (origin[0] * 0 + origin[1] * 0 + origin[2] * 0) + (direction[0] * 0 + direction[1] * 0 + direction[2] * 0);
  const integers valid = (nothing == 0) & (largest(direction) > 0) & (tmin <= tmax);

  // First to a range whose powers of two have inverses, then to a largest component in [1, 2).
  const reals length = largest(direction);
  const reals prescale = length < 0x1p-1000 ? reals{} + 0x1p500 : length > 0x1p1000 ? reals{} + 0x1p-500 : reals{} + 1;
  const reals power = power_below(length * prescale);
  const reals stride = power * inverse_power(prescale);
  reals o[3], d[3];
  for (int axis = 0; axis < 3; ++axis) {
    o[axis] = (origin[axis] - job.center[axis]) * job.scale;
    d[axis] = direction[axis] * prescale * inverse_power(power);
  }
  const reals slack = float_slack + double_slack * largest(o);
  reals enter = tmin * job.scale * stride, leave = tmax * job.scale * stride;
  for (int axis = 0; axis < 3; ++axis)
    clip(job.lower[axis] - slack, job.upper[axis] + slack, o[axis], d[axis], enter, leave);

  // From so far that double cannot place the ray in the scene, it meets all of it.
  const integers lost = slack > 1;
  const reals reach = lost ? reals{} + 4 : slack;
  for (int axis = 0; axis < 3; ++axis) {
    const reals at = lost ? reals{} : o[axis] + enter * d[axis];
    const reals inverse = 1 / (absolute(d[axis]) < least ? with_sign_of(reals{} + least, d[axis]) : d[axis]);
    const reals away = with_sign_of(reach, inverse);
    store(local.inverse[axis], inverse);
    store(local.near_origin[axis], (at + away) * inverse);
    store(local.far_origin[axis], (at - away) * inverse);
  }
  store(local.length, (leave - enter) * (1 + 0x1p-20));
  __builtin_memcpy(local.t0, &enter, sizeof enter);
  __builtin_memcpy(local.stride, &stride, sizeof stride);
  const integers alive = valid & (enter <= leave);
  __builtin_memcpy(local.alive, &alive, sizeof alive);
}

/// One of LocalRays, ready to be tested against nodes.
struct LocalRay {
  lanes near_origin[3], far_origin[3], inverse[3], length;
  unsigned near_side[3];  ///< which plane of a slab is met first

  LocalRay(const LocalRays& rays, int k) : length(all(rays.length[k])) {
    for (int axis = 0; axis < 3; ++axis) {
      near_origin[axis] = all(rays.near_origin[axis][k]);
      far_origin[axis] = all(rays.far_origin[axis][k]);
      inverse[axis] = all(rays.inverse[axis][k]);
      near_side[axis] = rays.inverse[axis][k] < 0;
    }
  }
};

/// What a ray meets of a node: a bit per lane, and where.
static inline unsigned meet(const WideNode& node, const LocalRay& ray, lanes after, float* entries) {
  lanes enter = all(0), leave = ray.length;
  for (int axis = 0; axis < 3; ++axis) {
    const float* near = node.planes[axis][ray.near_side[axis]];
    const float* far = node.planes[axis][1 - ray.near_side[axis]];
    enter = larger(multiply_subtract(load(near), ray.inverse[axis], ray.near_origin[axis]), enter);
    leave = smaller(multiply_subtract(load(far), ray.inverse[axis], ray.far_origin[axis]), leave);
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

/// Lists the next leaves of ray k of a packet; moves its cursor.
static inline std::uint32_t walk_one(const WalkJob& job, const LocalRays& rays, int k, double tmin, WalkCursor& cursor,
                                     TreeletEntry* list) {
  std::uint32_t count = 0;
  const std::uint64_t last = cursor.last;
  const LocalRay local(rays, k);
  const lanes after = all(entry_of(last));
  job.queue[0] = WalkCursor::end;  // above all keys: where an insertion stops
  std::uint64_t* const begin = job.queue + 1;
  begin[0] = key_of(0, 0);
  for (std::uint64_t* end = begin + 1; end != begin;) {
    const std::uint64_t key = *--end;
    const std::uint32_t child = static_cast<std::uint32_t>(key);
    if (child & WideNode::leaf) {
      if (key <= last) continue;
      const double t = (rays.t0[k] + entry_of(key)) * job.inverse_scale / rays.stride[k];
      list[count++] = {t > tmin ? t : tmin, child ^ WideNode::leaf};
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
  for (std::size_t first = 0; first < job.ray_count; first += packet) {
    LocalRays local;
    to_local(job, job.rays + first, job.ray_count - first, local);
    for (std::size_t k = 0; k < packet && first + k < job.ray_count; ++k) {
      const std::size_t i = first + k;
      if (job.cursors[i].finished() || !local.alive[k]) {
        job.cursors[i].last = WalkCursor::end;
        job.counts[i] = 0;
      } else {
        job.counts[i] =
            walk_one(job, local, static_cast<int>(k), job.rays[i].tmin, job.cursors[i], job.lists + i * job.capacity);
      }
    }
  }
}
