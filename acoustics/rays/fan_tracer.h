// SPDX-License-Identifier: BSD-3-Clause
// Traces the fan of rays among which a search brackets its eigenrays; it computes only the depth of arrival
// and its slope, and is fast.
//
// Model: that of acoustics/rays/arc_tracer.h, arc by arc, without step error. Whole layers between two bottom
// bounces come from a column (acoustics/rays/arcs/ray_column.h), and everything above the shallowest bottom
// is one excursion. zeta and d zeta/d theta are those of ArcTracer to rounding: 1e-7 m and 1e-7 of the slope
// over links of kilometres, more within a microradian of a ray that grazes. A ray stops when its losses,
// which are interpolated, exceed what a path may lose by 6 dB, or when scattering leaves no coherent share.
// For water that changes along the link, rays come from ArcTracer.
//
// The object keeps a column and the rays' events between calls: one per search, not shared between threads.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "acoustics/math/fold_field.h"
#include "acoustics/math/hermite_cubic.h"
#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/arcs/arc_steps.h"
#include "acoustics/rays/arcs/ray_column.h"
#include "acoustics/rays/ray_trace.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

// A ray of the fan: of the rays launched from the source at a row of angles.
struct FanRay {
  double theta = 0;       // launch angle, rad, positive down
  bool arrived = false;   // false: too faint, turned back or too many bounces
  double zeta = 0;        // unfolded depth at the receiver's range, m
  double zeta_slope = 0;  // d zeta / d theta, m/rad
  double slowness = 0;    // sin / c at the receiver's range, s/m
  double loss_db = 0;     // loss of all bounces
  // The events of the ray as kept by the tracer: index of the first, and number.
  std::size_t first_event = 0, events = 0;
};

// The unfolded depth between two rays as a cubic in the launch angle.
inline HermiteCubic cubic_of(const FanRay& a, const FanRay& b) {
  return {a.zeta, a.zeta_slope, b.zeta, b.zeta_slope, b.theta - a.theta};
}
// Mean of |d2 zeta / d theta2| between two rays.
inline double bend_between(const FanRay& a, const FanRay& b) {
  return std::abs((b.zeta_slope - a.zeta_slope) / (b.theta - a.theta));
}

// The fold between two rays, as if the interval contained a single one.
inline Fold fold_between(const FanRay& a, const FanRay& b) {
  const double width = b.theta - a.theta;
  return {(b.zeta_slope - a.zeta_slope) / width, (b.slowness - a.slowness) / width};
}
// The fold at a ray between two others, by linear interpolation of its two derivatives.
inline Fold fold_at(const FanRay& a, const FanRay& middle, const FanRay& b) {
  const Fold before = fold_between(a, middle), after = fold_between(middle, b);
  const double t = (middle.theta - a.theta) / (b.theta - a.theta);
  return {before.curvature + t * (after.curvature - before.curvature),
          before.slowness_slope + t * (after.slowness_slope - before.slowness_slope)};
}

class FanTracer {
 public:
  // Refers to the tracer, which has to outlive this object.
  explicit FanTracer(const ArcTracer& exact);

  static constexpr std::size_t kAllEvents = std::numeric_limits<std::size_t>::max();
  // Traces the ray launched at `theta` to the receiver's range, or until it has `enough_events` events; in
  // the latter case it has not arrived.
  FanRay trace(double theta, std::size_t enough_events = kAllEvents);
  // The events of a ray of this tracer, in order.
  std::span<const EventCode> events_of(const FanRay& ray) const {
    return std::span(events_).subspan(ray.first_event, ray.events);
  }
  // Number of events stored so far; forget_since() drops those of the rays traced since then.
  std::size_t kept_events() const { return events_.size(); }
  void forget_since(std::size_t kept_events) { events_.resize(kept_events); }

 private:
  struct State;
  FanRay trace_through_section(double theta);
  State start(double theta) const;
  void trace_from(State& s, std::size_t enough_events, FanRay& ray);
  void go(State& s, double dr, double z, double sine) const;
  void go_part(State& s, double dr);
  [[nodiscard]] bool go_to_bottom(State& s, ArcHit hit);
  [[nodiscard]] bool bounce(State& s, const Facet& facet) const;
  [[nodiscard]] bool go_to_knot(State& s, const ArcStep& step);
  // Moves from a knot through whole layers to the last knot before the ray turns, meets the bottom or
  // arrives.
  [[nodiscard]] bool run_through_layers(State& s, std::size_t knot);
  // Sets the state to the knot on the ray's way up or down.
  void stand_at_knot(State& s, std::size_t knot, bool down) const;
  // True when the ray crosses the layer beside `knot` from end to end. Near the bottom this moves the state
  // to that knot.
  bool next_layer_is_whole(State& s, std::size_t knot, bool down) const;
  bool clears_bottom(double sine, double next_sine) const;
  [[nodiscard]] bool meet_surface(State& s, double sine);
  bool goes_on(State& s) const;
  void note_turn(bool lower);
  bool is_near_bottom(std::size_t layer) const { return water_.depths_m()[layer + 1] > shallowest_; }

  const ArcTracer& exact_;
  const RayWater& water_;
  const BottomProfile& profile_;
  RayColumn column_;
  RayTrace traced_;                // scratch buffer for rays through a section
  std::vector<EventCode> events_;  // events of all rays
  // `steepest_rise_` is the sine of the steepest slope at which the bottom rises.
  double range_, shallowest_, max_loss_db_, steepest_rise_;
  BounceScattering scattering_;
  std::vector<double> bottom_loss_db_;  // at evenly spaced sines 0..1
  // Loss times sine, which is smooth even where bubbles give a loss proportional to 1 / sine.
  std::vector<double> surface_loss_db_;
};

}  // namespace halocline::acoustics
