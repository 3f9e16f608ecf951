// SPDX-License-Identifier: BSD-3-Clause
// Seas of the transport over angles, and what arrives between two depths of them.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "acoustics/scattering/angle_transport.h"
#include "acoustics/scattering/transport_end.h"
#include "acoustics/scattering/turned_sound.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/sound_speed_profile.h"

namespace halocline::testing {

// A sea over a level bottom of one absorption; rms 0.03 m and slope 0.2 at the bottom.
struct TransportSeaOf {
  std::vector<acoustics::SpeedRow> speeds;
  double depth_m = 0, frequency_hz = 0, wind_mps = 0;
  std::string sediment = "MediumSand";
  double absorption_db_per_km = 0;
  bool fine_structure = false;  // 0.05 m/s, and 0.5 m of internal waves
  bool under_ice = false;       // 0.2 m, slope 0.08, 0.8 + 10 sin dB a bounce

  acoustics::AngleTransport transport(std::size_t bins = 48) const {
    const acoustics::RayWater water(speeds, [this](double) { return absorption_db_per_km; });
    acoustics::TransportSea sea{
        water, depth_m, frequency_hz,
        acoustics::scattering_surface({acoustics::SurfaceModel::kAplBubbles, wind_mps}, frequency_hz),
        acoustics::rough_bottom(*acoustics::sediment(sediment), water.speed_at(depth_m), 0.03, 0.04)};
    if (under_ice)
      sea.surface = {0.2, 0.0064, [](double sine) { return std::pow(10, -(0.8 + 10 * sine) / 10); }};
    for (const double gradient : water.gradients_per_s())
      if (fine_structure) sea.speed_deviation_mps.push_back(std::sqrt(0.0025 + 0.25 * gradient * gradient));
    sea.bins = bins;
    return acoustics::AngleTransport(sea);
  }
};

inline double loss_db(double power) { return -10 * std::log10(power); }

// Power of all rays at their mean rates from 0 on, re 1 m.
inline double mean_rate_power(const acoustics::AngleTransport& transport,
                              const acoustics::TransportEnd& source, const acoustics::TransportEnd& receiver,
                              double range_m) {
  const std::vector<double> none(transport.size());
  const acoustics::CarriedMoments start = in_eigenvectors(transport, {receiver.reception(), none, none});
  const acoustics::CarriedMoments arrived = by_state(transport, carried(transport, start, range_m));
  double sum = 0;
  for (std::size_t j = 0; j < transport.size(); ++j) {
    double launched = source.never_bouncing()[j];
    for (const acoustics::FirstBounces& cell : source.first_bounces()) launched += cell.launched[j];
    sum += launched * arrived.power[j];
  }
  return sum * std::exp(transport.slowest() * range_m) / range_m;
}

// Transmission loss of what has bounced between two depths, dB.
inline double bounced_loss_db(const acoustics::AngleTransport& sea, double source_m, double receiver_m,
                              double range_m) {
  const acoustics::TransportEnd source(sea, source_m), receiver(sea, receiver_m);
  return loss_db(turned_sound(sea, source, receiver, range_m).power);
}

}  // namespace halocline::testing
