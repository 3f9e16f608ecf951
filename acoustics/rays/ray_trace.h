// SPDX-License-Identifier: BSD-3-Clause
// Types common to the ray tracers and the eigenray searches: the state of one ray while it
// is traced, the sea it travels through, and the losses of its bounces.
//
// Thread rule: values; threads may call at the same time.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_section.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

// A sea whose bottom changes along the link. It refers to water and profile, which have to outlive the call.
struct ProfiledSea {
  const RayWater& water;
  const BottomProfile& profile;  // ranges from the source
  FluidBottom bottom;
  RaySurface surface;
  RayOptions options;
  double core_speed_mps = 0;  // rays that nowhere exceed it are left out: acoustics/rays/channel_core.h
  // Water that changes along the link and whose first column is `water`; it has to outlive the call. Null:
  // the water depends on depth alone.
  const RaySection* section = nullptr;
};

// The events of a ray in order, its bounce and turn sequence. Two rays with the same sequence belong to one
// smooth family.
enum class RayEvent : std::uint8_t { kSurface, kUpperTurn, kLowerTurn, kBottom };
struct EventCode {
  RayEvent event;
  std::uint16_t group;  // group of the facet at a bottom bounce; 0 for other events
  bool operator==(const EventCode&) const = default;
};

// State of the tracer of one ray.
struct RayTrace {
  double theta = 0;                // launch angle, rad, positive down
  bool arrived = false;            // false: too faint, turned back, or too many bounces
  double zeta = 0;                 // unfolded depth at the receiver's range, m
  double zeta_slope = 0;           // d zeta / d theta of plain ray theory, m/rad
  double z = 0, sine = 0, xi = 0;  // depth, sine of the angle and Snell's invariant at the receiver's range
  double q = 0, p = 0;             // the ray tube of acoustics/rays/arc_tracer.h
  double factor = 1;               // pressure factor of all bounces
  double scattered_nepers = 0;     // see BounceScattering
  int surface_bounces = 0, bottom_bounces = 0, upper_turns = 0, lower_turns = 0, caustics = 0;
  // the same for rays of the same events that turned in the same layers: eigenray.h
  std::uint64_t family = 0;
  std::vector<EventCode> events;

  // Starts a ray launched at `launch_theta`, without events or losses. The values at the receiver's range
  // keep their old contents until the ray arrives.
  void begin(double launch_theta);
};

// A point on a ray: horizontal range from the source and depth below the surface, m.
struct RayPoint {
  double range_m, depth_m;
};

// The eigenray of a ray as far as it is traced: delay, length, absorption, the phase of the bottom, and the
// losses and squared sines of the bounces.
struct TraceDetails : Eigenray {
  double slowness_over_range = 0;  // sum of xi dr, s
  // When not null, receives the course of the ray from just after the source to the receiver's range: the
  // ends of all arcs, and points on them that keep the straight line between points within kTrackErrorM of
  // the arc (at most 32 pieces per arc).
  std::vector<RayPoint>* track = nullptr;
  static constexpr double kTrackErrorM = 0.1;
};

// Rays that links with one common end share, instead of a search for each link. One for each row of links;
// not shared between threads.
class SharedRays {
 public:
  virtual ~SharedRays() = default;
  // The paths of a link, as profile_rays(). From call to call only the receiver and the options change; what
  // the sea of the first call refers to has to outlive this object.
  virtual std::vector<Eigenray> at(const ProfiledSea& sea, const RayLink& link) = 0;
};

// Events, counts, losses and phases of bounces.
class BounceLosses {
 public:
  // `deepest_speed_mps` is the sound speed of the water at the deepest bottom.
  BounceLosses(const ProfiledSea& sea, double deepest_speed_mps);

  // Records a bounce with the given sine of the grazing angle. Returns false when the ray stops there: it has
  // bounced too often, or its bounces leave less than a quarter of the least boundary factor, or no coherent
  // share. With `details`,
  // losses are exact.
  [[nodiscard]] bool at_surface(double sine, RayTrace& ray, TraceDetails* details) const;
  [[nodiscard]] bool at_bottom(const Facet& facet, double sine, double speed_mps, RayTrace& ray,
                               TraceDetails* details) const;

  // True when the options exclude a ray launched at `theta` after `bounces`.
  bool is_excluded(double theta, int bounces) const {
    return bounces > options_.max_bounces || (bounces > 0 && std::abs(theta) > options_.max_launch_angle_rad);
  }

 private:
  double rough_bottom_factor(double sine) const;
  bool goes_on(const RayTrace& ray) const;

  RayOptions options_;
  FluidBottom bottom_;
  SurfaceLoss surface_loss_;
  double min_factor_;
  // Reflection factors of the bottom at evenly spaced sines 0..1, accurate enough to recognise faint rays.
  std::vector<double> bottom_factor_;
};

}  // namespace halocline::acoustics
