// SPDX-License-Identifier: BSD-3-Clause
// The three legs of which every ray between two depths of a stratified waveguide with a flat bottom consists.
//
// Model: the sound speed depends on depth alone, so a ray keeps Snell's invariant xi = cos(angle) / c. The
// two ends of the link split its path into pieces of three kinds:
// - U, from the upper end up to the upper turning point or the surface;
// - S, from the upper to the lower end;
// - D, from the lower end down to the lower turning point or the bottom.
//
// A ray with n whole cycles consists of
//   2 (n + u) U + (2 n + 1) S + 2 (n + d) D,
// where u and d, 0 or 1, give the directions in which it leaves and arrives. Range and its derivative are,
// for each leg, sums over the layers of the closed forms of acoustics/math/arc_math.h.
//
// A ray is addressed by its angle at a reference depth, the "barrier": the depth of the greatest speed c*
// that it has passed. The sine at any other depth,
//   sin^2 = 1 - xi^2 c^2 = ((c* - c)(c* + c) + c^2 sin*^2) / c*^2,
// then keeps its precision down to grazing.
//
// When a frequency is given, range and phase of rays that turn close to a knot or a boundary are those of
// acoustics/math/turning_field.h. They change smoothly where a leg grows by a layer or where its reflection
// begins.
#pragma once

#include <array>
#include <vector>

#include "acoustics/math/turning_field.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

enum class Leg { kUp, kBetween, kDown };

// Sums over each leg, in the order of Leg: q = r / xi, m^2/s, and m = dr/dxi, m^2/s; and the sines of the
// angle where U and D end at a boundary (0 when the ray turns).
struct LegSums {
  double xi = 0;
  std::array<double, 3> q{}, m{};
  double sine_top = 0, sine_bottom = 0;
};

// Further sums over each leg, needed for eigenrays only.
struct LegDetails {
  std::array<double, 3> intercept_s{};  // travel time less xi r, s
  std::array<double, 3> length_m{};
  std::array<double, 3> absorption_db{};
};

// Corrections to one touch of a boundary (a reflection at it or a turn just before it) by a ray that nearly
// grazes it.
struct BoundaryTouch {
  // Phase of one leg at the touch, rad, in excess of that of the plain ray, which is half of pi / 2 for a
  // turn and half of pi for a reflection.
  double phase_rad = 0;
  double turned_rad = 0;  // phase of one leg at the touch in excess of that of a turning ray
  // Replaces 1 / sine of the grazing angle in the time that sound stays in a layer at the boundary; 0: the
  // ray's own sine holds.
  double inverse_sine = 0;
};

class LayeredLegs {
 public:
  // Depths in metres, 0 <= upper_m <= lower_m <= bottom_m. Frequency 0 selects plain ray theory.
  LayeredLegs(const RayWater& water, double upper_m, double lower_m, double bottom_m, double frequency_hz);

  // Speed at the current barrier, m/s. The rays of a barrier are those that just pass it and all steeper ones
  // up to the next barrier: angles [0, theta_end] at this speed. The first barrier is the greatest speed
  // between the ends, which every ray that reaches both has to pass.
  double barrier_mps() const { return barrier_; }
  // Speed at which rays meet the next barrier, m/s; 0 when only the surface and the bottom remain.
  double next_barrier_mps() const;
  // Moves on to the next barrier; false when there is none.
  [[nodiscard]] bool advance();
  // True when ranges change smoothly across the barrier that was reached last.
  bool is_smooth() const { return smooth_; }

  bool meets_surface() const { return up_reach_ == up_.size(); }
  bool meets_bottom() const { return down_reach_ == down_.size(); }

  // True when a nearly horizontal ray that leaves that end of the link (upwards for kUp, downwards for kDown)
  // turns back at once.
  bool turns_at_once(Leg leg) const {
    return leg == Leg::kUp ? up_reach_ == 0 && !up_.empty() : down_reach_ == 0 && !down_.empty();
  }

  // Sums of the ray whose angle at the barrier has this sine and cosine.
  LegSums sums(double sine, double cosine) const;
  LegDetails details(double sine, double cosine) const;
  // Correction to a touch: of the surface for Leg::kUp, of the bottom for Leg::kDown.
  BoundaryTouch touch(Leg leg, double sine) const;
  // Sine of the ray's angle at the depth of a speed that it reaches.
  double sine_at(double speed_mps, double sine) const;

 private:
  // A layer, or a part of one, in the direction away from the start of its leg.
  struct LegLayer {
    double height_m, c1, c2, gradient;  // (c2 - c1) / height, 1/s
    double hc;                          // height (c1 + c2), m^2/s
    LayerAbsorption absorption;
    // Change of 1 / gradient at the far end, s (0: plain ray theory there), and s0 of turning_field.h.
    double knot_s = 0, turning_sine = 0;
    // Last layer only: x of turning_field.h of the end of the link, as seen from the boundary, and the
    // correction there.
    bool is_last = false;
    double end_x = 0;
    TurningShare at_end{};
  };
  static void append(std::vector<LegLayer>& layers, const RayWater& water, double from_m, double to_m);
  static void mark_knots(std::vector<LegLayer>& layers, double frequency_hz);
  void pass_what_is_slower();
  // A knot near which a ray turns, with the square of the ray's sine there; 1 / sine when the ray has passed
  // the knot, else 0.
  struct NearKnot {
    const LegLayer& layer;
    TurningShare share;
    double square, inverse_sine;
  };
  // Calls visit(NearKnot) for each such knot.
  template <class Visit>
  void visit_knots(const std::vector<LegLayer>& layers, std::size_t reach, double squared_sine,
                   Visit visit) const;
  void add_sums(const std::vector<LegLayer>& layers, std::size_t reach, double squared_sine, Leg leg,
                LegSums& sums, double& end_sine) const;
  void add_details(const std::vector<LegLayer>& layers, std::size_t reach, double squared_sine, double xi,
                   Leg leg, LegDetails& details) const;
  static void add_layer(const LegLayer& layer, double s1, double s2, double xi, std::size_t leg,
                        LegDetails& details);

  std::vector<LegLayer> up_, between_, down_;
  double barrier_ = 0, inverse_barrier_squared_ = 0;
  std::size_t up_reach_ = 0, down_reach_ = 0;  // layers crossed from end to end
  bool smooth_ = true;
};

}  // namespace halocline::acoustics
