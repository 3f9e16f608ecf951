// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/scattering/angle_transport.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "acoustics/math/symmetric_eigenproblem.h"
#include "acoustics/scattering/facet_kernel.h"
#include "acoustics/sea/surface/surface_boundary.h"
#include "core/check.h"
#include "core/elementary.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

constexpr double kSteepest = to_radians(88), kLinear = 0.03;  // edges of the bins
constexpr double kWaveSpeedMps = 1500;                        // of k in Gamma, as in Eckart's loss
constexpr double kMaxSurfaceLossDb = 15;                      // of a bounce, our choice
constexpr double kLeastKept = 1e-12;
constexpr double kMinSine = 1e-6;                       // at a boundary, below which a ray does not meet it
constexpr double kBlobHeightM = 5, kBlobLengthM = 500;  // L_v and L_h of fine structure

double sine_of(double xi, double speed) {
  const double cosine = xi * speed;
  return cosine < 1 ? std::sqrt((1 - cosine) * (1 + cosine)) : 0;
}

// Part of a layer that a ray crosses from the sine s1 to s2: range, length and time. Across the whole of a
// layer, and up to a turning point,
//   dr = h xi (c1 + c2) / (s1 + s2),  dr = s / (xi |g|).
struct Crossing {
  double range_m = 0, length_m = 0, time_s = 0;
};
Crossing crossing_of(double xi, double height, double c1, double c2, double s1, double s2) {
  if (s1 > 0 && s2 > 0) {
    const double range = height * xi * (c1 + c2) / (s1 + s2), mean = 0.5 * (c1 + c2);
    return {range, range / (xi * mean), range / (xi * mean * mean)};
  }
  const double s = std::max(s1, s2), c = s1 > 0 ? c1 : c2, gradient = std::abs(c2 - c1) / height;
  const double range = s / (xi * gradient), mean = 0.5 * (c + 1 / xi);
  return {range, range / (xi * mean), range / (xi * mean * mean)};
}

// Edges of the bins. Rays below the angle `held` miss the surface or the bottom and carry far what they hold:
// they have at least a third of the bins.
std::vector<double> edges_of(std::size_t bins, double held) {
  constexpr double kHeldAtAll = 1e-4;  // rad
  constexpr std::size_t kHeldShare = 3;
  const auto natural = [](double u) { return kSteepest * (kLinear * u + (1 - kLinear) * u * u); };
  const double count = static_cast<double>(bins);
  std::vector<double> edges;
  for (std::size_t i = 0; i <= bins; ++i) edges.push_back(natural(static_cast<double>(i) / count));
  const std::size_t low = bins / kHeldShare;
  if (held < kHeldAtAll || edges[low] <= held) return edges;
  // Even bins up to `held`, then widths that grow evenly from theirs.
  const double first = held / static_cast<double>(low), above = count - static_cast<double>(low);
  for (std::size_t i = 0; i <= bins; ++i) {
    const double place = static_cast<double>(i) - static_cast<double>(low), u = place / above;
    edges[i] = place <= 0 ? first * static_cast<double>(i)
                          : held + first * place + (kSteepest - held - first * above) * u * u;
  }
  return edges;
}

// Symmetric part of the kernel of a boundary (FacetKernel::part): its facets turn the scattered share, relief
// turns all of it. Empty for a smooth boundary.
std::vector<double> scattering_of(FacetBins bins, const RoughBoundary& boundary) {
  std::vector<double> part;
  if (bins.angle_rad.empty()) return part;
  if (boundary.slope_variance > 0 && boundary.rms_height_m > 0)
    part = facet_kernel(bins, boundary.slope_variance + boundary.relief_variance).part;
  if (!(boundary.relief_variance > 0)) return part;
  for (double& share : bins.scattered) share = 1 - share;
  const std::vector<double> relief = facet_kernel(bins, boundary.relief_variance).part;
  if (part.empty()) return relief;
  for (std::size_t i = 0; i < part.size(); ++i) part[i] += relief[i];
  return part;
}

}  // namespace

