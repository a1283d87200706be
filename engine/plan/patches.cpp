#include "engine/plan/patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numeric>
#include <span>

namespace rayengine {
namespace {

constexpr std::uint32_t patch_triangles = 48;
constexpr std::size_t terms = 10;    // of a quadric's equation
constexpr double on_quadric = 1e-5;  // residual, of the patch's size: well above what files of floats round
constexpr std::size_t least_vertices = 2 * terms;  // fewer lie on some quadric whatever they are

using Row = std::array<double, terms>;
using Moments = std::array<Row, terms>;

double area(const Geometry& g, const glm::uvec3& t) {
  return glm::length(glm::cross(g.vertex(t.y) - g.vertex(t.x), g.vertex(t.z) - g.vertex(t.x))) / 2;
}

std::vector<glm::dvec3> vertices_of(const Geometry& g, std::span<const glm::uvec3> triangles) {
  std::vector<std::uint32_t> used;
  for (const glm::uvec3& t : triangles) used.insert(used.end(), {t.x, t.y, t.z});
  std::ranges::sort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<glm::dvec3> points;
  for (const std::uint32_t v : used) points.push_back(g.vertex(v));
  return points;
}

/// About their middle, at most 1 from it; soups give each corner again.
void normalise(std::vector<glm::dvec3>& points) {
  Box box;
  for (const glm::dvec3& p : points) box.add(p);
  const double size = std::max(glm::length(box.size()) / 2, 1e-300);
  for (glm::dvec3& p : points) p = (p - box.center()) / size;
}

Moments moments(std::span<const glm::dvec3> points) {
  Moments m{};
  const double share = 1 / static_cast<double>(points.size());
  for (const glm::dvec3& p : points) {
    const Row row{p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.y, p.y * p.z, p.z * p.x, p.x, p.y, p.z, 1};
    for (std::size_t i = 0; i < terms; ++i)
      for (std::size_t j = 0; j < terms; ++j) m[i][j] += share * row[i] * row[j];
  }
  return m;
}

/// The symmetric matrix after Gauss's elimination with full pivoting, its columns in the order taken. Pivots fall, and
/// the last bounds the smallest eigenvalue within a factor: the mean square of the best quadric over the points.
struct Eliminated {
  Moments m;
  std::array<std::size_t, terms> order;

  explicit Eliminated(const Moments& moments) : m(moments) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t k = 0; k < terms && step(k); ++k) {
    }
  }

  bool vanishes(std::size_t k) const { return m[k][k] < on_quadric * on_quadric; }

  /// The coefficients that the last pivot goes with.
  Row last() const {
    Row solution{};
    for (std::size_t k = terms; k-- > 0;) {
      double sum = k + 1 == terms ? m[k][k] : 0;
      for (std::size_t j = k + 1; j < terms; ++j) sum -= m[k][j] * solution[order[j]];
      solution[order[k]] = k + 1 == terms ? 1 : sum / m[k][k];
    }
    return solution;
  }

 private:
  bool step(std::size_t k) {
    std::size_t largest = k;
    for (std::size_t i = k; i < terms; ++i)
      if (m[i][i] > m[largest][largest]) largest = i;
    std::swap(m[k], m[largest]);
    for (Row& row : m) std::swap(row[k], row[largest]);
    std::swap(order[k], order[largest]);
    if (!(m[k][k] > 0)) return false;
    for (std::size_t i = k + 1; i < terms; ++i)
      for (std::size_t j = terms; j-- > k;) m[i][j] -= m[i][k] / m[k][k] * m[k][j];
    return true;
  }
};

/// Of the quadratic form, by Sylvester's criterion.
bool is_ellipsoid(const Row& c) {
  const double sign = c[0] < 0 ? -1 : 1;
  const glm::dmat3 form(sign * c[0], sign * c[3] / 2, sign * c[5] / 2, sign * c[3] / 2, sign * c[1], sign * c[4] / 2,
                        sign * c[5] / 2, sign * c[4] / 2, sign * c[2]);
  return form[0][0] > 0 && form[0][0] * form[1][1] > form[0][1] * form[0][1] && glm::determinant(form) > 0;
}

enum class Lies { nowhere, on_quadric, on_ellipsoid };

Lies where_it_lies(const Geometry& g, std::span<const glm::uvec3> triangles) {
  std::vector<glm::dvec3> points = vertices_of(g, triangles);
  if (points.size() < least_vertices) return Lies::nowhere;
  normalise(points);
  const Eliminated e(moments(points));
  if (!e.vanishes(terms - 1)) return Lies::nowhere;
  return !e.vanishes(terms - 2) && is_ellipsoid(e.last()) ? Lies::on_ellipsoid : Lies::on_quadric;
}

}  // namespace

Patches look_at_patches(const Geometry& geometry, std::uint32_t object, std::uint32_t patches) {
  const std::span all = triangles_of(geometry, object);
  const auto count = static_cast<std::uint32_t>(all.size()), at_once = std::min(count, patch_triangles);
  if (count == 0) return {};
  const std::uint32_t looks = std::clamp(count / patch_triangles, 1u, patches);
  Patches result;
  for (std::uint32_t i = 0; i < looks; ++i) {
    const std::size_t first = std::size_t{count - at_once} * i / std::max(looks - 1, 1u);
    const std::span patch = all.subspan(first, at_once);
    for (const glm::uvec3& t : patch) result.area += area(geometry, t) / (looks * at_once);
    const Lies lies = where_it_lies(geometry, patch);
    result.quadric_share += lies != Lies::nowhere ? 1.0 / looks : 0;
    result.ball_share += lies == Lies::on_ellipsoid ? 1.0 / looks : 0;
  }
  return result;
}

}  // namespace rayengine
