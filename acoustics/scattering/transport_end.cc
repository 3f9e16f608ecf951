// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/scattering/transport_end.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "acoustics/math/fast_functions.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr int kRaysOfBin = 8;         // of each direction
constexpr double kUnitShare = 0.125;  // first distance of cells and tables, in depths
constexpr double kLeastLog = -690;

double unit_of(const AngleTransport& transport) { return kUnitShare * transport.depth_m(); }

double sine_of(double cosine) { return cosine < 1 ? std::sqrt((1 - cosine) * (1 + cosine)) : 0; }

// A ray's way from a depth to a boundary, or to where it turns.
struct Leg {
  double range_m = 0, excess_s = 0;
  bool turns = false;
};

// Follows the ray of `xi` from `depth_m` up or down.
Leg leg_of(const AngleTransport& transport, double xi, double depth_m, bool up) {
  const std::vector<double>&depths = transport.depths_m(), &speeds = transport.speeds_mps();
  Leg leg;
  const auto below = std::upper_bound(depths.begin() + 1, depths.end() - 1, depth_m);
  auto layer = static_cast<std::size_t>(below - depths.begin()) - 1;
  double z = depth_m, c = transport.speed_at(depth_m), s = sine_of(xi * c);
  while (true) {
    const double edge = up ? depths[layer] : depths[layer + 1], height = std::abs(edge - z);
    const double c2 = up ? speeds[layer] : speeds[layer + 1], s2 = sine_of(xi * c2);
    if (height > 0) {
      const double gradient = std::abs(c2 - c) / height;
      leg.turns = !(s2 > 0);
      const double mean = 0.5 * (c + (leg.turns ? 1 / xi : c2));
      const double range = !leg.turns ? height * xi * (c + c2) / (s + s2) : s > 0 ? s / (xi * gradient) : 0;
      leg.range_m += range;
      leg.excess_s += range * (1 / (xi * mean * mean) - transport.reference_spm());
    }
    if (leg.turns || (up ? layer == 0 : layer + 2 >= depths.size())) return leg;
    layer = up ? layer - 1 : layer + 1;
    z = edge;
    c = c2;
    s = s2;
  }
}

// The first meeting of a ray with a boundary.
struct Meeting {
  bool never = false;
  Boundary boundary = Boundary::kSurface;
  double distance_m = 0, excess_s = 0;
};

Meeting first_meeting(const AngleTransport& transport, double xi, double depth_m, bool up) {
  const Leg first = leg_of(transport, xi, depth_m, up);
  if (!first.turns)
    return {false, up ? Boundary::kSurface : Boundary::kBottom, first.range_m, first.excess_s};
  const Leg back = leg_of(transport, xi, depth_m, !up);
  return {back.turns, up ? Boundary::kBottom : Boundary::kSurface, 2 * first.range_m + back.range_m,
          2 * first.excess_s + back.excess_s};
}

// Integrals over x = 0..1 of e^(-k (1 - x)) and of x e^(-k (1 - x)), k >= 0.
struct DecayIntegrals {
  double even, rising;
};
DecayIntegrals decay_integrals(double k, double decayed) {
  if (k < 1e-2) return {1 - k / 2 + k * k / 6 - k * k * k / 24, 0.5 - k / 6 + k * k / 24 - k * k * k / 120};
  const double even = (1 - decayed) / k;
  return {even, (1 - even) / k};
}

// product_k = sum over l of matrix_kl phi(k, l) x_l of a symmetric matrix, phi the divided difference of e^(u
// y) at the decays u_k and u_l. Between two of the decays from `lasting` on it is 0.
void multiply_by_divided_differences(const AngleTransport& transport, const std::vector<double>& decays,
                                     std::size_t lasting, double y, const std::vector<double>& x,
                                     std::vector<double>& product) {
  constexpr double kClose = 1e-3;
  const std::size_t n = transport.size();
  std::fill(product.begin(), product.end(), 0.0);
  const double* values = transport.values().data();
  for (std::size_t l = 0; l < n; ++l) {
    const double* row = &transport.excess_matrix()[l * n];
    const double* quotients = &transport.excess_quotients()[l * n];
    const double u = values[l], decay = decays[l], weight = x[l];
    const std::size_t end = l < lasting ? n : lasting;
    for (std::size_t k = 0; k < end; ++k) {
      const double scaled = (values[k] - u) * y;
      const double far = quotients[k] * (decay - decays[k]);
      const double near = row[k] * y * (0.5 * (decays[k] + decay)) * (1 - scaled * scaled / 12);
      product[k] += (std::abs(scaled) > kClose ? far : near) * weight;
    }
  }
}

