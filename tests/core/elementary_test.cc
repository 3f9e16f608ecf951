// SPDX-License-Identifier: BSD-3-Clause
// Errors against long double, whose 64 bits of mantissa make its own error 0.001 units of a double; special
// values against <cmath>; bits that no processor may change.
#include "core/elementary.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/hash.h"
#include "core/random.h"

namespace halocline {
namespace {

constexpr std::uint64_t kArguments = 200'000;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double units_off(double value, long double exact) {
  int exponent = 0;
  std::frexp(static_cast<double>(exact), &exponent);
  return static_cast<double>(std::abs(value - exact) / std::ldexp(1.0L, std::max(exponent - 53, -1074)));
}

struct Range {
  double low, high;
};

double argument(Range range, std::uint64_t which) {
  return range.low + (range.high - range.low) * uniform_at({.seed = 1, .which = which});
}

template <class Function, class Exact>
double worst(Range range, Function function, Exact exact) {
  double most = 0;
  for (std::uint64_t i = 0; i < kArguments; ++i) {
    const double x = argument(range, i);
    const double off = units_off(function(x), exact(static_cast<long double>(x)));
    most = off <= most ? most : off;  // NaN counts
  }
  return most;
}

// Over all magnitudes of a double.
template <class Function, class Exact>
double worst_of_powers_of_two(Range exponents, Function function, Exact exact) {
  return worst(
      exponents, [&](double e) { return function(std::exp2(e)); },
      [&](long double e) { return exact(std::exp2(static_cast<double>(e))); });
}

TEST(ElementaryFunctions, ExponentialsAreWithinTheirErrors) {
  const auto exact = [](long double x) { return std::exp(x); };
  const auto exact10 = [](long double x) { return std::pow(10.0L, x); };
  for (const Range range : {Range{-1, 1}, {-700, 700}, {-708, -707}, {-740, -708.5}, {708, 709.7}})
    EXPECT_LT(worst(range, elementary::exp, exact), 0.9) << range.low;
  for (const Range range : {Range{-1, 1}, {-300, 300}, {306.9, 308.2}})
    EXPECT_LT(worst(range, elementary::exp10, exact10), 1.3) << range.low;
}

TEST(ElementaryFunctions, LogarithmsAreWithinTheirErrors) {
  const auto exact = [](long double x) { return std::log(x); };
  const auto exact2 = [](long double x) { return std::log2(x); };
  const auto exact10 = [](long double x) { return std::log10(x); };
  for (const Range range : {Range{0.3, 3}, {0.99, 1.01}, {1 - 1e-9, 1 + 1e-9}}) {
    EXPECT_LT(worst(range, elementary::log, exact), 0.9) << range.low;
    EXPECT_LT(worst(range, elementary::log2, exact2), 1.7) << range.low;
    EXPECT_LT(worst(range, elementary::log10, exact10), 1.8) << range.low;
  }
  EXPECT_LT(worst_of_powers_of_two({-1073, 1023}, elementary::log, exact), 0.9);
  EXPECT_LT(worst_of_powers_of_two({-1073, 1023}, elementary::log2, exact2), 1.7);
  EXPECT_LT(worst_of_powers_of_two({-1073, 1023}, elementary::log10, exact10), 1.8);
}

TEST(ElementaryFunctions, ThoseForLoopsAreWithinTheirErrors) {
  const auto exact = [](long double x) { return std::exp(x); };
  const auto exact_log = [](long double x) { return std::log1p(x); };
  EXPECT_LT(worst({-708, 708}, elementary::exp_within, exact), 0.9);
  for (const Range range : {Range{0, 0.5}, {0.4, 0.45}, {0.9, 3}, {1e15, 1e16}})
    EXPECT_LT(worst(range, elementary::log1p_within, exact_log), 1.5) << range.low;
  EXPECT_LT(worst_of_powers_of_two({-1022, 996}, elementary::log1p_within, exact_log), 1.5);
  EXPECT_EQ(elementary::log1p_within(0), 0);
}

TEST(ElementaryFunctions, SinesAreWithinTheirErrorsAtAllAngles) {
  const auto sine = [](long double x) { return std::sin(x); };
  const auto cosine = [](long double x) { return std::cos(x); };
  for (const double most : {0.8, 10.0, 1e4, 1e6, 1e12}) {
    EXPECT_LT(worst({-most, most}, elementary::sin, sine), 1.1) << most;
    EXPECT_LT(worst({-most, most}, elementary::cos, cosine), 1.1) << most;
  }
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const double x = argument({-1e7, 1e7}, i);
    EXPECT_EQ(elementary::sin_cos(x).sine, elementary::sin(x));
    EXPECT_EQ(elementary::sin_cos(x).cosine, elementary::cos(x));
  }
}

// Where one of the two is a small difference of large numbers.
TEST(ElementaryFunctions, SinesNearMultiplesOfAQuarterTurnKeepTheirDigits) {
  double most = 0;
  for (int k = 1; k < 600'000; ++k) {
    const double x = k * (std::numbers::pi / 2);
    const long double exact =
        k % 2 == 0 ? std::sin(static_cast<long double>(x)) : std::cos(static_cast<long double>(x));
    most = std::max(most, units_off(k % 2 == 0 ? elementary::sin(x) : elementary::cos(x), exact));
  }
  EXPECT_LT(most, 1.1);
}

