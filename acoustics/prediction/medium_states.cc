// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/prediction/medium_states.h"

#include <cmath>
#include <complex>

#include "core/vector_clones.h"

namespace halocline::acoustics {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t kFrequencies = kSignalFrequencies;

// Complex product without the standard library's tests for infinities.
Complex product(Complex a, Complex b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

}  // namespace

void BlockFading::scale(double factor) {
  for (double& power : steady) power *= factor;
  for (double& power : varying) power *= factor;
  block_power *= factor;
}

namespace {

// Cholesky factor, lower triangular. The correlation of few paths is rank deficient: pivots of the size of
// rounding errors are set to 0.
using Root = std::array<BandPressures, kFrequencies>;
Root root_of(const BandCorrelation& correlation) {
  Root rows{};
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    for (std::size_t n = 0; n <= m; ++n) {
      const double pivot = rows[n][n].real();
      if (n < m && !(pivot > 0)) continue;
      Complex rest = correlation[m - n];
      for (std::size_t k = 0; k < n; ++k) rest -= product(rows[m][k], std::conj(rows[n][k]));
      if (n < m) {
        rows[m][n] = rest / pivot;
      } else {
        rows[m][m] = rest.real() > 1e-9 * correlation[0].real() ? std::sqrt(rest.real()) : 0;
      }
    }
  }
  return rows;
}

using States = MediumNormals::States;

HALOCLINE_VECTOR_CLONES
void add_product(Complex factor, const States& re, const States& im, States& sum_re, States& sum_im) {
  const double c = factor.real(), s = factor.imag();
  for (std::size_t i = 0; i < re.size(); ++i) {
    sum_re[i] += c * re[i] - s * im[i];
    sum_im[i] += c * im[i] + s * re[i];
  }
}

}  // namespace

std::array<BlockFading, kMediumStates> medium_states(const ReceptionStatistics& sound,
                                                     const MediumNormals& normals) {
  const Root root = root_of(sound.medium);
  std::array<BlockFading, kMediumStates> states;
  for (std::size_t m = 0; m < kFrequencies; ++m) {
    States re, im;
    re.fill(sound.steady[m].real());
    im.fill(sound.steady[m].imag());
    for (std::size_t k = 0; k <= m; ++k) {
      if (root[k][k].real() > 0) add_product(root[m][k], normals.re[k], normals.im[k], re, im);
    }
    for (std::size_t i = 0; i < kMediumStates; ++i) {
      states[i].steady[m] = re[i] * re[i] + im[i] * im[i];
      states[i].varying[m] = sound.varying[m];
      states[i].block_power += (states[i].steady[m] + states[i].varying[m]) / kFrequencies;
    }
  }
  return states;
}

}  // namespace halocline::acoustics
