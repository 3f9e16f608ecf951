// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/math/symmetric_eigenproblem.h"

#include <cmath>
#include <limits>
#include <utility>

#include "core/check.h"

namespace halocline::acoustics {
namespace {

constexpr int kMaxIterations = 64;  // of one eigenvalue; two suffice on average

// A tridiagonal matrix, and the product of the reflections that led to it.
struct Tridiagonal {
  std::vector<double> diagonal, below;  // below[i] couples i - 1 and i; below[0] is 0
  std::vector<double> rows;             // n x n: row k becomes eigenvector k
};

// Householder vector of row `i` left of the diagonal: u, with (1 - u u^T / h) mapping the row to a multiple
// of its last element's unit vector. Returns h; 0 when the row is zero already.
double reflection(const double* row, std::size_t i, std::vector<double>& u, double& below) {
  double squares = 0;
  for (std::size_t k = 0; k < i; ++k) squares += row[k] * row[k];
  const double last = row[i - 1];
  if (squares == last * last) {
    below = last;
    return 0;
  }
  const double length = last > 0 ? -std::sqrt(squares) : std::sqrt(squares);
  below = length;
  for (std::size_t k = 0; k < i; ++k) u[k] = row[k];
  u[i - 1] = last - length;
  return squares - last * length;
}

// a <- (1 - u u^T / h) a (1 - u u^T / h) of the leading i x i part.
void reflect_both_sides(std::vector<double>& a, std::size_t n, std::size_t i, const std::vector<double>& u,
                        double h, std::vector<double>& p) {
  for (std::size_t k = 0; k < i; ++k) p[k] = 0;
  for (std::size_t j = 0; j < i; ++j) {
    const double* row = &a[j * n];
    for (std::size_t k = 0; k < i; ++k) p[k] += row[k] * u[j];
  }
  double up = 0;
  for (std::size_t k = 0; k < i; ++k) up += u[k] * (p[k] /= h);
  const double share = up / (2 * h);
  for (std::size_t k = 0; k < i; ++k) p[k] -= share * u[k];
  for (std::size_t j = 0; j < i; ++j) {
    double* row = &a[j * n];
    const double uj = u[j], pj = p[j];
    for (std::size_t k = 0; k < i; ++k) row[k] -= uj * p[k] + pj * u[k];
  }
}

// rows <- rows (1 - u u^T / h), acting on the first i columns of the first i rows, which alone differ from 0
// and 1 there.
void reflect_rows(std::vector<double>& rows, std::size_t n, std::size_t i, const std::vector<double>& u,
                  double h) {
  for (std::size_t j = 0; j < i; ++j) {
    double* row = &rows[j * n];
    double along = 0;
    for (std::size_t k = 0; k < i; ++k) along += row[k] * u[k];
    along /= h;
    for (std::size_t k = 0; k < i; ++k) row[k] -= along * u[k];
  }
}

Tridiagonal reduced(std::vector<double> a, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) a[k * n + i] = a[i * n + k];
  }
  Tridiagonal t{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n * n)};
  std::vector<std::vector<double>> reflections(n, std::vector<double>(n));
  std::vector<double> h(n), p(n);
  for (std::size_t i = n; i-- > 1;) {
    h[i] = reflection(&a[i * n], i, reflections[i], t.below[i]);
    if (h[i] != 0) reflect_both_sides(a, n, i, reflections[i], h[i], p);
  }
  for (std::size_t i = 0; i < n; ++i) t.diagonal[i] = a[i * n + i];
  for (std::size_t i = 0; i < n; ++i) t.rows[i * n + i] = 1;
  for (std::size_t i = 1; i < n; ++i) {
    if (h[i] != 0) reflect_rows(t.rows, n, i, reflections[i], h[i]);
  }
  return t;
}

// One implicit QL step on rows l to m of the tridiagonal matrix with the shift `g`.
void ql_step(Tridiagonal& t, std::size_t n, std::size_t l, std::size_t m, double g) {
  double sine = 1, cosine = 1, p = 0;
  for (std::size_t i = m; i-- > l;) {
    const double f = sine * t.below[i + 1], b = cosine * t.below[i + 1];
    const double r = std::sqrt(f * f + g * g);
    if (m > i + 1) t.below[i + 2] = r;
    if (r == 0) {
      t.diagonal[i + 1] -= p;
      return;
    }
    sine = f / r;
    cosine = g / r;
    const double d = t.diagonal[i + 1] - p, q = (t.diagonal[i] - d) * sine + 2 * cosine * b;
    p = sine * q;
    t.diagonal[i + 1] = d + p;
    g = cosine * q - b;
    double *upper = &t.rows[i * n], *lower = &t.rows[(i + 1) * n];
    for (std::size_t k = 0; k < n; ++k) {
      const double x = lower[k], y = upper[k];
      lower[k] = sine * y + cosine * x;
      upper[k] = cosine * y - sine * x;
    }
  }
  t.diagonal[l] -= p;
  t.below[l + 1] = g;
}

// The first row from `l` on that is coupled to none below it.
std::size_t end_of_block(const Tridiagonal& t, std::size_t n, std::size_t l) {
  std::size_t m = l;
  for (; m + 1 < n; ++m) {
    const double beside = std::abs(t.diagonal[m]) + std::abs(t.diagonal[m + 1]);
    if (std::abs(t.below[m + 1]) <= std::numeric_limits<double>::epsilon() * beside) break;
  }
  return m;
}

}  // namespace

EigenPairs symmetric_eigenpairs(std::vector<double> symmetric, std::size_t n) {
  require(n >= 1 && symmetric.size() == n * n, "an eigenproblem needs a square matrix");
  Tridiagonal t = reduced(std::move(symmetric), n);
  for (std::size_t l = 0; l < n; ++l) {
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      const std::size_t m = end_of_block(t, n, l);
      if (m == l) break;
      // Wilkinson's shift.
      const double g = (t.diagonal[l + 1] - t.diagonal[l]) / (2 * t.below[l + 1]);
      const double r = std::sqrt(g * g + 1);
      ql_step(t, n, l, m, t.diagonal[m] - t.diagonal[l] + t.below[l + 1] / (g + (g >= 0 ? r : -r)));
    }
  }
  return {std::move(t.diagonal), std::move(t.rows)};
}

}  // namespace halocline::acoustics
