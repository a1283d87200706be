#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/plan/recognise/cloud.h"
#include "engine/plan/recognise/fit.h"
#include "engine/plan/recognise/symmetric.h"

// The form x^T Q x with the least sum of squares over a region's corners is the eigenvector of the smallest eigenvalue
// of the sum of the monomials' products. Its principal axes then say which of the unit primitives it is.
namespace rayengine::surfaces {
namespace {

/// Below this share of the largest, a coefficient is taken for zero.
constexpr double zero = 1e-5;

/// f(p) = p^T a p + 2 b p + c, in the frame of the eigenvectors of a.
struct Form {
  glm::dmat3 axes;     ///< columns
  glm::dvec3 squares;  ///< of the largest absolute value 1
  glm::dvec3 linear;
  double constant;

  double at(const glm::dvec3& p) const { return glm::dot(squares * p, p) + 2 * glm::dot(linear, p) + constant; }
  /// Where the gradient vanishes along every axis with a square.
  glm::dvec3 center() const {
    glm::dvec3 p(0);
    for (int i = 0; i < 3; ++i)
      if (squares[i] != 0) p[i] = -linear[i] / squares[i];
    return p;
  }
};

std::optional<Form> least_squares(const Patch& patch, const Cloud& cloud) {
  Matrix<10> m{};
  each_corner(patch, [&](const glm::dvec3& at) { add_outer<10>(m, monomials(cloud.local(at))); });
  const Eigen<10> fit = eigen(m);
  if (!(fit.values[0] < zero * fit.values[1])) return {};  // more than one quadric would do
  const Vector<10>& q = fit.vectors[0];
  const Eigen<3> principal =
      eigen<3>({{{q[0], q[3] / 2, q[4] / 2}, {q[3] / 2, q[1], q[5] / 2}, {q[4] / 2, q[5] / 2, q[2]}}});
  Form form;
  for (int i = 0; i < 3; ++i) {
    form.squares[i] = principal.values[i];
    for (int k = 0; k < 3; ++k) form.axes[i][k] = principal.vectors[i][k];
  }
  if (glm::determinant(form.axes) < 0) form.axes[0] = -form.axes[0];
  const double largest = std::max(std::abs(form.squares[0]), std::abs(form.squares[2]));
  if (!(largest > zero)) return {};
  form.squares /= largest;
  for (int i = 0; i < 3; ++i)
    if (std::abs(form.squares[i]) < zero) form.squares[i] = 0;
  form.linear = glm::dvec3(q[6], q[7], q[8]) * form.axes / (2 * largest);
  form.constant = q[9] / largest;
  return form;
}

/// Makes axis `i` the third, turning the others along.
void make_third(Form& form, int i) {
  const int a = (i + 1) % 3, b = (i + 2) % 3;
  form.axes = {form.axes[a], form.axes[b], form.axes[i]};
  form.squares = {form.squares[a], form.squares[b], form.squares[i]};
  form.linear = {form.linear[a], form.linear[b], form.linear[i]};
}

/// Turns the third axis round, and the second with it.
void turn_over(Affine& map) { map.linear[1] = -map.linear[1], map.linear[2] = -map.linear[2]; }

/// A saddle is one from either side, with what rises and what falls exchanged.
void turn_inside_out(Candidate& saddle) {
  glm::dmat3& m = saddle.to_world.linear;
  m = {m[1], m[0], -m[2]};
  std::swap(saddle.half.x, saddle.half.y);
}

class Classifier {
 public:
  Classifier(const Region& region, const Cloud& cloud, const Form& form)
      : region_(region), cloud_(cloud), form_(form) {}

  std::optional<Candidate> run() {
    int zeros = 0;
    for (int i = 0; i < 3; ++i) zeros += form_.squares[i] == 0;
    if (zeros > 1) return {};
    const bool found = zeros == 0 ? central() : parabolic();
    return found ? std::optional(candidate_) : std::nullopt;
  }

 private:
  /// Places the unit primitive at the centre with these lengths of axes, in the cloud's space, if there is a way back.
  bool place(const glm::dvec3& lengths, const glm::dvec3& center) {
    Affine& map = candidate_.to_world;
    for (int i = 0; i < 3; ++i) map.linear[i] = cloud_.extent * lengths[i] * form_.axes[i];
    map.origin = cloud_.world(form_.axes * center);
    return is_invertible(map);
  }

  glm::dvec3 local(const glm::dvec3& p) const { return inverse(candidate_.to_world).point(p); }