RoughBoundary scattering_surface(const RaySurface& surface, double frequency_hz) {
  const SurfaceBoundary boundary = surface_boundary(surface.wind_mps, surface.ice, frequency_hz);
  const SurfaceLoss loss(surface, frequency_hz);
  return {boundary.rms_height_m, boundary.slope_variance, [loss](double sine) {
            return elementary::exp10(-std::min(loss.db_at_sine(sine), kMaxSurfaceLossDb) / 10);
          }};
}

RoughBoundary rough_bottom(const FluidBottom& bottom, double speed_mps, double rms_height_m,
                           double slope_variance) {
  return {rms_height_m, slope_variance, [bottom, speed_mps](double sine) {
            const double magnitude = bottom_magnitude_at_sine(bottom, sine, speed_mps);
            return magnitude * magnitude;
          }};
}

// Rates per metre in the symmetric coordinates P_i / sqrt(measure_i).
struct AngleTransport::Rates {
  std::vector<double> exchange;  // n x n: the rate from i to j times sqrt(measure_i / measure_j)
  std::vector<double> loss;
};

AngleTransport::AngleTransport(const TransportSea& sea) : depth_m_(sea.depth_m) {
  require(sea.depth_m > 0 && sea.frequency_hz > 0 && sea.bins > 1,
          "a transport over angles needs a depth, a frequency and two bins");
  set_layers(sea);
  set_edges(sea.bins);
  for (std::size_t bin = 0; bin < sea.bins; ++bin) add_states(sea, bin);
  const auto earlier = [](const TransportState& a, const TransportState& b) {
    return a.excess_spm < b.excess_spm;
  };
  reference_ = std::min_element(states_.begin(), states_.end(), earlier)->excess_spm;
  for (TransportState& state : states_) {
    state.excess_spm -= reference_;
    roots_.push_back(std::sqrt(state.measure()));
  }
  Rates rates{std::vector<double>(size() * size()), {}};
  for (const TransportState& state : states_) rates.loss.push_back(state.nepers_per_m);
  add_boundary(sea, Boundary::kSurface, rates);
  add_boundary(sea, Boundary::kBottom, rates);
  if (!sea.speed_deviation_mps.empty()) add_fine_structure(sea, rates);
  solve(rates);
}

void AngleTransport::set_layers(const TransportSea& sea) {
  const std::vector<double>& depths = sea.water.depths_m();
  for (std::size_t i = 0; i < depths.size() && depths[i] < depth_m_; ++i) {
    depths_.push_back(depths[i]);
    speeds_.push_back(sea.water.speeds_mps()[i]);
  }
  depths_.push_back(depth_m_);
  speeds_.push_back(sea.water.speed_at(depth_m_));
  least_speed_ = *std::min_element(speeds_.begin(), speeds_.end());
}

double AngleTransport::speed_at(double depth_m) const {
  const auto below = std::upper_bound(depths_.begin() + 1, depths_.end() - 1, depth_m);
  const auto i = static_cast<std::size_t>(below - depths_.begin());
  const double share = (depth_m - depths_[i - 1]) / (depths_[i] - depths_[i - 1]);
  return speeds_[i - 1] + std::clamp(share, 0.0, 1.0) * (speeds_[i] - speeds_[i - 1]);
}

void AngleTransport::set_edges(std::size_t bins) {
  of_bin_.resize(bins);
  const double held = elementary::acos(least_speed_ / std::max(speeds_.front(), speeds_.back()));
  edges_ = edges_of(bins, held);
  for (std::size_t i = 0; i < speeds_.size(); ++i) {
    const bool first = i == 0, last = i + 1 == speeds_.size();
    const bool barrier = !first && !last && speeds_[i] > speeds_[i - 1] && speeds_[i] > speeds_[i + 1];
    if (first || last || barrier) move_edge_to(elementary::acos(least_speed_ / speeds_[i]));
  }
  for (std::size_t i = 0; i <= bins; ++i) {
    edge_xi_.push_back(elementary::cos(edges_[i]) / least_speed_);
    double action = 0;
    for (std::size_t layer = 0; layer + 1 < depths_.size(); ++layer) {
      const double c1 = speeds_[layer], c2 = speeds_[layer + 1];
      const double s1 = sine_of(edge_xi_[i], c1), s2 = sine_of(edge_xi_[i], c2);
      action += (depths_[layer + 1] - depths_[layer]) * 0.5 * (s1 / c1 + s2 / c2);
    }
    actions_.push_back(action);
  }
}

