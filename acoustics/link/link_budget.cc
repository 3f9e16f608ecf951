// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/link_budget.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "acoustics/link/capacity.h"
#include "acoustics/link/transmission_loss.h"
#include "acoustics/math/depth_cells.h"
#include "acoustics/math/gauss_legendre.h"
#include "acoustics/sea/absorption.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr int kNodesPerPiece = 5;  // nodes of gauss_legendre_5
constexpr double kMetresPerKilometre = 1000;
constexpr double kNepersPerDecibel = std::numbers::ln10 / 10;  // nepers of power

double within_water(double depth_m) { return std::clamp(depth_m, 0.0, kDeepestWater); }

}  // namespace

double angle_down_rad(const Vec3& from_ned_m, const Vec3& to_ned_m) {
  const Vec3 way = to_ned_m - from_ned_m;
  return elementary::atan2(way.z(), elementary::hypot(way.x(), way.y()));
}

LinkTerms::LinkTerms(const Environment& environment, const Modem& transmitter, const Modem& receiver)
    : environment_(environment), transmitter_(transmitter), receiver_(receiver) {
  validate(environment);
  validate(transmitter);
  validate(receiver);
  const Band band = transmitter.band();
  density_ = to_power_ratio(transmitter.source_level + receiver.directivity_index).value / band.width_hz();
  centre_noise_ = noise_components(band.centre_hz(), environment.noise).total;
  noise_level_ = noise_level_over_band(band.low_hz, band.high_hz, environment.noise);
  gain_ = receiver.directivity_index - band_loss(transmitter, receiver);
  bandwidth_ = to_decibels(PowerRatio{transmitter.bandwidth_hz});
  of_one_kind_ = same_family(transmitter, receiver) && band_share(band, receiver.band()) > 0;
}

void LinkTerms::set_levels(LinkBudget& link, Decibels loss, Decibels above_ambient) const {
  // RL = SL - TL; SNR = RL - NL + DI (Urick 1983, sonar equation). The narrow-band ratio has
  //   NL = N(fc) + 10 log10 B  (equation 7 of the 2010 IEEE SMC paper).
  link.transmission_loss = loss;
  link.received_level = transmitter_.source_level - loss;
  link.noise_level = noise_level_ + above_ambient;
  link.noise_spectrum_level = centre_noise_ + above_ambient;
  link.snr = link.received_level - link.noise_level + gain_;
  link.snr_narrowband = link.received_level - link.noise_spectrum_level - bandwidth_ + gain_;
  link.receivable = of_one_kind_ && link.received_level >= receiver_.min_receivable_level;
}

Decibels LinkTerms::beam_loss(const Vec3& from_ned_m, const Vec3& to_ned_m) const {
  if (transmitter_.beam.rows().empty() && receiver_.beam.rows().empty()) return {0};
  const double down_rad = angle_down_rad(from_ned_m, to_ned_m);
  return transmitter_.beam.loss(down_rad) + receiver_.beam.loss(-down_rad);
}

double LinkTerms::unit_ratio(double frequency_hz) const {
  return density_ / noise_power_density(frequency_hz, environment_.noise).value;
}

Band LinkTerms::shared_band() const {
  const Band of = transmitter_.band(), in = receiver_.band();
  return {std::max(of.low_hz, in.low_hz), std::min(of.high_hz, in.high_hz)};
}

// Absorption at one depth of a path, and the share of the path that it represents.
struct LinkModel::Sample {
  AbsorptionSpectrum spectrum;
  double share;
};

// Quadrature of the absorption along a path:
//   mean alpha = sum of share * alpha(sample) + cells_share * (table[last] - table[first]).
struct LinkModel::Samples {
  std::array<Sample, 2 * kNodesPerPiece> of;
  int count = 0;
  std::size_t first_boundary = 0, last_boundary = 0;
  double cells_share = 0;

  void add_piece(const Environment& environment, double from_m, double to_m, double height_m) {
    const GaussLegendreRule& rule = gauss_legendre_5();
    const double middle = (from_m + to_m) / 2, half = (to_m - from_m) / 2;
    for (int i = 0; i < kNodesPerPiece; ++i) {
      const double depth = middle + half * rule.nodes[i];
      of[count++] = {absorption_spectrum_at(environment, depth), rule.weights[i] * half / height_m};
    }
  }
};

LinkModel::LinkModel(const Environment& environment, const Modem& transmitter, const Modem& receiver)
    : terms_(environment, transmitter, receiver) {
  const Band shared = terms_.shared_band();
  std::vector<FrequencyNode> nodes;
  if (shared.width_hz() > 0) nodes = frequency_nodes(shared.low_hz, shared.high_hz);
  nodes.insert(nodes.begin(), {transmitter.band().centre_hz(), 0});
  for (const FrequencyNode& node : nodes) {
    frequency_khz_squared_.push_back(hz_to_khz(node.frequency_hz) * hz_to_khz(node.frequency_hz));
    weight_hz_.push_back(node.weight_hz);
    unit_ratio_.push_back(terms_.unit_ratio(node.frequency_hz));
  }
  tabulate_absorption();
}