  /// Heights of the outline, and of the whole region.
  Box outline() const {
    Box box;
    each_outline_edge(region_, [&](const glm::dvec3& p, const glm::dvec3&) { box.add(local(p)); });
    return box;
  }
  double mean_height() const { return local(cloud_.mean).z; }

  bool central() {
    const glm::dvec3 center = form_.center();
    const double level = -form_.at(center);
    if (std::abs(level) < zero) return false;
    const glm::dvec3 squares = form_.squares / level;
    int positive = 0;
    for (int i = 0; i < 3; ++i) positive += squares[i] > 0;
    if (positive == 0) return false;
    // The axis is the one whose sign is alone.
    for (int i = 0; i < 3; ++i)
      if (positive != 3 && (squares[i] > 0) == (positive == 1)) return round(i, center, squares, positive);
    return round(2, center, squares, positive);
  }

  bool round(int axis, glm::dvec3 center, glm::dvec3 squares, int positive) {
    make_third(form_, axis);
    center = {center[(axis + 1) % 3], center[(axis + 2) % 3], center[axis]};
    squares = {squares[(axis + 1) % 3], squares[(axis + 2) % 3], squares[axis]};
    if (!place(1. / glm::sqrt(glm::abs(squares)), center)) return false;
    constexpr QuadricType types[]{QuadricType::hyperboloid2, QuadricType::hyperboloid1, QuadricType::sphere};
    candidate_.type = types[positive - 1];
    if (positive == 3) return true;
    if (positive == 1 && mean_height() < 0) turn_over(candidate_.to_world);
    const Box rim = outline();
    candidate_.clip = {positive == 1 ? 0 : rim.lower.z, rim.upper.z};
    return candidate_.clip[0] < candidate_.clip[1];
  }

  bool parabolic() {
    for (int i = 0; i < 3; ++i)
      if (form_.squares[i] == 0) {
        make_third(form_, i);
        break;
      }
    glm::dvec3 vertex = form_.center();
    const double slope = 2 * form_.linear.z;
    if (std::abs(slope) < zero) return false;
    vertex.z = -form_.at(vertex) / slope;
    // squares.x x^2 + squares.y y^2 = -slope z
    const glm::dvec3 curvature = form_.squares / -slope;
    const bool saddle = curvature.x * curvature.y < 0;
    candidate_.type = saddle ? QuadricType::saddle : QuadricType::paraboloid;
    if (!place({1 / std::sqrt(std::abs(curvature.x)), 1 / std::sqrt(std::abs(curvature.y)), 1}, vertex)) return false;
    return saddle ? finish_saddle(curvature.x < 0) : finish_paraboloid(curvature.x < 0);
  }

  /// Scaled so that its rim is at z = 1.
  bool finish_paraboloid(bool over) {
    Affine& map = candidate_.to_world;
    if (over) turn_over(map);
    const double height = outline().upper.z;
    if (!(height > 0)) return false;
    map.linear = {std::sqrt(height) * map.linear[0], std::sqrt(height) * map.linear[1], height * map.linear[2]};
    candidate_.clip = {0, 1};
    return true;
  }

  /// Scaled so that it reaches to x = 1.
  bool finish_saddle(bool over) {
    Affine& map = candidate_.to_world;
    if (over) map.linear = {map.linear[1], -map.linear[0], map.linear[2]};  // x is where it rises
    const Box box = outline();
    const double x = box.upper.x;
    if (!(x > 0)) return false;
    map.linear = {x * map.linear[0], x * map.linear[1], x * x * map.linear[2]};
    candidate_.half = {1, box.upper.y / x};
    if (std::abs(candidate_.half.y - 1) < zero) candidate_.half.y = 1;
    return candidate_.half.y > 0;
  }

  const Region& region_;
  const Cloud& cloud_;
  Form form_;
  Candidate candidate_;
};

}  // namespace

std::optional<Candidate> fit_quadric(const Region& region) {
  const Sample sample(region);
  const auto& [few, patch, cloud] = sample;
  if (!cloud.usable()) return {};
  const std::optional<Form> form = least_squares(patch, cloud);
  if (!form) return {};
  std::optional<Candidate> found = Classifier(region, cloud, *form).run();
  if (!found || found->type == QuadricType::sphere || !faces_inward(region, *found)) return found;
  if (found->type == QuadricType::saddle)
    turn_inside_out(*found);
  else
    found->inward = true;
  return found;
}

}  // namespace rayengine::surfaces