// Moves the nearest inner edge to a ray that just meets a boundary or passes a barrier, so that no bin holds
// both kinds of rays.
void AngleTransport::move_edge_to(double theta) {
  const auto above = std::lower_bound(edges_.begin() + 1, edges_.end() - 1, theta);
  auto nearest = above;
  if (above - 1 > edges_.begin() && (above + 1 == edges_.end() || theta - *(above - 1) < *above - theta))
    nearest = above - 1;
  constexpr double kLeastBin = 1e-5;  // rad
  if (nearest + 1 == edges_.end()) return;
  if (theta > *(nearest - 1) + kLeastBin && theta < *(nearest + 1) - kLeastBin) *nearest = theta;
}

// Follows the rays of the bin's middle down through the water; a layer that they cannot enter divides ducts.
void AngleTransport::add_states(const TransportSea& sea, std::size_t bin) {
  const double theta = 0.5 * (edges_[bin] + edges_[bin + 1]), xi = elementary::cos(theta) / least_speed_;
  // cos(a) - cos(b) = 2 sin((a + b) / 2) sin((b - a) / 2)
  const double width =
      2 * elementary::sin(theta) * elementary::sin(0.5 * (edges_[bin + 1] - edges_[bin])) / least_speed_;
  TransportState state;
  double time = 0, absorbed = 0;
  bool open = false;
  const auto close = [&](double depth_m) {
    state.lower_m = depth_m;
    state.excess_spm = time / state.cycle_m;
    state.nepers_per_m = absorbed / state.cycle_m;
    of_bin_[bin].push_back(states_.size());
    states_.push_back(state);
    open = false;
  };
  for (std::size_t layer = 0; layer + 1 < depths_.size(); ++layer) {
    const double c1 = speeds_[layer], c2 = speeds_[layer + 1], height = depths_[layer + 1] - depths_[layer];
    const double s1 = sine_of(xi, c1), s2 = sine_of(xi, c2);
    if (!(s1 > 0 || s2 > 0)) continue;
    const double turn_m = c1 == c2 ? 0 : depths_[layer] + height * (1 / xi - c1) / (c2 - c1);
    if (!open) {
      state = {.bin = bin, .xi_spm = xi, .width_spm = width, .upper_m = s1 > 0 ? depths_[layer] : turn_m};
      if (layer == 0 && s1 > kMinSine) state.surface_sine = s1;
      time = absorbed = 0;
      open = true;
    }
    const Crossing one = crossing_of(xi, height, c1, c2, s1, s2);
    state.cycle_m += 2 * one.range_m;
    time += 2 * one.time_s;
    absorbed += 2 * one.length_m * std::numbers::ln10 / 10 *
                sea.water.absorption_db_per_m(depths_[layer] + 0.5 * height, layer);
    if (!(s2 > 0)) close(turn_m);
  }
  if (!open) return;
  const double sine = sine_of(xi, speeds_.back());
  if (sine > kMinSine) state.bottom_sine = sine;
  close(depth_m_);
}

std::size_t AngleTransport::state_at(std::size_t bin, double depth_m) const {
  std::size_t nearest = of_bin_[bin].front();
  double least = depth_m_ * 2;
  for (const std::size_t i : of_bin_[bin]) {
    const double off = std::max({states_[i].upper_m - depth_m, depth_m - states_[i].lower_m, 0.0});
    if (off < least) {
      least = off;
      nearest = i;
    }
  }
  return nearest;
}

std::size_t AngleTransport::meeting(Boundary boundary, std::size_t i) const {
  const auto meets = [&](std::size_t j) {
    return (boundary == Boundary::kSurface ? states_[j].surface_sine : states_[j].bottom_sine) > 0;
  };
  if (meets(i)) return i;
  for (std::size_t j = i + 1; j < size(); ++j) {
    if (states_[j].bin > states_[i].bin && meets(j)) return j;
  }
  return size();
}

