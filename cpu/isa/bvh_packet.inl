// Sixteen rays side by side: into lanes, out of them one by one, and back.

#include "cpu/isa/bvh_single.inl"

namespace rayengine::ISA {
namespace {

constexpr int parts = group / reals_count;
constexpr unsigned part_bits = (1u << reals_count) - 1;

struct PacketState {
  LocalRays local;
  State<Reals> part[parts];
  unsigned hit = 0;  ///< a bit for each ray
};

INLINE kernels::Mask<Reals> lanes_with(unsigned bits) {
  kernels::Mask<Reals> of_lane{}, all_bits{};
  for (int i = 0; i < reals_count; ++i) of_lane[i] = 1ll << i, all_bits[i] = bits;
  return (all_bits & of_lane) != 0;
}

/// The eight numbers of the rays of a group, by columns; places past the last ray repeat it.
struct Columns {
  alignas(64) double number[8][group];

  Reals of(int i, int part) const { return read<Reals>(number[i] + part * reals_count); }
};

INLINE void load_columns(const Ray* rays, std::size_t count, Columns& columns) {
  for (std::size_t k = 0; k < group; k += 4) {
    const auto row = [&](std::size_t i) {
      return reinterpret_cast<const double*>(rays + (k + i < count ? k + i : count - 1));
    };
    for (int i = 0; i < 8; i += 4) {
      double(*const to)[group] = columns.number + i;
      transpose(row(0) + i, row(1) + i, row(2) + i, row(3) + i, to[0] + k, to[1] + k, to[2] + k, to[3] + k);
    }
  }
}

/// Of the rays of a group; places past the last ray repeat it.
struct ErrorColumns {
  alignas(64) double origin[group] = {}, direction[group] = {};

  ErrorColumns(const RayError* errors, std::size_t count) {
    if (!errors) return;
    for (std::size_t k = 0; k < group; ++k) {
      const RayError& error = errors[k < count ? k : count - 1];
      origin[k] = error.origin, direction[k] = error.direction;
    }
  }
};

template <Ask ask>
INLINE void load_packet(const BvhJob& job, const Columns& columns, const RayError* errors, std::size_t count,
                        PacketState& p) {
  for (int i = 0; i < parts; ++i) {
    State<Reals>& s = p.part[i];
    s.rays.o = {columns.of(0, i), columns.of(1, i), columns.of(2, i)};
    s.rays.d = {columns.of(4, i), columns.of(5, i), columns.of(6, i)};
    s.rays.tmin = columns.of(3, i);
    s.rays.nearest = ask.certain ? columns.of(7, i) : just_above(columns.of(7, i));
    begin(s);
  }
  if (!ask.certain) return;
  const ErrorColumns error(errors, count);
  for (int i = 0; i < parts; ++i)
    begin_certain(job, read<Reals>(error.origin + i * reals_count), read<Reals>(error.direction + i * reals_count),
                  p.part[i]);
}

template <Ask ask>
INLINE State<double> extract(const State<Reals>& s, int i) {
  const auto vec = [i](const Vec3<Reals>& v) { return Vec3<double>{v.x[i], v.y[i], v.z[i]}; };
  const Sheared<Reals>& h = s.sheared;
  State<double> one{{vec(s.rays.o), vec(s.rays.d), s.rays.tmin[i], s.rays.nearest[i], s.rays.object[i], true},
                    {h.x_last[i] != 0, h.y_last[i] != 0, vec(h.shear), 0, 0, 0, 0},
                    s.index[i],
                    s.part[i],
                    s.u[i],
                    s.v[i],
                    {}};
  if (!ask.certain) return one;
  one.sheared.corner_error = h.corner_error[i];
  one.sheared.widest_error = h.widest_error[i];
  one.sheared.depth_error = h.depth_error[i];
  one.sheared.per_length = h.per_length[i];
  const Certainty<Reals>& c = s.certainty;
  one.certainty = {c.t[i], c.low[i], c.rival[i], c.o_extra[i], c.d_size[i]};
  return one;
}

template <Ask ask>
INLINE void put_back(const State<double>& from, State<Reals>& s, int i) {
  s.rays.nearest[i] = from.rays.nearest;
  s.rays.object[i] = from.rays.object;
  s.index[i] = from.index, s.part[i] = from.part, s.u[i] = from.u, s.v[i] = from.v;
  if (!ask.certain) return;
  const Certainty<double>& c = from.certainty;
  s.certainty.t[i] = c.t, s.certainty.low[i] = c.low, s.certainty.rival[i] = c.rival;
}

/// A ray that needs no more: no box reaches it.
INLINE void end_ray(PacketState& p, int k) { p.local.length[k] = -1; }

INLINE void load_local(const BvhJob& job, const Columns& columns, LocalRays& local) {
  for (int place = 0; place < group; place += packet) {
    reals column[8];
    for (int c = 0; c < 8; ++c) column[c] = read<reals>(columns.number[c] + place);
    to_local(job, column, local, place);
  }
}

/// Those of the first `count` rays of a group that reach the tree, a bit for each.
INLINE unsigned living(const LocalRays& local, std::size_t count) {
  unsigned alive = 0;
  for (int i = 0; i < parts; ++i)
    alive |= lanes_of(read<kernels::Mask<Reals>>(local.alive + i * reals_count)) << (i * reals_count);
  return alive & ((1u << count) - 1);
}

INLINE void keep_alive(LocalRays& local, unsigned alive) {
  for (int k = 0; k < group; ++k) local.alive[k] = alive >> k & 1;
}

}  // namespace
}  // namespace rayengine::ISA
