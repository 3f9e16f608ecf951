#include "acoustics/math/functions.h"

#include <cmath>
#include <numbers>

#include <boost/math/special_functions/erf.hpp>

#include "core/elementary.h"

namespace halocline::acoustics {

using std::numbers::pi;
using std::numbers::sqrt2;

double sinc(double x) { return std::abs(x) < 1e-9 ? 1 : elementary::sin(pi * x) / (pi * x); }

double normal_probability(double x) { return elementary::erfc(-x / sqrt2) / 2; }

// Phi^-1(p) = sqrt(2) erf^-1(2 p - 1).
double normal_quantile(double probability) { return sqrt2 * boost::math::erf_inv(2 * probability - 1); }

}  // namespace halocline::acoustics
