// Part of walk_lanes.h: rays taken to the local frame of a BVH, several at once.
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

constexpr int group = 16;  // rays that are walked together where they keep together

/// Rays in the local frame, side by side: the point at parameter t0 + s of the walk is origin + s * direction,
/// 0 <= s <= length. The ray's t is (t0 + s) / scale / stride, scale that of the frame.
struct alignas(64) LocalRays {
  float origin[3][group];
  float slack[group];           ///< how much boxes are to be grown
  float near_origin[3][group];  ///< the origin moved away from the nearer plane by the slack, times `inverse`
  float far_origin[3][group];   ///< the same for the farther plane
  float inverse[3][group];      ///< of the direction
  float length[group];
  double t0[group], stride[group];
  long long alive[group];  ///< 0 when the ray is invalid or passes the scene by
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

/// Clips [enter, leave] to where o + t / inverse lies between two planes. No product is NaN: inverses are not zero.
static inline void clip(reals lower, reals upper, reals o, reals inverse, reals& enter, reals& leave) {
  const reals a = (lower - o) * inverse, b = (upper - o) * inverse;
  enter = greater(lesser(a, b), enter);
  leave = lesser(greater(a, b), leave);
}

static inline void store(float* to, reals value) {
  const floats rounded = __builtin_convertvector(value, floats);
  __builtin_memcpy(to, &rounded, sizeof rounded);
}

/// Takes `packet` rays, given by their eight numbers, to the local frame, from `place` on. Branch-free: what rays do
/// here is not to be predicted.
static inline void to_local(const WalkSpace& space, const reals* column, LocalRays& local, int place) {
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
    o[axis] = (origin[axis] - space.center[axis]) * space.scale;
    d[axis] = direction[axis] * prescale * inverse_power(power);
  }
  const reals slack = float_slack + double_slack * largest(o);
  reals enter = tmin * space.scale * stride, leave = tmax * space.scale * stride;
  reals inverse[3];
  for (int axis = 0; axis < 3; ++axis) {
    inverse[axis] = absolute(d[axis]) < 0x1p-900 ? with_sign_of(reals{} + 0x1p900, d[axis]) : 1 / d[axis];
    clip(space.lower[axis] - slack, space.upper[axis] + slack, o[axis], inverse[axis], enter, leave);
  }

  // From so far that double cannot place the ray in the scene, it meets all of it.
  const integers lost = slack > 1;
  const reals reach = lost ? reals{} + 4 : slack;
  for (int axis = 0; axis < 3; ++axis) {
    const reals at = lost ? reals{} : o[axis] + enter * d[axis];
    const reals bounded = absolute(d[axis]) < least ? with_sign_of(reals{} + 1 / least, d[axis]) : inverse[axis];
    const reals away = with_sign_of(reach, bounded);
    store(local.origin[axis] + place, at);
    store(local.inverse[axis] + place, bounded);
    store(local.near_origin[axis] + place, (at + away) * bounded);
    store(local.far_origin[axis] + place, (at - away) * bounded);
  }
  store(local.slack + place, reach);
  store(local.length + place, (leave - enter) * (1 + 0x1p-20));
  __builtin_memcpy(local.t0 + place, &enter, sizeof enter);
  __builtin_memcpy(local.stride + place, &stride, sizeof stride);
  const integers alive = valid & (enter <= leave);
  __builtin_memcpy(local.alive + place, &alive, sizeof alive);
}

/// The same for up to `packet` rays in rows.
static inline void to_local(const WalkSpace& space, const Ray* rays, std::size_t count, LocalRays& local, int place) {
  reals column[8];
  gather(rays, count, column);
  to_local(space, column, local, place);
}
