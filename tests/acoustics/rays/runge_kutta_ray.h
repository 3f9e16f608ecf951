// SPDX-License-Identifier: BSD-3-Clause
// Rays through water that changes with range and depth, integrated step by step: an independent reference for
// tests.
//
// The equations of a ray along its length s (Jensen and others 2011, section 3.2): dr/ds = cos, dz/ds = sin,
// dtau/ds = 1/c, d angle / ds = (dc/dr sin - dc/dz cos) / c, by Runge and Kutta's scheme of fourth order. A
// step that leaves the piece of water in which it began, where c is one smooth function, ends where it leaves
// it, as bisection finds; so do steps at the surface and at a straight bottom, which mirror the direction.
// The ray tube is the difference of two rays. Shares no formula with the tracers.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/search/eigenray_search.h"

namespace halocline::acoustics {

struct SpeedThere {
  double c, along, down;  // m/s; its derivatives, 1/s
};

// Water in pieces: which of them holds a place, and the speed by its function, wherever it is asked.
struct PiecewiseWater {
  std::function<int(double r, double z)> piece;
  std::function<SpeedThere(int piece, double r, double z)> speed;
};

struct StraightBottom {
  double depth_m, slope;  // at range 0
  double at(double r) const { return depth_m + slope * r; }
};

struct RungeKuttaRay {
  bool arrived = false;
  double z = 0, angle = 0, tau = 0, length = 0, c = 0;  // at the range
  int surface = 0, bottom = 0;
  double bottom_magnitude = 1;
  std::vector<double> depths;     // at the stations
  std::vector<int> bounces_then;  // so far
};

class RungeKuttaTracer {
 public:
  // `grazing_magnitude`: of a reflection at the bottom, by the sine of the grazing angle and the speed above.
  RungeKuttaTracer(PiecewiseWater water, StraightBottom bottom,
                   std::function<double(double sine, double speed)> grazing_magnitude, double step_m)
      : water_(std::move(water)), bottom_(bottom), magnitude_(std::move(grazing_magnitude)), step_(step_m) {}

  // Stations lie `station_m` apart; 0: none.
  RungeKuttaRay trace(double source_m, double range_m, double angle, double station_m = 0) const;

 private:
  struct State {
    double r, z, angle, tau;
  };
  State derivative(int piece, const State& s) const;
  State after(int piece, const State& s, double h) const;

  PiecewiseWater water_;
  StraightBottom bottom_;
  std::function<double(double, double)> magnitude_;
  double step_;
};

// How far a path is off the ray of the same bounces that comes to the receiver.
struct Compared {
  double delay_s = 0, decibels = 0;
  bool caustics_alike = true;
  double launch_angle_rad = 0;  // of that ray
  double fold_delay_s = 0;      // between the two rays of its fold, if it were alone; huge far from caustics
};

// The launch angle of the ray that comes to the receiver, sought from the path's own on; empty where there is
// none.
std::optional<double> launch_of(const RungeKuttaTracer& tracer, const RayLink& link, const Eigenray& path);
// Levels without absorption. Empty where there is no such ray.
std::optional<Compared> compare(const RungeKuttaTracer& tracer, const RayLink& link, const Eigenray& path);

// A front: cold above and on the far side, c = 1485 + 18 e^(-z / 45) + 12 W(r - tilt z) e^(-z / 120), W from
// 1 to 0 about the range `front_m` within some `width_m`.
SpeedThere front_speed(double front_m, double width_m, double r, double z);

}  // namespace halocline::acoustics
