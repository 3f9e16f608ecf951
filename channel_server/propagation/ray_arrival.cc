// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/ray_arrival.h"

#include <algorithm>
#include <cmath>

#include "acoustics/fading/path_fading.h"
#include "acoustics/link/ray_doppler.h"
#include "acoustics/link/received_field.h"
#include "acoustics/modem/beam_pattern.h"
#include "acoustics/sea/ice_cover.h"
#include "acoustics/sea/surface/surface_boundary.h"
#include "core/elementary.h"

namespace halocline::channel_server {
namespace {

bool turns(const RoughBoundaries& boundaries) { return boundaries.fading.enabled && boundaries.fading.turns; }

// Pressure of turned sound with both beams: it leaves and arrives upwards and downwards alike.
double turned_pressure(const acoustics::Eigenray& window, const acoustics::BeamPattern& from,
                       const acoustics::BeamPattern& to) {
  const auto mean_power = [](const acoustics::BeamPattern& beam, double angle) {
    const double down = beam.factor(angle), up = beam.factor(-angle);
    return 0.5 * (down * down + up * up);
  };
  return window.received_pressure() *
         std::sqrt(mean_power(from, window.launch_angle_rad) * mean_power(to, window.arrival_angle_rad));
}

// Doppler spread of turned sound by the motion of the ends, v / c f sin(angle) of each, Hz rms.
double spread_by_motion(const acoustics::Environment& environment, const EndPair& ends,
                        const acoustics::Eigenray& window) {
  const auto one = [&](const LinkEnd& end, double angle) {
    const double along = end.velocity_ned_mps.norm() / sound_speed_at(environment, end.position_ned_m);
    return along * ends.from.modem->centre_frequency_hz * elementary::sin(angle);
  };
  return elementary::hypot(one(ends.from, window.launch_angle_rad), one(ends.to, window.arrival_angle_rad));
}

// The share of its power that a traced path keeps: of several bounces, what is coherent.
double coherent_share_of(const RoughBoundaries& boundaries, const acoustics::Environment& environment,
                         double frequency_hz, const acoustics::Eigenray& path) {
  if (path.surface_bounces + path.bottom_bounces < 2) return 1;
  const double surface_m =
      surface_boundary(environment.noise.wind_mps, environment.ice, frequency_hz).rms_height_m;
  return coherent_share(boundaries.fading, surface_m, frequency_hz, path.surface_sine_squares,
                        path.bottom_sine_squares);
}

}  // namespace

acoustics::Eigenray backwards(acoustics::Eigenray path) {
  const double launch = path.launch_angle_rad;
  path.launch_angle_rad = -path.arrival_angle_rad;
  path.arrival_angle_rad = -launch;
  return path;
}

std::optional<Arrival> arrival_of(const RoughBoundaries& boundaries,
                                  const acoustics::Environment& environment, const EndPair& ends,
                                  const acoustics::Eigenray& eigenray, bool reversed) {
  const auto& [from, to] = ends;
  Arrival arrival{reversed ? backwards(eigenray) : eigenray};
  const bool is_window = arrival.diffuse && turns(boundaries);
  const double pressure = is_window ? turned_pressure(arrival, from.modem->beam, to.modem->beam)
                                    : weighted_pressure(arrival, {from.modem->beam, to.modem->beam});
  if (!(pressure > 0)) return std::nullopt;  // absorbed beyond the range of a double
  const double frequency_hz = from.modem->centre_frequency_hz;
  const double kept =
      is_window || !turns(boundaries) ? 1 : coherent_share_of(boundaries, environment, frequency_hz, arrival);
  if (!(kept > 0)) return std::nullopt;
  const acoustics::MovingEnds moving{from.position_ned_m,
                                     from.velocity_ned_mps,
                                     to.position_ned_m,
                                     to.velocity_ned_mps,
                                     sound_speed_at(environment, from.position_ned_m),
                                     sound_speed_at(environment, to.position_ned_m)};
  const Decibels level = from.modem->source_level + Decibels{20 * elementary::log10(pressure)};
  arrival.level = std::max(level + to_decibels(PowerRatio{kept}), kSilence);
  arrival.doppler_factor = doppler_factor(arrival, moving);
  const double speed_mps = std::max(from.velocity_ned_mps.norm(), to.velocity_ned_mps.norm());
  arrival.fading = path_fading_below(
      boundaries.fading, surface_boundary(environment.noise.wind_mps, environment.ice, frequency_hz),
      frequency_hz, arrival.surface_sine_squares, arrival.bottom_sine_squares, kept, speed_mps);
  // Many paths of random phase add to complex Gaussian noise.
  if (arrival.diffuse && boundaries.fading.enabled)
    arrival.fading = {.coherent = 0, .scattered = 1, .doppler_spread_hz = arrival.fading.doppler_spread_hz};
  if (is_window)
    arrival.fading.doppler_spread_hz =
        elementary::hypot(arrival.fading.doppler_spread_hz, spread_by_motion(environment, ends, arrival));
  return arrival;
}

SurfacePassage::SurfacePassage(const SurfaceEnds& surface, const acoustics::Environment& environment,
                               const EndPair& ends, double frequency_hz)
    : surface_(acoustics::near_surface(environment.noise.wind_mps, frequency_hz)),
      waves_radps_(surface_.waves.mean_frequency_radps) {
  const auto shift = [&](const LinkEnd& end) {
    return surface.heave_mps(end.id, end.position_ned_m.z(), environment) * frequency_hz /
           sound_speed_at(environment, end.position_ned_m);
  };
  from_shift_ = shift(ends.from);
  to_shift_ = shift(ends.to);
}

acoustics::SurfaceCrossing SurfacePassage::cross(const acoustics::RayWater& water,
                                                 const acoustics::RayLink& link,
                                                 acoustics::Eigenray& path) const {
  const acoustics::SurfaceCrossing crossing = crossing_of(surface_, water, link, path);
  take_bubbles(crossing, path);
  return crossing;
}

void SurfacePassage::set_waves(const acoustics::SurfaceCrossing& crossing, Arrival& arrival) const {
  if (crossing.clear_share < 1) {
    arrival.level = std::max(arrival.level + to_decibels(PowerRatio{crossing.clear_share}), kSilence);
    arrival.fading = behind_crests(arrival.fading, crossing.clear_share, waves_radps_);
  }
  if (from_shift_ == 0 && to_shift_ == 0) return;
  const double from_hz = from_shift_ * elementary::sin(arrival.launch_angle_rad);
  const double to_hz = to_shift_ * elementary::sin(arrival.arrival_angle_rad);
  arrival.fading.doppler_spread_hz = elementary::hypot(arrival.fading.doppler_spread_hz, from_hz, to_hz);
}

Decibels keel_loss(const acoustics::Environment& environment, double depth_m, double range_m) {
  return Decibels{keel_loss_db_per_km(environment.ice, depth_m) * range_m / 1000};
}

// Over a bottom that does not scatter, the remaining share is the surface's.
Decibels kept_at_surface(const RoughBoundaries& boundaries, const acoustics::Environment& environment,
                         double frequency_hz, const acoustics::Eigenray& eigenray) {
  if (!turns(boundaries)) return Decibels{0};
  acoustics::Eigenray surface_alone = eigenray;
  surface_alone.bottom_sine_squares = 0;
  const double kept = coherent_share_of(boundaries, environment, frequency_hz, surface_alone);
  return std::max(to_decibels(PowerRatio{kept}), kSilence);
}

}  // namespace halocline::channel_server