void AngleTransport::add_boundary(const TransportSea& sea, Boundary which, Rates& rates) {
  const bool up = which == Boundary::kSurface;
  const RoughBoundary& boundary = up ? sea.surface : sea.bottom;
  const double speed = up ? speeds_.front() : speeds_.back();
  const double k = 2 * std::numbers::pi * sea.frequency_hz / kWaveSpeedMps;
  const std::size_t n = size();
  std::vector<double>& bounce = bounce_[static_cast<std::size_t>(which)];
  bounce.assign(n * n, 0);
  std::vector<std::size_t> hit;
  std::vector<double> sines, kept;
  FacetBins bins;
  for (std::size_t i = 0; i < n; ++i) {
    const double sine = up ? states_[i].surface_sine : states_[i].bottom_sine;
    if (!(sine > 0)) continue;
    const double gamma = boundary.slope_variance > 0 ? 2 * k * boundary.rms_height_m * sine : 0;
    hit.push_back(i);
    sines.push_back(sine);
    kept.push_back(boundary.kept ? std::clamp(boundary.kept(sine), kLeastKept, 1.0) : 1);
    bins.angle_rad.push_back(elementary::asin(sine));
    bins.width_rad.push_back(speed * states_[i].width_spm / sine);
    bins.scattered.push_back(-elementary::expm1(-gamma * gamma));
  }
  const std::vector<double> part = scattering_of(bins, boundary);
  for (std::size_t a = 0; a < hit.size(); ++a) {
    const std::size_t i = hit[a];
    const double per_m = 1 / states_[i].cycle_m;
    double scattered = 0;
    for (std::size_t b = 0; !part.empty() && b < hit.size(); ++b) {
      const std::size_t j = hit[b];
      const double share = part[a * hit.size() + b] * bins.width_rad[b] / sines[a];
      scattered += share;
      bounce[i * n + j] = share * std::sqrt(kept[a] * kept[b]);
      // rate_i K_ij sqrt(measure_i / measure_j), in a form that is symmetric to the last bit.
      rates.exchange[i * n + j] += part[a * hit.size() + b] * (bins.width_rad[a] * bins.width_rad[b]) /
                                   (speed * (roots_[i] * roots_[j]));
    }
    const double stays = std::max(1 - scattered, 0.0);  // the coherent share, and rounding of the balance
    bounce[i * n + i] += stays * kept[a];
    rates.exchange[i * n + i] += per_m * stays;
    rates.loss[i] += per_m * (1 - elementary::log(kept[a]));
  }
}

// Mean of mu over a cycle. In a layer of constant gradient g the sine changes by xi g per metre, so that
//   integral of dr / sqrt(sin^2 + q^2) = |asinh(s1 / q) - asinh(s2 / q)| / (xi |g|),  q = L_v / L_h.
double AngleTransport::turning_rate(const TransportSea& sea, const TransportState& state) const {
  constexpr double q = kBlobHeightM / kBlobLengthM, kLevel = 1e-6;
  const auto area_sine = [](double x) { return elementary::log(x + std::sqrt(x * x + 1)); };
  double sum = 0;
  for (std::size_t layer = 0; layer + 1 < depths_.size(); ++layer) {
    if (depths_[layer] >= state.lower_m || depths_[layer + 1] <= state.upper_m) continue;
    const double c1 = speeds_[layer], c2 = speeds_[layer + 1], height = depths_[layer + 1] - depths_[layer];
    const double s1 = sine_of(state.xi_spm, c1), s2 = sine_of(state.xi_spm, c2);
    if (!(s1 > 0 || s2 > 0)) continue;
    const double deviation = sea.speed_deviation_mps[layer] / kWaveSpeedMps;
    const double free = std::sqrt(std::numbers::pi) * deviation * deviation / kBlobHeightM;
    const double middle = 0.5 * (s1 + s2);
    sum +=
        free *
        (std::abs(s1 - s2) < kLevel
             ? crossing_of(state.xi_spm, height, c1, c2, s1, s2).range_m / std::sqrt(middle * middle + q * q)
             : std::abs(area_sine(s1 / q) - area_sine(s2 / q)) * height / (state.xi_spm * std::abs(c2 - c1)));
  }
  return 2 * sum / state.cycle_m;
}