void multiply_by_excess(const AngleTransport& transport, const std::vector<double>& x,
                        std::vector<double>& product) {
  const std::size_t n = transport.size();
  std::fill(product.begin(), product.end(), 0.0);
  for (std::size_t l = 0; l < n; ++l) {
    const double* row = &transport.excess_matrix()[l * n];
    for (std::size_t k = 0; k < n; ++k) product[k] += row[k] * x[l];
  }
}

std::vector<double> times_vectors(const AngleTransport& transport, const std::vector<double>& x) {
  const std::size_t n = transport.size();
  std::vector<double> product(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double* row = &transport.vectors()[k * n];
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += row[i] * (x[i] * transport.root_measures()[i]);
    product[k] = sum;
  }
  return product;
}

std::vector<double> vectors_times(const AngleTransport& transport, const std::vector<double>& x) {
  const std::size_t n = transport.size();
  std::vector<double> product(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double* row = &transport.vectors()[k * n];
    for (std::size_t i = 0; i < n; ++i) product[i] += row[i] * x[k];
  }
  for (std::size_t i = 0; i < n; ++i) product[i] /= transport.root_measures()[i];
  return product;
}

}  // namespace

CarriedMoments in_eigenvectors(const AngleTransport& transport, const CarriedMoments& by_state) {
  return {times_vectors(transport, by_state.power), times_vectors(transport, by_state.first),
          times_vectors(transport, by_state.second)};
}

CarriedMoments by_state(const AngleTransport& transport, const CarriedMoments& in_eigenvectors) {
  return {vectors_times(transport, in_eigenvectors.power), vectors_times(transport, in_eigenvectors.first),
          vectors_times(transport, in_eigenvectors.second)};
}

// Exact for the first moment; for the second, 2 tau Q less the slowest decay is linear over the distance.
CarriedMoments carried(const AngleTransport& transport, const CarriedMoments& from, double distance_m) {
  const std::size_t n = transport.size();
  std::vector<double> decays(n), turned(n), before(n), after(n);
  const std::size_t lasting = transport.lasting(distance_m);
  for (std::size_t k = 0; k < lasting; ++k)
    decays[k] = elementary::exp((transport.values()[k] - transport.slowest()) * distance_m);
  CarriedMoments to = from;
  multiply_by_divided_differences(transport, decays, lasting, distance_m, from.power, turned);
  for (std::size_t k = 0; k < n; ++k) {
    to.power[k] = decays[k] * from.power[k];
    to.first[k] = decays[k] * from.first[k] + turned[k];
  }
  multiply_by_excess(transport, from.first, before);
  multiply_by_excess(transport, to.first, after);
  for (std::size_t k = 0; k < n; ++k) {
    const auto [even, rising] =
        decay_integrals((transport.slowest() - transport.values()[k]) * distance_m, decays[k]);
    to.second[k] =
        decays[k] * from.second[k] + 2 * distance_m * (before[k] * (even - rising) + after[k] * rising);
  }
  return to;
}

double ReceptionTable::distance_m(std::size_t node) const {
  if (node == 0) return 0;
  const double octave = static_cast<double>(std::size_t{1} << ((node - 1) / 2));
  return unit_m * octave * ((node - 1) % 2 == 0 ? 1 : std::numbers::sqrt2);
}

ReceptionTable::Place ReceptionTable::place_of(double distance) const {
  std::size_t node = 0;
  while (node + 2 < kNodes && distance_m(node + 1) <= distance) ++node;
  const double low = distance_m(node), high = distance_m(node + 1);
  return {node, (distance - low) / (high - low)};
}

TransportEnd::TransportEnd(const AngleTransport& transport, double depth_m, bool tabulated) {
  launch(transport, depth_m);
  receive(transport, depth_m);
  if (tabulated) tabulate(transport);
}

// Angles a and b of each bin's edges at the depth follow from its speed; p = 2 (sin b - sin a), of rays up
// and down together, and R = 2 / D (b - a) / (c dxi).
void TransportEnd::receive(const AngleTransport& transport, double depth_m) {
  const double speed = transport.speed_at(depth_m);
  reception_.assign(transport.size(), 0);
  double below = elementary::acos(std::min(transport.edge_xi(0) * speed, 1.0));
  for (std::size_t bin = 0; bin + 1 < transport.edges_rad().size(); ++bin) {
    const double above = elementary::acos(std::min(transport.edge_xi(bin + 1) * speed, 1.0));
    const std::size_t i = transport.state_at(bin, depth_m);
    const TransportState& state = transport.states()[i];
    reception_[i] = 2 / state.cycle_m * (above - below) / (state.width_spm * speed);
    below = above;
  }
}

