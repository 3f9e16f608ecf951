// SPDX-License-Identifier: BSD-3-Clause
#include "bus/lockstep/arithmetic_digest.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

#include "core/elementary.h"
#include "core/frames.h"
#include "core/hash.h"
#include "core/random.h"

namespace halocline::bus {
namespace {

namespace el = elementary;

// Results of all covered functions at the point (x, y, z) in (0, 1)^3.
template <std::size_t N>
std::array<double, N> results_at(double x, double y, double z) {
  const double wide = std::ldexp(x - 0.5, static_cast<int>(80 * y) - 40);
  const Quaternion turned = Quaternion(x, y, z, x + y).normalized();
  const Vec3 turned_vector = turned * Vec3(wide, y, z);
  return {
      el::exp(20 * x - 10),
      el::expm1(x - y),
      el::exp10(wide),
      el::log(x),
      el::log1p(x - y),
      el::log2(y),
      el::log10(z),
      el::sin(1000 * wide),
      el::cos(1000 * wide),
      el::tan(x),
      el::asin(x - y),
      el::acos(y - z),
      el::atan(wide),
      el::atan2(x - y, y - z),
      el::cosh(3 * x),
      el::acosh(1 + y),
      el::atanh(x - y),
      el::cbrt(wide),
      el::erfc(3 * x),
      el::lgamma(1 + 9 * x),
      el::pow(x, 7 * y),
      el::hypot(x, y, z),
      std::sqrt(x),
      x * y + z,
      (x + y) * z - x / y,
      wide * y + wide * z,
      std::ldexp(x, -1060) * y,
      turned_vector.x(),
      turned_vector.y(),
      turned_vector.z(),
      turned_vector.dot(Vec3(x, y, z)),
      normal_at({.seed = 1, .purpose = purpose_of("arithmetic"), .which = std::bit_cast<std::uint64_t>(x)})};
}

}  // namespace

std::uint64_t arithmetic_digest() {
  constexpr std::uint64_t kPoints = 200;
  std::uint64_t digest = 0;
  for (std::uint64_t i = 0; i < kPoints; ++i) {
    const auto point = [i](std::uint32_t axis) {
      return uniform_at({.seed = 0, .purpose = purpose_of("arithmetic"), .who = axis, .which = i});
    };
    for (const double result : results_at<32>(point(0), point(1), point(2)))
      digest = identity_of({digest, std::bit_cast<std::uint64_t>(result)});
  }
  return digest;
}

}  // namespace halocline::bus