TEST(ElementaryFunctions, TheOthersAreWithinTheirErrors) {
  using Real = long double;
  EXPECT_LT(worst({-10, 10}, elementary::tan, [](Real x) { return std::tan(x); }), 1);
  EXPECT_LT(worst({-1, 1}, elementary::asin, [](Real x) { return std::asin(x); }), 1);
  EXPECT_LT(worst({-1, 1}, elementary::acos, [](Real x) { return std::acos(x); }), 1);
  EXPECT_LT(worst({-10, 10}, elementary::atan, [](Real x) { return std::atan(x); }), 1.3);
  EXPECT_LT(worst({-10, 10}, elementary::cosh, [](Real x) { return std::cosh(x); }), 1);
  EXPECT_LT(worst({1, 100}, elementary::acosh, [](Real x) { return std::acosh(x); }), 1);
  EXPECT_LT(worst({-0.99, 0.99}, elementary::atanh, [](Real x) { return std::atanh(x); }), 1);
  EXPECT_LT(worst({-5, 5}, elementary::expm1, [](Real x) { return std::expm1(x); }), 1.8);
  EXPECT_LT(worst({-0.9, 5}, elementary::log1p, [](Real x) { return std::log1p(x); }), 0.9);
  EXPECT_LT(worst({-100, 100}, elementary::cbrt, [](Real x) { return std::cbrt(x); }), 1);
  EXPECT_LT(worst({-5, 26}, elementary::erfc, [](Real x) { return std::erfc(x); }), 4.5);
  EXPECT_LT(worst({3, 500}, elementary::lgamma, [](Real x) { return std::lgamma(x); }), 1.5);
  for (const double other : {-3.0, -1e-3, 0.7, 200.0}) {
    const Real y = other;
    EXPECT_LT(worst(
                  {-10, 10}, [&](double x) { return elementary::atan2(x, other); },
                  [&](Real x) { return std::atan2(x, y); }),
              1.6);
    EXPECT_LT(worst(
                  {-10, 10}, [&](double x) { return elementary::hypot(x, other); },
                  [&](Real x) { return std::hypot(x, y); }),
              1.2);
    EXPECT_LT(worst(
                  {0, 30}, [&](double x) { return elementary::pow(x, other); },
                  [&](Real x) { return std::pow(x, y); }),
              1);
  }
}

TEST(ElementaryFunctions, WholePowersAreProducts) {
  for (const int n : {-7, -2, -1, 0, 1, 2, 3, 4, 17}) {
    const auto power = [&](double x) { return elementary::pow(x, n); };
    EXPECT_LT(worst({0.1, 10}, power, [&](long double x) { return std::pow(x, n); }),
              std::max(std::abs(n), 1))
        << n;
  }
  EXPECT_EQ(elementary::pow(-3.0, 3), -27);
}

TEST(ElementaryFunctions, SpecialValuesAreThoseOfTheLibrary) {
  const std::vector<double> values{0.0,     -0.0,  1,      -1,  kInfinity, -kInfinity, std::nan(""), 5e-324,
                                   -5e-324, 1e308, -1e308, 710, -746,      309,        -325};
  const auto same = [](double a, double b) {
    return std::isnan(a) ? std::isnan(b) : a == b && std::signbit(a) == std::signbit(b);
  };
  for (const double x : values) {
    const bool is_special = !std::isfinite(std::exp(x)) || std::exp(x) == 0 || x == 0;
    if (is_special) {
      EXPECT_TRUE(same(elementary::exp(x), std::exp(x))) << x;
    }
    const double tenfold = std::pow(10.0, x);
    if (!std::isfinite(tenfold) || tenfold == 0 || x == 0) {
      EXPECT_TRUE(same(elementary::exp10(x), tenfold)) << x;
    }
    if (!(x > 0 && x != 1 && std::isfinite(x))) {
      EXPECT_TRUE(same(elementary::log(x), std::log(x))) << x;
      EXPECT_TRUE(same(elementary::log2(x), std::log2(x))) << x;
      EXPECT_TRUE(same(elementary::log10(x), std::log10(x))) << x;
    }
    if (x == 0 || !std::isfinite(x)) {
      EXPECT_TRUE(same(std::abs(elementary::sin(x)), std::abs(std::sin(x)))) << x;
      EXPECT_TRUE(same(elementary::cos(x), std::cos(x))) << x;
      EXPECT_TRUE(same(elementary::hypot(x, 1), std::hypot(x, 1))) << x;
    }
  }
  EXPECT_EQ(elementary::hypot(3, 4), 5);
  EXPECT_EQ(elementary::hypot(2, 3, 6), 7);
}

TEST(ElementaryFunctions, ComplexNumbersGoRoundByTheSameFunctions) {
  for (const double angle : {-3.0, -0.1, 0.0, 1.0, 2.5}) {
    const std::complex<double> z = elementary::polar(2, angle);
    EXPECT_DOUBLE_EQ(elementary::abs(z), 2);
    EXPECT_NEAR(elementary::arg(z), angle, 1e-15);
  }
}

// The hash was found on an Intel Xeon with AVX-512 with g++ 12; another compiler, level of optimisation or
// processor has the same.
TEST(ElementaryFunctions, BitsAreTheSameEverywhere) {
  std::vector<double> results;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    const double x = argument({-20, 20}, i), positive = std::abs(x) + 1e-9, unit = x / 20;
    const auto [sine, cosine] = elementary::sin_cos(x * 100);
    results.insert(
        results.end(),
        {elementary::exp(x), elementary::exp10(x), elementary::log(positive), elementary::log2(positive),
         elementary::log10(positive), sine, cosine, elementary::hypot(x, 1.5),
         elementary::pow(positive, unit), elementary::tan(x), elementary::asin(unit), elementary::acos(unit),
         elementary::atan(x), elementary::atan2(x, 0.3), elementary::cosh(x), elementary::expm1(x),
         elementary::log1p(positive), elementary::cbrt(x), elementary::erfc(unit * 5)});
  }
  EXPECT_EQ(xxh3({reinterpret_cast<const char*>(results.data()), results.size() * sizeof(double)}),
            11667113333772679455u);
}

}  // namespace
}  // namespace halocline