// Tabulates the running integral of alpha(z, f) dz from the surface to each boundary of the profile's cells,
// by Gauss-Legendre quadrature. Along a straight path
//   integral of alpha ds = L / (z2 - z1) * integral of alpha dz.
void LinkModel::tabulate_absorption() {
  const std::vector<double>& boundaries = terms_.environment().profile.cell_boundaries_m();
  const GaussLegendreRule& rule = gauss_legendre_5();
  std::vector<double> sum(frequency_khz_squared_.size(), 0);
  absorption_to_boundary_ = sum;
  for (std::size_t cell = 1; cell < boundaries.size(); ++cell) {
    const double half = (boundaries[cell] - boundaries[cell - 1]) / 2;
    for (int i = 0; i < kNodesPerPiece; ++i) {
      const double depth = boundaries[cell - 1] + half * (1 + rule.nodes[i]);
      const AbsorptionSpectrum spectrum = absorption_spectrum_at(terms_.environment(), depth);
      for (std::size_t f = 0; f < sum.size(); ++f) {
        sum[f] += rule.weights[i] * half * spectrum.db_per_km(frequency_khz_squared_[f]);
      }
    }
    absorption_to_boundary_.insert(absorption_to_boundary_.end(), sum.begin(), sum.end());
  }
}

LinkModel::Samples LinkModel::sample_path(double from_depth_m, double to_depth_m) const {
  const double z1 = within_water(std::min(from_depth_m, to_depth_m));
  const double z2 = within_water(std::max(from_depth_m, to_depth_m));
  Samples samples;
  if (z1 == z2) {
    samples.of[samples.count++] = {absorption_spectrum_at(terms_.environment(), z1), 1};
    return samples;
  }
  const DepthSpan span = split_span(terms_.environment().profile.cell_boundaries_m(), z1, z2);
  samples.add_piece(terms_.environment(), span.head_from_m, span.head_to_m, z2 - z1);
  if (!span.crosses) return samples;
  samples.add_piece(terms_.environment(), span.tail_from_m, span.tail_to_m, z2 - z1);
  samples.first_boundary = span.first_boundary;
  samples.last_boundary = span.last_boundary;
  samples.cells_share = 1 / (z2 - z1);
  return samples;
}

// Mean along the path at the frequency of that index, dB/km.
double LinkModel::mean_absorption(const Samples& samples, std::size_t frequency) const {
  double mean = 0;
  for (int i = 0; i < samples.count; ++i) {
    mean += samples.of[i].share * samples.of[i].spectrum.db_per_km(frequency_khz_squared_[frequency]);
  }
  const std::size_t frequencies = frequency_khz_squared_.size();
  return mean +
         samples.cells_share * (absorption_to_boundary_[samples.last_boundary * frequencies + frequency] -
                                absorption_to_boundary_[samples.first_boundary * frequencies + frequency]);
}

double LinkModel::capacity(const Samples& samples, double range_m, Decibels beams) const {
  // C = integral of log2(1 + DI (P / B) / (A N)) df, A = l^k e^(alpha l), times the loss of the beams.
  const bool lossless = range_m < kReferenceRange;
  const double spread = lossless ? 1 : elementary::pow(range_m, -terms_.environment().spreading_exponent);
  const double gain = spread * to_power_ratio(-beams).value;
  const double nepers_per_db_per_km = lossless ? 0 : kNepersPerDecibel * range_m / kMetresPerKilometre;
  double bits = 0;
  for (std::size_t f = 1; f < unit_ratio_.size(); ++f) {
    const double absorbed = elementary::exp(-nepers_per_db_per_km * mean_absorption(samples, f));
    bits += weight_hz_[f] * log2_of_1_plus(unit_ratio_[f] * gain * absorbed);
  }
  return bits;
}

// The loss at f is that at the centre plus (alpha(f) - alpha(centre)) l, l the length of the path.
double LinkModel::capacity_of_path(const Samples& samples, Decibels loss, double path_length_m) const {
  const double gain = to_power_ratio(Decibels{-loss.value}).value;
  const double nepers_per_db_per_km = kNepersPerDecibel * path_length_m / kMetresPerKilometre;
  const double at_centre = mean_absorption(samples, 0);
  double bits = 0;
  for (std::size_t f = 1; f < unit_ratio_.size(); ++f) {
    const double more = elementary::exp(-nepers_per_db_per_km * (mean_absorption(samples, f) - at_centre));
    bits += weight_hz_[f] * log2_of_1_plus(unit_ratio_[f] * gain * more);
  }
  return bits;
}

LinkBudget LinkModel::budget(const Vec3& from_ned_m, const Vec3& to_ned_m) const {
  const Environment& sea = terms_.environment();
  const double from_depth = depth_below_surface_m(from_ned_m, sea.sea_surface_z_m);
  const double to_depth = depth_below_surface_m(to_ned_m, sea.sea_surface_z_m);
  const Samples samples = sample_path(from_depth, to_depth);
  const double slowness = sea.profile.travel_time_s(from_depth, to_depth, 1);  // s/m

  LinkBudget link;
  link.range_m = (to_ned_m - from_ned_m).norm();
  link.delay_s = link.range_m * slowness;
  link.mean_sound_speed_mps = 1 / slowness;
  link.absorption_db_per_km = mean_absorption(samples, 0);
  const Decibels beams = terms_.beam_loss(from_ned_m, to_ned_m);
  const auto loss = transmission_loss(link.range_m, sea.spreading_exponent, link.absorption_db_per_km);
  terms_.set_levels(link, loss.total + beams);
  link.capacity_bps = capacity(samples, link.range_m, beams);
  return link;
}

LinkBudget LinkModel::budget_of_path(const Vec3& from_ned_m, const Vec3& to_ned_m, Decibels loss,
                                     double path_length_m) const {
  LinkBudget link = budget(from_ned_m, to_ned_m);
  const double surface_z_m = terms_.environment().sea_surface_z_m;
  const Samples samples = sample_path(depth_below_surface_m(from_ned_m, surface_z_m),
                                      depth_below_surface_m(to_ned_m, surface_z_m));
  terms_.set_levels(link, loss);
  link.capacity_bps = capacity_of_path(samples, loss, path_length_m);
  return link;
}

}  // namespace halocline::acoustics
