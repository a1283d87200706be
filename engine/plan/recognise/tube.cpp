#include "engine/plan/recognise/tube.h"

#include <algorithm>
#include <limits>

#include "engine/plan/recognise/symmetric.h"

// Normals of a cylinder lie in a plane through the origin, those of a cone in one off it: the plane's normal is the
// axis (Gauss map; Chaperon and Goulette, "Extracting cylinders in full 3D data using a random sampling method and the
// Gaussian image", 2001). Gauss and Newton's steps on the corners' distances then refine all parameters at once.
namespace rayengine::surfaces {
namespace {

glm::dvec3 vec(const Vector<3>& v) { return {v[0], v[1], v[2]}; }

/// The normal of the plane in which the triangles' normals are, and where: the cosine between it and them.
struct GaussMap {
  glm::dvec3 axis;
  double cosine;
};

std::optional<GaussMap> gauss_map(const Patch& patch, double extent) {
  double area = 0;
  glm::dvec3 sum(0);
  Matrix<3> squares{};
  each_normal(patch, [&](glm::dvec3 n) {
    n = n / extent / extent;
    const double size = glm::length(n);
    if (!(size > 0)) return;
    area += size, sum += n;
    add_outer<3>(squares, {n.x, n.y, n.z}, 1 / size);
  });
  if (!(area > 0)) return {};
  sum /= area;
  add_outer<3>(squares, {sum.x, sum.y, sum.z}, -area);
  const Eigen<3> spread = eigen(squares);
  constexpr double flat = 0.05;  // of the spread: normals of other surfaces leave every plane
  if (!(spread.values[0] < flat * spread.values[1])) return {};
  return GaussMap{vec(spread.vectors[0]), glm::dot(sum, vec(spread.vectors[0]))};
}

/// The circle about an axis through the origin that is nearest to the points seen along it, by linear least squares.
std::optional<Tube> first_guess(const Patch& patch, const Cloud& cloud, const glm::dvec3& axis, double slope) {
  const glm::dmat3 turn = frame_about(axis);
  Matrix<3> m{};
  Vector<3> b{};
  each_corner(patch, [&](const glm::dvec3& at) {
    const glm::dvec3 p = cloud.local(at) * turn;
    const double right = p.x * p.x + p.y * p.y - slope * slope * p.z * p.z;
    // |q - c|^2 = (r + k z)^2 is linear in c and r^2 - |c|^2, and in r k z, which is zero on the average.
    const Vector<3> row{2 * p.x, 2 * p.y, 1};
    add_outer<3>(m, row);
    for (int i = 0; i < 3; ++i) b[i] += row[i] * right;
  });
  const auto c = solve(m, b);
  if (!c) return {};
  const double rr = (*c)[2] + (*c)[0] * (*c)[0] + (*c)[1] * (*c)[1];
  if (!(rr > 0)) return {};
  return Tube{turn * glm::dvec3((*c)[0], (*c)[1], 0), axis, std::sqrt(rr), slope};
}

/// What a step changes: the base's shift and the axis' tilt across it, the radius, and for a cone the slope; or the
/// last two alone.
enum Step : std::size_t { profile = 2, cylinder = 5, cone = 6 };

template <Step N>
Vector<N> derivatives(const Tube& tube, const glm::dvec3& p, double distance) {
  if constexpr (N == profile) {
    return {-1, -p.z};
  } else {
    const double ux = distance > 0 ? p.x / distance : 0, uy = distance > 0 ? p.y / distance : 0;
    Vector<N> row{-ux, -uy, -p.z * ux - tube.slope * p.x, -p.z * uy - tube.slope * p.y, -1};
    if constexpr (N == cone) row[5] = -p.z;
    return row;
  }
}

/// False, and nothing changes, where the corners leave open what the step is to be.
template <Step N>
bool refine(const Patch& patch, const Cloud& cloud, Tube& tube) {
  const glm::dmat3 turn = frame_about(tube.axis);
  Matrix<N> m{};
  Vector<N> b{};
  each_corner(patch, [&](const glm::dvec3& at) {
    const glm::dvec3 p = (cloud.local(at) - tube.base) * turn;
    const double distance = std::sqrt(p.x * p.x + p.y * p.y), off = distance - tube.radius - tube.slope * p.z;
    const Vector<N> row = derivatives<N>(tube, p, distance);
    add_outer<N>(m, row);
    for (std::size_t i = 0; i < N; ++i) b[i] -= row[i] * off;
  });
  const auto step = solve<N>(m, b);
  if (!step) return false;
  const auto& s = *step;
  if constexpr (N != profile) {
    tube.base += turn * glm::dvec3(s[0], s[1], 0);
    tube.axis = glm::normalize(turn * glm::dvec3(s[2], s[3], 1));
  }
  tube.radius += s[N == profile ? 0 : 4];
  if constexpr (N != cylinder) tube.slope += s[N - 1];
  return true;
}

double noise(const Patch& patch, const Cloud& cloud, const Tube& tube) {
  double most = std::numeric_limits<double>::epsilon();
  each_corner(patch, [&](const glm::dvec3& p) { most = std::max(most, std::abs(tube.off(cloud.local(p)))); });
  return most;
}

/// Steps converge in quadrature where there is a tube: what is still this far off after two of them is none.
constexpr double hopeless = 0.05;

/// A cylinder that is off by no more than roundings leaves nothing for a cone to do better.
constexpr double exact = 1e-12;

template <Step N>
std::optional<FittedTube> fit(const Patch& patch, const Cloud& cloud, const GaussMap& map, double slope) {
  std::optional<Tube> tube = first_guess(patch, cloud, map.axis, slope);
  if (!tube) return {};
  for (int i = 0; i < 6; ++i) {
    if (i == 2 && noise(patch, cloud, *tube) > hopeless * tube->radius) return {};
    // A cone's apex and one circle say nothing of its axis, other than that the normals are at one angle to it.
    if (!refine<N>(patch, cloud, *tube) && (N == cylinder || !refine<profile>(patch, cloud, *tube))) return {};
    if (!(tube->radius > 0 && std::isfinite(tube->radius + tube->slope))) return {};
  }
  return FittedTube{*tube, noise(patch, cloud, *tube)};
}

}  // namespace

std::optional<FittedTube> fit_cylinder(const Patch& patch, const Cloud& cloud) {
  const auto map = gauss_map(patch, cloud.extent);
  return map ? fit<cylinder>(patch, cloud, *map, 0) : std::nullopt;
}

std::vector<FittedTube> fit_cylinder_and_cones(const Patch& patch, const Cloud& cloud) {
  const auto map = gauss_map(patch, cloud.extent);
  if (!map) return {};
  std::vector<FittedTube> found;
  if (const auto tube = fit<cylinder>(patch, cloud, *map, 0)) found.push_back(*tube);
  if (!found.empty() && found[0].noise < exact * found[0].tube.radius) return found;
  const double sine = std::clamp(map->cosine, -1., 1.), slope = sine / std::sqrt(1 - sine * sine);
  for (const double sign : {1., -1.})  // the normals do not say which side of the surface is its outside
    if (const auto tube = fit<cone>(patch, cloud, *map, sign * slope); tube && tube->tube.slope != 0)
      found.push_back(*tube);
  return found;
}

}  // namespace rayengine::surfaces