void AngleTransport::add_fine_structure(const TransportSea& sea, Rates& rates) const {
  require(sea.speed_deviation_mps.size() >= depths_.size() - 1,
          "fine structure needs a deviation of sound speed for each layer of the water");
  const std::size_t n = size();
  std::vector<double> mu;
  for (const TransportState& state : states_) mu.push_back(turning_rate(sea, state));
  const auto exchange = [&](std::size_t i, std::size_t j, double cycle_m) {
    const double sine = elementary::sin(edges_[states_[j].bin]) / least_speed_;
    const double flow = 0.5 * (0.5 * (mu[i] + mu[j])) * sine * sine * cycle_m /
                        std::abs(states_[j].xi_spm - states_[i].xi_spm);
    rates.exchange[i * n + j] += flow / (roots_[i] * roots_[j]);
    rates.exchange[j * n + i] += flow / (roots_[i] * roots_[j]);
    rates.loss[i] += flow / states_[i].measure();
    rates.loss[j] += flow / states_[j].measure();
  };
  for (std::size_t bin = 0; bin + 1 < of_bin_.size(); ++bin) {
    const auto &flat = of_bin_[bin], &steep = of_bin_[bin + 1];
    for (const std::size_t i : flat) {
      for (const std::size_t j : steep) {
        if (states_[i].upper_m >= states_[j].lower_m || states_[j].upper_m >= states_[i].lower_m) continue;
        const bool single = flat.size() == 1 && steep.size() == 1;
        exchange(i, j,
                 single ? 0.5 * (states_[i].cycle_m + states_[j].cycle_m)
                        : std::min(states_[i].cycle_m, states_[j].cycle_m));
      }
    }
  }
}

void AngleTransport::solve(Rates& rates) {
  const std::size_t n = size();
  for (std::size_t i = 0; i < n; ++i) rates.exchange[i * n + i] -= rates.loss[i];
  const EigenPairs pairs = symmetric_eigenpairs(std::move(rates.exchange), n);
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return pairs.values[a] > pairs.values[b]; });
  for (const std::size_t k : order) {
    values_.push_back(pairs.values[k]);
    const auto row = pairs.vectors.begin() + static_cast<std::ptrdiff_t>(k * n);
    vectors_.insert(vectors_.end(), row, row + static_cast<std::ptrdiff_t>(n));
  }
  // T = V diag(excess) V^T with the eigenvectors as rows of V, by columns for the compiler's sake.
  std::vector<double> columns(n * n);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) columns[i * n + k] = vectors_[k * n + i];
  }
  excess_matrix_.assign(n * n, 0);
  for (std::size_t k = 0; k < n; ++k) {
    double* row = &excess_matrix_[k * n];
    for (std::size_t i = 0; i < n; ++i) {
      const double weight = vectors_[k * n + i] * states_[i].excess_spm;
      const double* column = &columns[i * n];
      for (std::size_t l = 0; l < n; ++l) row[l] += weight * column[l];
    }
  }
  excess_quotients_ = excess_matrix_;
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t l = 0; l < n; ++l) {
      const double apart = values_[k] - values_[l];
      excess_quotients_[k * n + l] = apart != 0 ? excess_quotients_[k * n + l] / apart : 0;
    }
  }
}

std::size_t AngleTransport::lasting(double distance_m) const {
  constexpr double kMaxNepers = 37;  // 1e-16
  const double least = slowest() - kMaxNepers / std::max(distance_m, 1e-9);
  const auto first =
      std::partition_point(values_.begin(), values_.end(), [least](double value) { return value >= least; });
  return static_cast<std::size_t>(first - values_.begin());
}

}  // namespace halocline::acoustics
