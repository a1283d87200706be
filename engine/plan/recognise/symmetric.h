#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace rayengine::surfaces {

template <std::size_t N>
using Vector = std::array<double, N>;
template <std::size_t N>
using Matrix = std::array<Vector<N>, N>;

/// Adds weight * v v^T.
template <std::size_t N>
void add_outer(Matrix<N>& m, const Vector<N>& v, double weight = 1) {
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = 0; j < N; ++j) m[i][j] += weight * v[i] * v[j];
}

/// Solves m x = b for a symmetric positive definite matrix, by Cholesky's factors; nothing when a pivot falls below
/// `least` of its diagonal entry: what is nearly dependent says nothing.
template <std::size_t N>
std::optional<Vector<N>> solve(Matrix<N> m, Vector<N> b, double least = 1e-12) {
  for (std::size_t i = 0; i < N; ++i) {
    const double whole = m[i][i];
    for (std::size_t k = 0; k < i; ++k) m[i][i] -= m[i][k] * m[i][k];
    if (!(m[i][i] > least * whole)) return {};
    m[i][i] = std::sqrt(m[i][i]);
    for (std::size_t j = i + 1; j < N; ++j) {
      for (std::size_t k = 0; k < i; ++k) m[j][i] -= m[j][k] * m[i][k];
      m[j][i] /= m[i][i];
    }
    for (std::size_t k = 0; k < i; ++k) b[i] -= m[i][k] * b[k];
    b[i] /= m[i][i];
  }
  for (std::size_t i = N; i-- > 0;) {
    for (std::size_t k = i + 1; k < N; ++k) b[i] -= m[k][i] * b[k];
    b[i] /= m[i][i];
  }
  return b;
}

template <std::size_t N>
struct Eigen {
  Vector<N> values;   ///< ascending
  Matrix<N> vectors;  ///< unit, one a row
};

/// Eigenvalues and eigenvectors of a symmetric matrix by Jacobi's cyclic rotations (Golub and Van Loan, "Matrix
/// Computations", section 8.5).
template <std::size_t N>
Eigen<N> eigen(Matrix<N> m) {
  Matrix<N> v{};
  for (std::size_t i = 0; i < N; ++i) v[i][i] = 1;
  bool turned = true;
  for (int sweep = 0; sweep < 30 && turned; ++sweep) {
    turned = false;
    for (std::size_t p = 0; p < N; ++p)
      for (std::size_t q = p + 1; q < N; ++q) {
        if (std::abs(m[p][q]) <= 1e-17 * (std::abs(m[p][p]) + std::abs(m[q][q]))) continue;
        turned = true;
        const double tau = (m[q][q] - m[p][p]) / (2 * m[p][q]);
        const double t = std::copysign(1, tau) / (std::abs(tau) + std::hypot(1, tau));
        const double c = 1 / std::hypot(1, t), s = t * c;
        for (std::size_t k = 0; k < N; ++k) {
          const double a = m[k][p], b = m[k][q];
          m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
        }
        for (std::size_t k = 0; k < N; ++k) {
          const double a = m[p][k], b = m[q][k], x = v[p][k], y = v[q][k];
          m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
          v[p][k] = c * x - s * y, v[q][k] = s * x + c * y;
        }
        m[p][q] = m[q][p] = 0;
      }
  }
  Eigen<N> result;
  for (std::size_t i = 0; i < N; ++i) {  // insertion in order
    std::size_t at = i;
    for (; at > 0 && result.values[at - 1] > m[i][i]; --at)
      result.values[at] = result.values[at - 1], result.vectors[at] = result.vectors[at - 1];
    result.values[at] = m[i][i], result.vectors[at] = v[i];
  }
  return result;
}

}  // namespace rayengine::surfaces