void TransportEnd::launch(const AngleTransport& transport, double depth_m) {
  const std::size_t n = transport.size();
  const double unit_m = unit_of(transport), speed = transport.speed_at(depth_m);
  cells_.resize(kCells);
  for (std::size_t m = 0; m < kCells; ++m) {
    cells_[m].begin_m = m == 0 ? 0 : cells_[m - 1].end_m;
    cells_[m].end_m = m == 0 ? unit_m : cells_[m].begin_m * std::numbers::sqrt2;
    cells_[m].launched.assign(n, 0);
    cells_[m].bounced.assign(n, 0);
  }
  never_.assign(n, 0);
  // Power that meets each boundary first, by cell and state, with absorption.
  std::array<std::vector<double>, 2> meets{std::vector<double>(kCells * n), std::vector<double>(kCells * n)};
  for (std::size_t bin = 0; bin + 1 < transport.edges_rad().size(); ++bin) {
    const double low = transport.edges_rad()[bin], high = transport.edges_rad()[bin + 1];
    const std::size_t i = transport.state_at(bin, depth_m);
    double below = sine_of(transport.edge_xi(bin) * speed);
    for (int ray = 0; ray < kRaysOfBin; ++ray) {
      const double edge = low + (high - low) * (ray + 1) / kRaysOfBin;
      const double above = sine_of(elementary::cos(edge) / transport.least_speed_mps() * speed);
      const double power = above - std::exchange(below, above);  // of each of the two directions
      if (!(power > 0)) continue;
      const double middle = low + (high - low) * (ray + 0.5) / kRaysOfBin;
      const double xi = std::min(elementary::cos(middle) / transport.least_speed_mps(), 1 / speed);
      for (const bool up : {true, false}) {
        const Meeting met = first_meeting(transport, xi, depth_m, up);
        const std::size_t state = met.never ? n : transport.meeting(met.boundary, i);
        if (state == n) {
          never_[i] += power;
          continue;
        }
        std::size_t m = 0;
        while (m + 1 < kCells && cells_[m].end_m <= met.distance_m) ++m;
        FirstBounces& cell = cells_[m];
        cell.end_m = std::max(cell.end_m, met.distance_m);  // the last cell is open
        cell.power += power;
        cell.distance_m += power * met.distance_m;
        cell.excess_s += power * met.excess_s;
        const double sine = sine_of(xi * speed);
        cell.sine_squares += power * sine * sine;
        cell.launched[i] += power;
        meets[static_cast<std::size_t>(met.boundary)][m * n + state] +=
            power * elementary::exp(-transport.states()[i].nepers_per_m * met.distance_m);
      }
    }
  }
  for (std::size_t m = 0; m < kCells; ++m) {
    FirstBounces& cell = cells_[m];
    if (!(cell.power > 0)) continue;
    cell.distance_m /= cell.power;
    cell.excess_s /= cell.power;
    cell.sine_squares /= cell.power;
    for (const Boundary boundary : {Boundary::kSurface, Boundary::kBottom}) {
      for (std::size_t i = 0; i < n; ++i) {
        const double power = meets[static_cast<std::size_t>(boundary)][m * n + i];
        if (!(power > 0)) continue;
        const double* row = transport.bounce_row(boundary, i);
        for (std::size_t j = 0; j < n; ++j) cell.bounced[j] += power * row[j];
      }
    }
  }
}

namespace {

// Every second node of a table: 0, then unit_m 2^(octave - 1).
double octave_m(const ReceptionTable& table, std::size_t octave) {
  return octave == 0 ? 0 : table.distance_m(2 * octave - 1);
}

ReceptionTable::Place octave_of(const ReceptionTable& table, double distance_m) {
  std::size_t octave = 0;
  while (octave + 1 < ReceptionTable::kNodes / 2 && octave_m(table, octave + 1) <= distance_m) ++octave;
  const double low = octave_m(table, octave), high = octave_m(table, octave + 1);
  return {octave, (distance_m - low) / (high - low)};
}

}  // namespace

