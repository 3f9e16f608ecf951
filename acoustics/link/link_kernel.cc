// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/link_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "acoustics/link/capacity.h"
#include "acoustics/link/transmission_loss.h"
#include "acoustics/math/frequency_band.h"
#include "acoustics/math/gauss_legendre.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kMetresPerKilometre = 1000;
constexpr double kNepersPerDecibel = std::numbers::ln10 / 10;  // nepers of power
constexpr std::array kRules = {8, 16, 24, 32};  // numbers of nodes over a band, multiples of the vector width
constexpr double kAgreement = 2e-12;            // relative to the capacity, or to 1 bit/s
constexpr double kFarthestTrial = 1e7;          // m

// Squared frequencies, weights and unit ratios of the given frequencies.
BandNodes nodes_at(const LinkTerms& terms, const std::vector<FrequencyNode>& frequencies) {
  BandNodes nodes;
  for (const FrequencyNode& node : frequencies) {
    nodes.khz_squared.push_back(hz_to_khz(node.frequency_hz) * hz_to_khz(node.frequency_hz));
    nodes.weight_hz.push_back(node.weight_hz);
    nodes.unit_ratio.push_back(terms.unit_ratio(node.frequency_hz));
  }
  return nodes;
}

// Capacity in homogeneous water.
double uniform_capacity_bps(const BandNodes& nodes, const AbsorptionSpectrum& water, double exponent,
                            double range_m) {
  double bits = 0;
  for (std::size_t i = 0; i < nodes.weight_hz.size(); ++i) {
    const double loss_db =
        transmission_loss(range_m, exponent, water.db_per_km(nodes.khz_squared[i])).total.value;
    bits +=
        nodes.weight_hz[i] * log2_of_1_plus(nodes.unit_ratio[i] * to_power_ratio(Decibels{-loss_db}).value);
  }
  return bits;
}

// True when both sets of nodes give the same capacity at the surface, at half of the profile's rows and at
// its end, for ranges from 1 m until less than 1 bit/s passes.
bool agree(const BandNodes& coarse, const BandNodes& fine, const Environment& environment) {
  const std::vector<double>& depths_m = environment.profile.cell_boundaries_m();
  for (const double depth_m : {depths_m.front(), depths_m[depths_m.size() / 2], depths_m.back()}) {
    const AbsorptionSpectrum water = absorption_spectrum_at(environment, depth_m);
    const auto capacity = [&](const BandNodes& nodes, double range_m) {
      return uniform_capacity_bps(nodes, water, environment.spreading_exponent, range_m);
    };
    double bits = std::numeric_limits<double>::infinity();
    for (double range_m = 1; bits >= 1 && range_m < kFarthestTrial; range_m *= 2) {
      bits = capacity(fine, range_m);
      if (std::abs(capacity(coarse, range_m) - bits) > kAgreement * std::max(bits, 1.0)) return false;
    }
  }
  return true;
}

// The smallest Gauss-Legendre rule that agrees with the rule of twice as many nodes; otherwise panels over
// the band.
BandNodes choose_nodes(const LinkTerms& terms) {
  const Band band = terms.shared_band();
  if (!(band.width_hz() > 0)) return {};
  const auto in_one_panel = [&](int count) {
    constexpr double kNoPanels = std::numeric_limits<double>::infinity();
    return nodes_at(terms, frequency_nodes(band.low_hz, band.high_hz, kNoPanels, make_gauss_legendre(count)));
  };
  for (const int count : kRules) {
    BandNodes nodes = in_one_panel(count);
    if (agree(nodes, in_one_panel(2 * count), terms.environment())) return nodes;
  }
  return nodes_at(terms, frequency_nodes(band.low_hz, band.high_hz));
}

// Depth means of slowness, s/m, and of absorption at the centre frequency, dB/km.
DepthMeans centre_means(const LinkTerms& terms) {
  const Environment& sea = terms.environment();
  const double centre_khz = hz_to_khz(terms.transmitter().band().centre_hz());
  return {sea.profile.cell_boundaries_m(), 2, [&](double depth_m, std::span<double> values) {
            values[0] = 1 / sea.profile.sound_speed_mps(depth_m);
            values[1] = absorption_spectrum_at(sea, depth_m).db_per_km(centre_khz * centre_khz);
          }};
}

