// SPDX-License-Identifier: BSD-3-Clause
// One ray that was traced, the sea it goes through, and what bounces do to it beside its direction and its
// tube: what the tracers and the searches share.
//
// Values: calls may overlap between threads.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "acoustics/rays/arrivals.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_section.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

// A sea whose bottom changes along the link. Refers to water and profile, which have to outlive the call.
struct ProfiledSea {
  const RayWater& water;
  const BottomProfile& profile;  // ranges from the source
  FluidBottom bottom;
  RaySurface surface;
  RayOptions options;
  double core_speed_mps = 0;  // rays that nowhere go faster are left out: acoustics/rays/channel_core.h
  // Water that changes along the link, whose first column is `water`; it has to outlive the call. Null: water
  // of depth alone.
  const RaySection* section = nullptr;
};

// What happened to a ray, in order; what makes two rays members of one smooth family.
enum class RayEvent : std::uint8_t { kSurface, kUpperTurn, kLowerTurn, kBottom };
struct EventCode {
  RayEvent event;
  std::uint16_t group;  // of the facet, at the bottom; 0 elsewhere
  bool operator==(const EventCode&) const = default;
};

struct TracedRay {
  double theta = 0;                // launch angle, rad, positive down
  bool arrived = false;            // false: too faint, turned back or too many bounces
  double zeta = 0;                 // unfolded depth at the receiver's range, m
  double zeta_slope = 0;           // d zeta / d theta of the rays as they are
  double z = 0, sine = 0, xi = 0;  // at the receiver's range
  double q = 0, p = 0;             // of the ray tube
  double factor = 1;               // of pressure, by the bounces
  int surface_bounces = 0, bottom_bounces = 0, upper_turns = 0, lower_turns = 0, caustics = 0;
  std::uint64_t family = 0;  // rays of the same events that turned in the same layers share it: arrivals.h
  std::vector<EventCode> events;

  // Launched at `launch_theta`, with nothing behind it; what lies at the receiver's range stays until it is
  // there.
  void begin(double launch_theta);
};

// A point on a ray's way, m: horizontal range from the source, depth below the surface.
struct RayPoint {
  double range_m, depth_m;
};

// Sums that an eigenray needs besides.
struct TracedDetails {
  double delay_s = 0, length_m = 0, absorption_db = 0, bottom_phase_rad = 0, bottom_loss_db = 0,
         surface_loss_db = 0, surface_sine_squares = 0, bottom_sine_squares = 0;
  double slowness_over_range = 0;  // sum of xi dr, s
  // Where not null, takes the ray's way from behind the source to the receiver's range: the ends of all arcs,
  // and points on them between which the straight line stays within kTrackErrorM of the arc (32 pieces of an
  // arc at most).
  std::vector<RayPoint>* track = nullptr;
  static constexpr double kTrackErrorM = 0.1;
};

// Rays that links from one end share, in the place of a search for each. One for each line of links; not
// shared between threads.
class SharedRays {
 public:
  virtual ~SharedRays() = default;
  // The paths of a link, as profile_rays(). From call to call only the receiver and the options change; what
  // the sea of the first refers to outlives this.
  virtual std::vector<Arrival> at(const ProfiledSea& sea, const RayLink& link) = 0;
};

// Events, counts, losses and phases of bounces.
class BounceLosses {
 public:
  // `deepest_speed_mps`: of the water at the deepest bottom.
  BounceLosses(const ProfiledSea& sea, double deepest_speed_mps);

  // Notes a bounce; false where the ray is given up: it has bounced too often, or its bounces leave less than
  // a quarter of the least factor. With `details` losses are exact. Sines of the grazing angle.
  [[nodiscard]] bool at_surface(double sine, TracedRay& ray, TracedDetails* details) const;
  [[nodiscard]] bool at_bottom(const Facet& facet, double sine, double speed_mps, TracedRay& ray,
                               TracedDetails* details) const;

  // Whether the options exclude a ray launched at `theta` after `bounces`.
  bool is_excluded(double theta, int bounces) const {
    return bounces > options_.max_bounces || (bounces > 0 && std::abs(theta) > options_.max_launch_angle_rad);
  }

 private:
  double rough_bottom_factor(double sine) const;

  RayOptions options_;
  FluidBottom bottom_;
  SurfaceLoss surface_loss_;
  double min_factor_;
  std::vector<double> bottom_factor_;  // at sines 0..1, evenly: enough to give up faint rays by
};

}  // namespace halocline::acoustics
