// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/channel_core.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kFirstStep = 1e-6;  // m/s: first step of the search for c*
constexpr int kHalvings = 40;        // bisections of the search

// The loop of a ray of greatest speed c* in a channel; not bounded when it meets surface or bottom.
struct Swing {
  bool bounded = false;
  double loop_s = 0;  // J / omega
  double height_m = 0;
};

// Integral of sqrt(1/c^2 - 1/c*^2) dz over a height along which s^2 = 1 - (c/c*)^2 changes linearly from s1^2
// to s2^2, as it does for |c* - c| << c:
//   (2 h / 3 c) (s1^2 + s1 s2 + s2^2) / (s1 + s2)
double half_loop_s(double height_m, double speed, double s1, double s2) {
  const double sum = s1 + s2;
  return sum > 0 ? 2 * height_m / (3 * speed) * (s1 * s1 + s1 * s2 + s2 * s2) / sum : 0;
}

// Accumulates the loop of a ray layer by layer.
class SwingSum {
 public:
  SwingSum(const RayWater& water, double greatest_speed) : water_(water), greatest_(greatest_speed) {}

  // s = sqrt(1 - (c / c*)^2).
  double sine_at(double speed) const {
    return std::sqrt(std::max((greatest_ - speed) * (greatest_ + speed), 0.0)) / greatest_;
  }
  void add(double height_m, double c1, double c2) {
    swing_.height_m += height_m;
    swing_.loop_s += 2 * half_loop_s(height_m, c1, sine_at(c1), sine_at(c2));
  }
  // Adds the part from `z` to the turning point above or below; false when the ray meets `end_m` first.
  bool add_to_turn(double z, double end_m, bool down) {
    const auto& knots = water_.depths_m();
    double c = water_.speed_at(z);
    std::size_t layer = water_.layer_at(z);
    if (!down && z == knots[layer] && layer > 0) --layer;
    while (c < greatest_) {
      if (z == end_m) return false;
      const double next_z = down ? std::min(knots[layer + 1], end_m) : std::max(knots[layer], end_m);
      const double height = std::abs(next_z - z);
      const double next_c = c + (down ? 1 : -1) * water_.gradients_per_s()[layer] * height;
      if (next_c >= greatest_) {
        add(height * (greatest_ - c) / (next_c - c), c, greatest_);
        return true;
      }
      add(height, c, next_c);
      z = next_z;
      c = next_c;
      layer = down ? layer + 1 : layer - 1;
    }
    return true;
  }
  Swing bounded() const { return {true, swing_.loop_s, swing_.height_m}; }

 private:
  const RayWater& water_;
  double greatest_;
  Swing swing_;
};

// The loop of the ray of greatest speed `greatest` around both ends.
Swing swing_of(const RayWater& water, double bottom_m, double upper_m, double lower_m, double greatest) {
  SwingSum sum(water, greatest);
  const auto& knots = water.depths_m();
  double z = upper_m, c = water.speed_at(upper_m);
  for (std::size_t knot = water.layer_at(upper_m) + 1; z < lower_m; ++knot) {
    const double next_z = std::min(knots[knot], lower_m), next_c = water.speed_at(next_z);
    sum.add(next_z - z, c, next_c);
    z = next_z;
    c = next_c;
  }
  if (!sum.add_to_turn(upper_m, 0, /*down=*/false) || !sum.add_to_turn(lower_m, bottom_m, /*down=*/true))
    return {};
  return sum.bounded();
}

// Greatest sound speed between two depths, m/s.
double greatest_between(const RayWater& water, double upper_m, double lower_m) {
  double greatest = std::max(water.speed_at(upper_m), water.speed_at(lower_m));
  for (std::size_t knot = water.layer_at(upper_m) + 1; water.depths_m()[knot] < lower_m; ++knot)
    greatest = std::max(greatest, water.speeds_mps()[knot]);
  return greatest;
}

}  // namespace

std::optional<ChannelCore> channel_core(const RayWater& water, double bottom_m, const RayLink& link,
                                        double frequency_hz) {
  const double upper = std::min(link.source_depth_m, link.receiver_depth_m);
  const double lower = std::max(link.source_depth_m, link.receiver_depth_m);
  const double omega = 2 * pi * frequency_hz;
  const auto at = [&](double speed) { return swing_of(water, bottom_m, upper, lower, speed); };
  const auto is_core = [&](const Swing& swing) { return swing.bounded && omega * swing.loop_s < pi; };
  if (lower >= bottom_m) return std::nullopt;
  double inside = greatest_between(water, upper, lower), step = kFirstStep;
  if (!is_core(at(inside)) || !is_core(at(inside + step))) return std::nullopt;
  while (is_core(at(inside + step))) {
    inside += step;
    step *= 2;
  }
  double outside = inside + step;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (inside + outside);
    (is_core(at(middle)) ? inside : outside) = middle;
  }
  const Swing widest = at(inside);
  // J = omega loop_s, so kappa = 4 J c0 / (pi omega H^2) = 4 loop_s c0 / (pi H^2).
  return ChannelCore{inside, 4 * widest.loop_s * inside / (pi * widest.height_m * widest.height_m)};
}

// A straight ray of length L at the mean speed of both ends, with the tube of the parabolic channel:
//   A^2 = 1 / (L q),  q = |sin(kappa L)| / kappa, with |sin| at least 1/2 beyond a quarter of a loop
Eigenray axial_ray(const RayWater& water, const ChannelCore& core, const RayLink& link) {
  const double down = link.receiver_depth_m - link.source_depth_m;
  const double length = elementary::hypot(link.range_m, down);
  const double source_mps = water.speed_at(link.source_depth_m),
               receiver_mps = water.speed_at(link.receiver_depth_m);
  const double turned = core.kappa_per_m * length;
  const double least = turned > pi / 2 ? 0.5 : 0;
  const double tube = std::max(std::abs(elementary::sin(turned)), least) / core.kappa_per_m;
  Eigenray path;
  path.delay_s = 2 * length / (source_mps + receiver_mps);
  path.amplitude = 1 / std::sqrt(length * tube);
  path.caustics = static_cast<int>(turned / pi);
  path.phase_rad = std::fmod(path.caustics * pi / 2, 2 * pi);
  path.launch_angle_rad = path.arrival_angle_rad = elementary::atan2(down, link.range_m);
  path.launch_slowness_spm = elementary::cos(path.launch_angle_rad) / source_mps;
  path.range_slowness_spm = path.launch_slowness_spm;
  path.path_length_m = length;
  path.absorption_db = length * water.absorption_db_per_m((link.source_depth_m + link.receiver_depth_m) / 2);
  path.identity.launched_up = down < 0;
  return path;
}

}  // namespace halocline::acoustics
