// SPDX-License-Identifier: BSD-3-Clause
// The three legs of which every ray between two depths of a stratified waveguide with a flat bottom is made.
//
// Model: water depends on depth alone, so a ray keeps Snell's invariant xi = cos(angle) / c. Split at both
// ends, its path consists of U (upper end up to the upper turning point or the surface), S (upper to lower
// end) and D (lower end down to the lower turning point or the bottom): with n whole cycles, 2 (n + u) U + (2
// n + 1) S + 2 (n + d) D, where u and d are 0 or 1 and give the direction in which the ray leaves and
// arrives. Range and its derivative of each leg are sums over layers of the closed forms of
// acoustics/math/arc_math.h.
//
// Rays are addressed by their angle at a reference depth whose speed c* is the greatest that they have passed
// (a "barrier"): 1 - xi^2 c^2 = ((c* - c)(c* + c) + c^2 sin^2) / c*^2 then keeps its precision down to
// grazing.
//
// With a frequency, range and phase of rays that turn close to a knot or boundary are those of
// acoustics/math/turning_field.h: they change smoothly where a leg becomes longer by a layer, or begins to be
// reflected.
#pragma once

#include <array>
#include <vector>

#include "acoustics/math/turning_field.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

enum class Leg { kUp, kBetween, kDown };

// r / xi and dr / dxi of each leg once, in the order of Leg; sines where U and D end at a boundary (0 at a
// turn).
struct LegSums {
  double xi = 0;
  std::array<double, 3> q{}, m{};
  double sine_top = 0, sine_bottom = 0;
};

// The other sums over each leg once, needed for eigenrays alone.
struct LegDetails {
  std::array<double, 3> intercept_s{};  // travel time - xi r
  std::array<double, 3> length_m{};
  std::array<double, 3> absorption_db{};
};

// Where rays all but graze a boundary, what each touch of a leg at it is to waves.
struct BoundaryTouch {
  double phase_rad =
      0;  // of one leg, beside half of that of a ray: pi / 2 where it turns, pi where it is reflected
  double turned_rad = 0;  // the same, beside a ray that turns
  // In place of 1 / sine of the grazing angle, by which sound stays in a layer at the boundary; 0: that of
  // the ray.
  double inverse_sine = 0;
};

class LayeredLegs {
 public:
  // Depths 0 <= upper_m <= lower_m <= bottom_m. Frequency 0: rays alone.
  LayeredLegs(const RayWater& water, double upper_m, double lower_m, double bottom_m, double frequency_hz);

  // Rays that pass the barrier just, and those up to the next one: [0, theta_end] at speed barrier_mps().
  // Starts with the steepest speed between the ends, which all rays that reach both have to pass.
  double barrier_mps() const { return barrier_; }
  // The speed at which rays meet the next barrier, m/s; 0 when surface and bottom are all that is left.
  double next_barrier_mps() const;
  // Moves on to it; false when there is none.
  [[nodiscard]] bool advance();
  // Whether ranges change smoothly over the barrier last advanced to.
  bool is_smooth() const { return smooth_; }

  bool meets_surface() const { return up_reach_ == up_.size(); }
  bool meets_bottom() const { return down_reach_ == down_.size(); }

  // Whether a ray that is all but horizontal at that end of the link, on its way up or down, turns back at
  // once.
  bool turns_at_once(Leg leg) const {
    return leg == Leg::kUp ? up_reach_ == 0 && !up_.empty() : down_reach_ == 0 && !down_.empty();
  }

  // Of the ray of sine and cosine `sine`, `cosine` at the barrier.
  LegSums sums(double sine, double cosine) const;
  LegDetails details(double sine, double cosine) const;
  // Of U at the surface, of D at the bottom.
  BoundaryTouch touch(Leg leg, double sine) const;
  // Sine of the angle at a speed that the ray reaches.
  double sine_at(double speed_mps, double sine) const;

 private:
  // One layer, or the piece of one, in the direction away from the start of its leg.
  struct LegLayer {
    double height_m, c1, c2, gradient;  // gradient (c2 - c1) / height
    double hc;                          // height (c1 + c2)
    LayerAbsorption absorption;
    // At its far end: the change of 1 / gradient there, s; 0 where rays are left as they are. s0 of
    // turning_field.h.
    double knot_s = 0, turning_sine = 0;
    // Of the last one: x of the end of the link, from the boundary, and what rays are there.
    bool is_last = false;
    double end_x = 0;
    TurningShare at_end{};
  };
  static void append(std::vector<LegLayer>& layers, const RayWater& water, double from_m, double to_m);
  static void mark_knots(std::vector<LegLayer>& layers, double frequency_hz);
  void pass_what_is_slower();
  // A knot near which a ray turns, by the square of its sine there; 1 / sine of a ray that has passed it,
  // else 0.
  struct NearKnot {
    const LegLayer& layer;
    TurningShare share;
    double square, inverse_sine;
  };
  // Calls visit(NearKnot) for each.
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
