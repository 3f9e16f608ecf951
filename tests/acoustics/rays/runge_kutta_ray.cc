// SPDX-License-Identifier: BSD-3-Clause
#include "tests/acoustics/rays/runge_kutta_ray.h"

#include <algorithm>
#include <cmath>

namespace halocline::acoustics {

RungeKuttaTracer::State RungeKuttaTracer::derivative(int piece, const State& s) const {
  const SpeedThere speed = water_.speed(piece, s.r, s.z);
  const double sine = std::sin(s.angle), cosine = std::cos(s.angle);
  return {cosine, sine, (speed.along * sine - speed.down * cosine) / speed.c, 1 / speed.c};
}

RungeKuttaTracer::State RungeKuttaTracer::after(int piece, const State& s, double h) const {
  const auto moved = [&s](const State& d, double by) {
    return State{s.r + by * d.r, s.z + by * d.z, s.angle + by * d.angle, s.tau + by * d.tau};
  };
  const State k1 = derivative(piece, s), k2 = derivative(piece, moved(k1, h / 2)),
              k3 = derivative(piece, moved(k2, h / 2)), k4 = derivative(piece, moved(k3, h));
  const auto sum = [](double a, double b, double c, double d) { return (a + 2 * b + 2 * c + d) / 6; };
  return moved({sum(k1.r, k2.r, k3.r, k4.r), sum(k1.z, k2.z, k3.z, k4.z),
                sum(k1.angle, k2.angle, k3.angle, k4.angle), sum(k1.tau, k2.tau, k3.tau, k4.tau)},
               h);
}

RungeKuttaRay RungeKuttaTracer::trace(double source_m, double range_m, double angle, double station_m) const {
  constexpr double kAhead = 1e-7;  // m: where the piece ahead is looked up
  RungeKuttaRay ray;
  State s{0, source_m, angle, 0};
  double next_station = station_m > 0 ? station_m : 2 * range_m;
  while (s.r < range_m) {
    const int piece = water_.piece(s.r + kAhead * std::cos(s.angle), s.z + kAhead * std::sin(s.angle));
    const double until = std::min(range_m, next_station);
    // Beyond a boundary, the range or the piece: 0 inside.
    const auto beyond = [&](const State& at) {
      if (at.r > until || at.z < 0 || at.z > bottom_.at(at.r)) return true;
      return water_.piece(at.r, at.z) != piece;
    };
    State end = after(piece, s, step_);
    double h = step_;
    if (beyond(end)) {
      double low = 0, high = step_;
      while (high - low > 1e-11) {
        const double middle = 0.5 * (low + high);
        (beyond(after(piece, s, middle)) ? high : low) = middle;
      }
      h = high;
      end = after(piece, s, h);
    }
    s = end;
    ray.length += h;
    if (std::cos(s.angle) < 1e-2) return ray;
    const auto mirror = [&s](double slope_angle) { s.angle = 2 * slope_angle - s.angle; };
    if (s.z <= 0 && s.angle < 0) {
      mirror(0);
      ++ray.surface;
    } else if (s.z >= bottom_.at(s.r) && s.angle > std::atan(bottom_.slope)) {
      const double slope_angle = std::atan(bottom_.slope);
      ray.bottom_magnitude *= magnitude_(std::sin(s.angle - slope_angle), water_.speed(piece, s.r, s.z).c);
      mirror(slope_angle);
      ++ray.bottom;
    }
    if (s.r >= next_station) {
      ray.depths.push_back(s.z);
      ray.bounces_then.push_back(ray.surface + ray.bottom);
      next_station += station_m;
    }
    if (s.r >= range_m) {
      ray.arrived = true;
      ray.z = s.z;
      ray.angle = s.angle;
      ray.tau = s.tau;
      ray.c = water_.speed(piece, s.r, s.z).c;
    }
  }
  return ray;
}

std::optional<double> launch_of(const RungeKuttaTracer& tracer, const RayLink& link, const Eigenray& path) {
  double angle = path.launch_angle_rad;
  for (int i = 0; i < 12; ++i) {
    constexpr double kStep = 1e-6;
    const RungeKuttaRay ray = tracer.trace(link.source_depth_m, link.range_m, angle),
                        beside = tracer.trace(link.source_depth_m, link.range_m, angle + kStep);
    if (!ray.arrived || !beside.arrived) return std::nullopt;
    const double off = ray.z - link.receiver_depth_m;
    if (std::abs(off) < 1e-7) return angle;
    angle -= off * kStep / (beside.z - ray.z);
  }
  return std::nullopt;
}

namespace {

// Caustics are where two neighbouring rays cross.
int caustics_between(const RungeKuttaRay& a, const RungeKuttaRay& b) {
  int caustics = 0;
  double before = 0;
  for (std::size_t i = 0; i < std::min(a.depths.size(), b.depths.size()); ++i) {
    if (a.bounces_then[i] != b.bounces_then[i]) continue;
    const double apart = (b.depths[i] - a.depths[i]) * (a.bounces_then[i] % 2 == 0 ? 1 : -1);
    if (before * apart < 0) ++caustics;
    before = apart;
  }
  return caustics;
}

// Near a fold the depth at the receiver is z_c + z'' u^2 / 2, u the launch angle off the caustic's: the other
// ray has -u, with u = z' / z''. Along z delays differ by (sin a(u) - sin a(-u)) / c = 2 u p, p the
// derivative of sin a / c, so together by integral of 2 u p dz = 2/3 p z'' u^3.
double fold_delay_s(const RungeKuttaRay& low, const RungeKuttaRay& ray, const RungeKuttaRay& high,
                    double apart) {
  if (low.surface != high.surface || low.bottom != high.bottom) return 1e9;  // a reflection between them
  const double first = (high.z - low.z) / (2 * apart),
               second = (high.z - 2 * ray.z + low.z) / (apart * apart);
  const double p = (std::sin(high.angle) / high.c - std::sin(low.angle) / low.c) / (2 * apart);
  return std::min(2.0 / 3 * std::abs(p * std::pow(first, 3)) / std::max(second * second, 1e-300), 1e9);
}

}  // namespace

std::optional<Compared> compare(const RungeKuttaTracer& tracer, const RayLink& link, const Eigenray& path) {
  constexpr double kApart = 2e-6, kStation = 40, kFold = 2e-5;
  const auto angle = launch_of(tracer, link, path);
  if (!angle) return std::nullopt;
  const auto traced = [&](double at) {
    return tracer.trace(link.source_depth_m, link.range_m, at, kStation);
  };
  const RungeKuttaRay ray = traced(*angle), low = traced(*angle - kApart / 2),
                      high = traced(*angle + kApart / 2);
  if (ray.surface != path.surface_bounces || ray.bottom != path.bottom_bounces) return std::nullopt;
  const double tube = std::abs(high.z - low.z) / kApart * std::cos(ray.angle);
  const RungeKuttaRay start = tracer.trace(link.source_depth_m, 1e-3, *angle);
  const double amplitude =
      ray.bottom_magnitude * std::sqrt(ray.c * std::cos(*angle) / (start.c * link.range_m * tube));
  return Compared{std::abs(path.delay_s - ray.tau), std::abs(20 * std::log10(path.amplitude / amplitude)),
                  caustics_between(low, high) == path.caustics, *angle,
                  fold_delay_s(traced(*angle - kFold), ray, traced(*angle + kFold), kFold)};
}

SpeedThere front_speed(double front_m, double width_m, double r, double z) {
  constexpr double kTilt = 4;  // m of range a metre of depth
  const double x = (r - front_m - kTilt * z) / width_m, t = std::tanh(x), warm = 0.5 * (1 - t);
  const double slope = -0.5 * (1 - t * t) / width_m;  // of `warm` along range
  const double mixed = std::exp(-z / 45), deep = std::exp(-z / 120);
  return {1485 + 18 * mixed + 12 * warm * deep, 12 * slope * deep,
          -18 / 45.0 * mixed - 12 / 120.0 * warm * deep - 12 * kTilt * slope * deep};
}

}  // namespace halocline::acoustics