// Depth means of the absorption at each node, dB/km.
DepthMeans band_means(const Environment& sea, const BandNodes& nodes) {
  return {sea.profile.cell_boundaries_m(), nodes.khz_squared.size(),
          [&](double depth_m, std::span<double> values) {
            const AbsorptionSpectrum water = absorption_spectrum_at(sea, depth_m);
            std::transform(nodes.khz_squared.begin(), nodes.khz_squared.end(), values.begin(),
                           [&](double khz_squared) { return water.db_per_km(khz_squared); });
          }};
}

}  // namespace

LinkKernel::LinkKernel(const Environment& environment, const Modem& transmitter, const Modem& receiver,
                       VectorInstructions instructions)
    : terms_(environment, transmitter, receiver),
      nodes_(choose_nodes(terms_)),
      centre_(centre_means(terms_)),
      band_(band_means(terms_.environment(), nodes_)),
      band_capacity_(acoustics::band_capacity(instructions)) {}

LinkKernel::Leg LinkKernel::leg_between(double from_depth_m, double to_depth_m) const {
  const auto [upper_m, lower_m] = std::minmax(from_depth_m, to_depth_m);
  return {centre_.place(std::clamp(upper_m, 0.0, kDeepestWater)),
          centre_.place(std::clamp(lower_m, 0.0, kDeepestWater))};
}

LinkKernel::Leg LinkKernel::leg_between(const Vec3& from_ned_m, const Vec3& to_ned_m) const {
  const double surface_z_m = environment().sea_surface_z_m;
  return leg_between(depth_below_surface_m(from_ned_m, surface_z_m),
                     depth_below_surface_m(to_ned_m, surface_z_m));
}

// C = integral of log2(1 + DI (P / B) / (A N)) df, A the frequency-independent loss times absorption over the
// path.
double LinkKernel::capacity_bps(const Leg& leg, double loss_db, double path_length_m) const {
  return band_capacity_(nodes_, {&band_, leg.upper, leg.lower, kNepersPerDecibel * loss_db,
                                 kNepersPerDecibel * path_length_m / kMetresPerKilometre});
}

LinkBudget LinkKernel::budget_of_leg(const Leg& leg, const Vec3& from_ned_m, const Vec3& to_ned_m) const {
  LinkBudget link;
  const double slowness = slowness_s_per_m(leg);
  link.range_m = (to_ned_m - from_ned_m).norm();
  link.delay_s = link.range_m * slowness;
  link.mean_sound_speed_mps = 1 / slowness;
  link.absorption_db_per_km = absorption_db_per_km(leg);
  return link;
}

LinkBudget LinkKernel::budget(const Vec3& from_ned_m, const Vec3& to_ned_m, Capacity capacity,
                              Decibels above_ambient) const {
  const Leg leg = leg_between(from_ned_m, to_ned_m);
  LinkBudget link = budget_of_leg(leg, from_ned_m, to_ned_m);
  const Decibels beams = terms_.beam_loss(from_ned_m, to_ned_m);
  const TransmissionLoss loss =
      transmission_loss(link.range_m, environment().spreading_exponent, link.absorption_db_per_km);
  terms_.set_levels(link, loss.total + beams, above_ambient);
  if (capacity == Capacity::kComputed) {
    const double absorbing_m = link.range_m < kReferenceRange ? 0 : link.range_m;
    link.capacity_bps = capacity_bps(leg, (loss.spreading + beams + above_ambient).value, absorbing_m);
  }
  return link;
}

LinkBudget LinkKernel::budget_of_path(const Vec3& from_ned_m, const Vec3& to_ned_m, Decibels loss,
                                      double path_length_m, Capacity capacity, Decibels above_ambient) const {
  const Leg leg = leg_between(from_ned_m, to_ned_m);
  LinkBudget link = budget_of_leg(leg, from_ned_m, to_ned_m);
  terms_.set_levels(link, loss, above_ambient);
  if (capacity == Capacity::kComputed) {
    // The loss at f is that at the centre plus (alpha(f) - alpha(centre)) l.
    const double absorbed_db = link.absorption_db_per_km * path_length_m / kMetresPerKilometre;
    link.capacity_bps = capacity_bps(leg, (loss + above_ambient).value - absorbed_db, path_length_m);
  }
  return link;
}

double LinkKernel::absorption_db_per_km(double from_depth_m, double to_depth_m) const {
  return absorption_db_per_km(leg_between(from_depth_m, to_depth_m));
}

LinkBudget link_budget(const Environment& environment, const Modem& transmitter, const Modem& receiver,
                       const Vec3& from_ned_m, const Vec3& to_ned_m) {
  return LinkKernel(environment, transmitter, receiver).budget(from_ned_m, to_ned_m, Capacity::kComputed);
}

}  // namespace halocline::acoustics