// F at y = d - D / 4 by the eigenvectors; moments at octaves of y, and interpolated between them.
void TransportEnd::tabulate(const AngleTransport& transport) {
  constexpr std::size_t kNodes = ReceptionTable::kNodes;
  const std::size_t n = transport.size();
  table_.unit_m = unit_of(transport);
  table_.size = n;
  table_.log_power.assign(kNodes * n, 0);
  table_.mean_s.assign(kNodes * n, 0);
  table_.variance_s2.assign(kNodes * n, 0);
  CarriedMoments moments =
      in_eigenvectors(transport, {reception_, std::vector<double>(n), std::vector<double>(n)});
  const std::vector<double> start = moments.power;
  std::vector<double> mean((kNodes / 2 + 1) * n), variance((kNodes / 2 + 1) * n);
  for (std::size_t octave = 1; octave <= kNodes / 2; ++octave) {
    const double step_m = octave_m(table_, octave) - octave_m(table_, octave - 1);
    moments = carried(transport, moments, step_m);
    const CarriedMoments here = by_state(transport, moments);
    for (std::size_t j = 0; j < n; ++j) {
      const double power = std::max(here.power[j], 1e-300);
      const double first = std::max(here.first[j] / power, 0.0);
      mean[octave * n + j] = first;
      variance[octave * n + j] = std::max(here.second[j] / power - first * first, 0.0);
    }
  }
  std::vector<double> weights(n), decayed(n);
  for (std::size_t j = 0; j < n; ++j) {
    const TransportState& state = transport.states()[j];
    const double quarter_m = state.cycle_m / 4;
    for (std::size_t k = 0; k < n; ++k) weights[k] = start[k] * transport.vectors()[k * n + j];
    for (std::size_t node = 0; node < kNodes; ++node) {
      const double d = table_.distance_m(node), y = d - quarter_m, straight = std::min(d, quarter_m);
      double power = reception_[j], mean_s = 0, variance_s2 = 0, log_scale = -state.nepers_per_m * straight;
      if (y > 0) {
        const auto [at, share] = octave_of(table_, y);
        mean_s = mean[at * n + j] + share * (mean[(at + 1) * n + j] - mean[at * n + j]);
        variance_s2 = variance[at * n + j] + share * (variance[(at + 1) * n + j] - variance[at * n + j]);
        const std::size_t lasting = transport.lasting(y);
        const double slowest = transport.slowest();
        for (std::size_t k = 0; k < lasting; ++k)
          decayed[k] = weights[k] * fast_exp((transport.values()[k] - slowest) * y);
        power = 0;
        for (std::size_t k = 0; k < lasting; ++k) power += decayed[k];
        power /= transport.root_measures()[j];
        log_scale += transport.slowest() * y;
      }
      table_.log_power[node * n + j] =
          power > 1e-290 ? std::max(elementary::log(power) + log_scale, kLeastLog) : kLeastLog;
      table_.mean_s[node * n + j] = mean_s + state.excess_spm * straight;
      table_.variance_s2[node * n + j] = variance_s2;
    }
  }
}

namespace {

void mix(std::vector<double>& a, const std::vector<double>& b, double share) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += share * (b[i] - a[i]);
}

FirstBounces mixed(const FirstBounces& a, const FirstBounces& b, double share) {
  FirstBounces cell = a;
  mix(cell.launched, b.launched, share);
  mix(cell.bounced, b.bounced, share);
  const double first = (1 - share) * a.power, second = share * b.power;
  cell.power = first + second;
  if (!(cell.power > 0)) return cell;
  cell.distance_m = (first * a.distance_m + second * b.distance_m) / cell.power;
  cell.excess_s = (first * a.excess_s + second * b.excess_s) / cell.power;
  cell.sine_squares = (first * a.sine_squares + second * b.sine_squares) / cell.power;
  return cell;
}

}  // namespace

namespace {

// ln(1 - w + w e^d), and the derivative by d, the second's part of the sum. Near d = 0 the series in the
// cumulants of a draw of 0 or 1, within 2e-6.
struct LogMean {
  double log, part;
};
LogMean log_mean(double w, double d) {
  constexpr double kNear = 0.25;
  if (std::abs(d) < kNear) {
    const double variance = w * (1 - w), third = variance * (1 - 2 * w),
                 fourth = variance * (1 - 6 * variance);
    return {d * (w + d * (variance / 2 + d * (third / 6 + d * fourth / 24))),
            w + d * (variance + d * (third / 2 + d * fourth / 6))};
  }
  const double most = std::max(d, 0.0);
  const double from_first = (1 - w) * fast_exp(-most), from_second = w * fast_exp(d - most);
  const double sum = std::max(from_first + from_second, 1e-300);
  return {most + fast_log(sum), from_second / sum};
}

}  // namespace

TransportEnd TransportEnd::between(const TransportEnd& first, const TransportEnd& second, double share,
                                   double reach_m) {
  TransportEnd end = first;
  mix(end.reception_, second.reception_, share);
  mix(end.never_, second.never_, share);
  for (std::size_t m = 0; m < kCells; ++m) end.cells_[m] = mixed(first.cells_[m], second.cells_[m], share);
  ReceptionTable& table = end.table_;
  if (table.size == 0 || second.table_.size == 0) return end;
  const std::vector<double>& other = second.table_.log_power;
  const std::size_t size = (table.place_of(reach_m).node + 2) * table.size;
  for (std::size_t i = 0; i < size; ++i) {
    const auto [log, part] = log_mean(share, other[i] - table.log_power[i]);
    table.log_power[i] += log;
    const double apart = second.table_.mean_s[i] - table.mean_s[i];
    table.variance_s2[i] +=
        part * (second.table_.variance_s2[i] - table.variance_s2[i]) + part * (1 - part) * apart * apart;
    table.mean_s[i] += part * apart;
  }
  return end;
}

}  // namespace halocline::acoustics
